import { expect, test, vi } from 'vitest';
import { OverlayMemory, eye_of, eyes_of, extra_ghosts, extra_layers, extra_overlay } from '../../src/overlays/extras';
import { columns_of } from '../../src/plots/AlongPlot';
import { can_be_along, groups_of, live_sources, short_names, shown_groups } from '../../src/plots/sources';
import { decode_extras, kind_extras, kind_of, type State } from '../../src/protocol/state';
import type { Extras, Hello } from '../../src/protocol/types';
import { Viewer } from '../../src/state/viewer';
import { encode_extras } from '../fake/encode';
import { spatial_rig } from '../fake/rigs';
import { FakeSession } from '../fake/session';

const extras: Extras = {
  time: 1.5, title: 'Servo', text: '0.50 % of the length off',
  ghosts: [
    { id: 'wanted', label: 'Wanted', color: '#ff922b', poses: [[0, 0, 0, 1, 0, 0, 0], [0, 1, 0, 1, 0, 0, 0]] },
    { id: 'seen', label: 'Seen', color: '#22b8cf', poses: [[0, 0, 0, 1, 0, 0, 0], [0, 1, 0, 1, 0, 0, 0]] },
  ],
  overlays: [
    { camera: 'front', number: 7, layers: [{ id: 'wanted', kind: 'polyline' }, { id: 'seen', kind: 'polyline' }] },
    { camera: 'side', reason: 'too dark', layers: [] },
  ],
  along: { label: 'Distance from wanted', unit: 'mm', length: 2, curves: [{ id: 'seen', label: 'Seen', color: '#22b8cf', values: [0, null, 3] }] },
  values: { servo_rms: 0.5, servo_tip: 0.75 },
};

function bytes(of: Partial<Extras>): ArrayBuffer {
  return new Uint8Array(encode_extras(of)).buffer;
}

test('extras are read as they were written; those that hold nothing take away', () => {
  const message = bytes(extras);
  expect(kind_of(message)).toBe(kind_extras);
  expect(decode_extras(message)).toEqual(extras);
  expect(decode_extras(bytes({ time: 3, ghosts: [], overlays: [], values: {} }))).toBe(null);
  expect(() => decode_extras(new Uint8Array([3, 123]).buffer)).toThrow();
});

test('an eye hides a shape in the view and upon the pictures', () => {
  expect(Object.keys(extra_ghosts(extras, []))).toEqual(['extra wanted', 'extra seen']);
  expect(Object.keys(extra_ghosts(extras, [eye_of('wanted')]))).toEqual(['extra seen']);
  const overlay = extra_overlay(extras, 'front', 7);
  expect(extra_layers(overlay, []).map(({ id }) => id)).toEqual(['wanted', 'seen']);
  expect(extra_layers(overlay, [eye_of('seen')]).map(({ id }) => id)).toEqual(['wanted']);
  expect(extra_ghosts(null, [])).toEqual({});
});

test('features have an eye of their own, and go with what they are features of', () => {
  const marks = ['', 'seen', 'wanted'].map((of, i) => ({ id: 'features', label: 'Features', kind: 'points', color: `#00000${i}`, ...(of && { of }) }));
  const overlay = { camera: 'front', layers: [...extras.overlays[0].layers, ...marks] };
  const shown = { ...extras, overlays: [overlay, { camera: 'side', layers: marks }] };
  expect(eyes_of(shown).map(({ label, color }) => [label, color])).toEqual(
    [['Wanted', '#ff922b'], ['Seen', '#22b8cf'], ['Features', '#000000']]);
  expect(eyes_of(extras).map(({ id }) => id)).toEqual(['wanted', 'seen']);
  const colors = (hidden: string[]) => extra_layers(overlay, hidden).map(({ id, color }) => color ?? id);
  expect(colors([])).toEqual(['wanted', 'seen', '#000000', '#000001', '#000002']);
  expect(colors([eye_of('features')])).toEqual(['wanted', 'seen']);
  expect(colors([eye_of('seen')])).toEqual(['wanted', '#000000', '#000002']);
});

test('what belongs to one picture lies upon no other', () => {
  expect(extra_overlay(extras, 'front', 8)).toBe(undefined);
  expect(extra_overlay(extras, 'front', undefined)).toBe(undefined);
  expect(extra_overlay(extras, 'side', 8)?.reason).toBe('too dark');
  expect(extra_layers(extra_overlay(null, 'side', 8), [])).toEqual([]);
});

test('curves along the arm are over its length', () => {
  expect(columns_of(extras.along!)).toEqual([[0, 1, 2], [0, null, 3]]);
});

test('a servo’s errors are a plot of a rig with such a task, broken where none steers the arm', () => {
  const { scene, controls } = spatial_rig();
  const hello = { mode: 'live', controls, quantities: [] } as unknown as Hello;
  expect(live_sources(hello, scene).some(({ id }) => id === 'servo_error')).toBe(false);
  expect(can_be_along(hello)).toBe(false);
  const steered = { ...hello, controls: { ...controls, tasks: [{ name: 'bow', kind: 'servo' }] } };
  const source = live_sources(steered, scene).find(({ id }) => id === 'servo_error')!;
  expect(source.names).toEqual(['rms', 'tip', 'true rms', 'true tip']);
  const state = (of: Extras | null): State => ({ extras: of }) as State;
  expect([0, 1, 2].map((i) => source.value(state(extras), i))).toEqual([0.5, 0.75, null]);
  expect(source.value(state(null), 0)).toBe(null);
  expect(can_be_along(steered)).toBe(true);
});

test('a recording’s quantities of one group are one plot', () => {
  const quantities = ['servo_rms', 'servo_tip', 'servo_true_rms'].map((name) => ({ name, unit: '%', group: 'servo_error' }));
  const groups = groups_of([{ name: 'tip_x', unit: 'm' }, ...quantities]);
  expect(groups.map(({ label, names }) => [label, names.length])).toEqual([['Tip', 1], ['Servo error', 3]]);
  expect(short_names(groups[1].names)).toEqual(['rms', 'tip', 'true rms']);
  const hello = { mode: 'recording', quantities: [...quantities, { name: 'bend_1', unit: 'rad' }] } as Hello;
  expect(shown_groups(hello).map(({ unit, factor }) => [unit, Math.round(factor)])).toEqual([['%', 1], ['°', 57]]);
  expect(can_be_along(hello)).toBe(true);
});

function watched() {
  vi.useFakeTimers();
  const viewer = new Viewer({ base: 'http://127.0.0.1:1/', token: () => null, settle: () => {} });
  const session = new FakeSession(spatial_rig());
  const state = (time: number): ArrayBuffer => {
    session.time = time;
    return new Uint8Array(session.state()).buffer;
  };
  return { viewer, session, state };
}

test('a held view keeps what was drawn then; the newest pictures have the newest', () => {
  const { viewer, session, state } = watched();
  viewer.text(session.hello('1') as unknown as Hello);
  viewer.bytes(state(1));
  expect(viewer.ghosts.value).toEqual({});
  viewer.bytes(bytes(extras));
  expect(viewer.ghosts.value, 'the state that they belong to is yet to come').toEqual({});
  viewer.bytes(state(2));
  expect(Object.keys(viewer.ghosts.value)).toEqual(['extra wanted', 'extra seen']);
  viewer.bytes(bytes({ ...extras, ghosts: extras.ghosts.slice(1) }));
  expect(Object.keys(viewer.ghosts.value), 'also where they come late').toEqual(['extra seen']);
  viewer.bytes(bytes(extras));
  viewer.playback.pause();
  viewer.bytes(bytes({}));
  viewer.bytes(state(3));
  expect(viewer.extras.value).toBe(null);
  expect(viewer.shown_extras.value).toEqual(extras);
  viewer.playback.go_live();
  expect(viewer.ghosts.value).toEqual({});
  viewer.playback.seek(2);
  expect(viewer.shown_extras.value).toEqual(extras);
  viewer.text({ ...(session.hello('2') as unknown as Hello) });
  expect(viewer.shown_extras.value, 'nothing of another run').toBe(null);
  vi.useRealTimers();
});

test('what was drawn before the link broke is not drawn with what is new after it', () => {
  const { viewer, session, state } = watched();
  viewer.text(session.hello('1') as unknown as Hello);
  viewer.bytes(bytes(extras));
  viewer.bytes(state(2));
  expect(Object.keys(viewer.ghosts.value)).toEqual(['extra wanted', 'extra seen']);
  viewer.closed();
  viewer.text(session.hello('1') as unknown as Hello);
  viewer.bytes(state(9));
  expect(viewer.ghosts.value).toEqual({});
  vi.useRealTimers();
});

test('what was measured in a picture is drawn upon it also when that comes later', () => {
  const memory = new OverlayMemory();
  const drawn = (number: number): Extras => ({
    time: 0, title: '', text: '', ghosts: [], values: {}, overlays: [{ camera: 'front', number, layers: [{ id: `${number}`, kind: 'polyline' }] }],
  });
  for (let number = 1; number <= 40; ++number) memory.take(drawn(number));
  expect(memory.of('front', 3)?.layers[0].id).toBe('3');
  expect(memory.of('front', 41)).toBeUndefined();
  expect(memory.of('side', 3)).toBeUndefined();
  for (let number = 41; number <= 2000; ++number) memory.take(drawn(number));
  expect(memory.of('front', 3)).toBeUndefined();
  expect(memory.of('front', 2000)).toBeDefined();
  memory.take(null);
  expect(memory.of('front', 2000)).toBeUndefined();
});
