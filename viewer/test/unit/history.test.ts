import { expect, test } from 'vitest';
import type { State } from '../../src/protocol/state';
import { History } from '../../src/state/history';
import { window_of } from '../../src/plots/data';
import { groups_of, live_sources, most_in_group, short_names } from '../../src/plots/sources';
import { spatial_rig } from '../fake/rigs';
import type { Hello } from '../../src/protocol/types';

const none = new Float32Array(0);
function state(time: number, sequence = 0): State {
  return { flags: 0, leaps: 0, sequence, time, bends: none, stretches: none, samples: none, cameras: none, displacements: none, actuators: none };
}

function filled(seconds: number, kept = 60): History {
  const history = new History(kept);
  for (let i = 0; i <= seconds * 60; ++i) history.add(state(i / 60, i));
  return history;
}

test('it keeps the last seconds and no more', () => {
  const history = filled(100, 20);
  expect(history.newest!.time).toBe(100);
  expect(history.oldest!.time).toBeGreaterThanOrEqual(80);
  expect(history.count).toBe(1201);
});

test('it finds the state of a time: the last that is not after it', () => {
  const history = filled(10);
  expect(history.at(5.01)!.time).toBe(5);
  expect(history.at(-1)!.time).toBe(0);
  expect(history.at(99)!.time).toBe(10);
  expect(new History().at(1)).toBeUndefined();
});

test('it begins anew when time goes back, and takes one state for each time', () => {
  const history = filled(3);
  history.add(state(0));
  history.add(state(0, 8));
  expect(history.count).toBe(1);
  expect(history.newest!.sequence).toBe(8);
});

test('a live plot’s points are few, in order, and end with the newest', () => {
  const source = { id: 't', label: '', unit: '', names: ['twice'], value: ({ time }: State) => 2 * time };
  const [times, values] = window_of(filled(60), source, 60, 20);
  expect(times.length).toBeLessThan(650);
  expect(times[0]).toBeGreaterThanOrEqual(39.9);
  expect(times.at(-1)).toBe(60);
  expect(values.at(-1)).toBe(120);
  expect([...times].sort((a, b) => a - b)).toEqual(times);
});

test('a live plot’s points stay where they are when time goes on', () => {
  const source = { id: 't', label: '', unit: '', names: [], value: () => 0 };
  const history = filled(60);
  const [before] = window_of(history, source, 60, 20);
  history.add(state(60 + 1 / 60, 3601));
  const [after] = window_of(history, source, 60 + 1 / 60, 20);
  const kept = before.filter((time) => after.includes(time)).length;
  expect(kept).toBeGreaterThan(before.length - 4);
});

test('quantities are grouped by what their names have in common', () => {
  const names = ['cord_angle_1', 'cord_angle_2', 'bend_x_1', 'bend_x_2', 'bend_y_1', 'tip_x', 'tip_y', 'tip_z'];
  const groups = groups_of(names.map((name) => ({ name, unit: name.startsWith('tip') ? 'm' : 'rad' })));
  expect(groups.map(({ label, names }) => [label, names.length])).toEqual([['Cord angle', 2], ['Bend', 3], ['Tip', 3]]);
});

test('of more quantities than can be told apart each is in a group of its own size, which says so', () => {
  const quantities = Array.from({ length: 40 }, (_, i) => ({ name: `q_${i}`, unit: '' }));
  const groups = groups_of(quantities);
  expect(groups.flatMap(({ names }) => names)).toEqual(quantities.map(({ name }) => name));
  expect(groups.map(({ names }) => names.length)).toEqual([9, 9, 9, 9, 4]);
  expect(groups.map(({ label }) => label)).toEqual(['Q', 'Q (more)', 'Q (more 2)', 'Q (more 3)', 'Q (more 4)']);
  expect(groups[0].part).toBe('9 of 40; others: “Q (more)”');
  expect(groups[4].part).toBe('4 of 40; others: “Q”');
  expect(new Set(groups.map(({ id }) => id)).size).toBe(5);
  expect(groups_of(quantities.slice(0, 9)).map(({ part }) => part)).toEqual([undefined]);
});

test('a live arm of many sections is plotted in parts, nine curves at most', () => {
  const { scene, controls } = spatial_rig();
  const sections = Array.from({ length: 8 }, () => scene.arm.sections[0]);
  const sources = live_sources({ controls } as Hello, { ...scene, arm: { ...scene.arm, sections } });
  for (const { names } of sources) expect(names.length).toBeLessThanOrEqual(most_in_group);
  const bends = sources.filter(({ label }) => label.startsWith('Bends'));
  expect(bends.map(({ names }) => names.length)).toEqual([9, 7]);
  expect(bends[0].part).toBe('9 of 16; others: “Bends (more)”');
  const shown = { bends: Float32Array.from({ length: 16 }, (_, i) => i * (Math.PI / 180)) } as State;
  expect(Math.round(bends[1].value(shown, 0)!)).toBe(9);
  expect(bends[1].names[0]).toBe('5y');
});

test('a legend says what tells the names apart', () => {
  expect(short_names(['tip_x', 'tip_y'])).toEqual(['x', 'y']);
  expect(short_names(['arching_1', 'arching_12'])).toEqual(['Arching 1', 'Arching 12']);
  expect(short_names(['bend[1].x', 'bend[2].x'])).toEqual(['1.x', '2.x']);
  expect(short_names(['zoom'])).toEqual(['Zoom']);
});

test('a picture is as old as the first state that came after its time, whatever pace the run goes at', () => {
  for (const pace of [0.01, 1, 500]) {
    const history = new History(1e9);
    // States arrive at 60 Hz for 4 s; the page's clock has an arbitrary offset.
    for (let i = 0; i < 240; ++i) history.add(state((pace * i) / 60, i), 5000 + (1000 * i) / 60);
    const now = 5000 + (1000 * 239) / 60;
    expect(history.outdated_for((pace * 239) / 60, now)).toBe(0);
    expect(history.outdated_for((pace * 238.5) / 60, now)).toBe(0);
    expect(history.outdated_for((pace * 119.5) / 60, now)).toBeCloseTo(119 / 60, 9);
    expect(history.outdated_for(-1, now)).toBeCloseTo(239 / 60, 9);
  }
  expect(new History().outdated_for(0)).toBe(0);
});

test('a run that hangs at one time makes no picture of that time old', () => {
  const history = new History();
  for (let i = 0; i < 600; ++i) history.add(state(3, i), (1000 * i) / 60);
  expect(history.outdated_for(3, 10_000)).toBe(0);
  // A picture of an earlier time is outdated since the first state after it, not since the last one.
  expect(history.outdated_for(2.9, 10_000)).toBe(10);
});

test('what is remembered of when states came is of the states that are', () => {
  const history = new History(20);
  for (let i = 0; i <= 6000; ++i) history.add(state(i / 60, i), (1000 * i) / 60);
  expect(history.outdated_for(94.999, 100_000)).toBeCloseTo(5, 6);
});

test.each([1, 7])('a live plot is broken where everything was put elsewhere, also when its points are thinned (by %i)', (much) => {
  const source = { id: 't', label: '', unit: '', names: ['a', 'b'], value: ({ leaps }: State, j: number) => 10 * leaps + j };
  const history = new History(1000);
  for (let i = 0; i <= 400 * much; ++i) history.add({ ...state(i / 60, i), leaps: i < 101 ? 65_535 : i < 250 ? 0 : 1 });
  const [times, ...series] = window_of(history, source, 1e9, 1e9);
  expect(times.length).toBeLessThan(600);
  expect([...times].sort((a, b) => a - b)).toEqual(times);
  const gaps = times.flatMap((_, i) => (series[0][i] === null ? [i] : []));
  expect(gaps.map((i) => [times[i - 1], times[i + 1]].map((time) => Math.round(60 * time)))).toEqual([[100, 101], [249, 250]]);
  for (const values of series) {
    expect(values.flatMap((value, i) => (value === null ? [i] : []))).toEqual(gaps);
    // Between the two gaps there is a single value, so no line connects different values.
    expect(new Set(values.slice(gaps[0] + 1, gaps[1])).size).toBe(1);
  }
});
