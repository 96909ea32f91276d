import { expect, test } from 'vitest';
import type { State } from '../../src/protocol/state';
import { History } from '../../src/state/history';
import { window_of } from '../../src/plots/data';
import { groups_of, short_names } from '../../src/plots/sources';

const none = new Float32Array(0);
function state(time: number, sequence = 0): State {
  return { flags: 0, leaps: 0, sequence, time, bends: none, stretches: none, samples: none, cameras: none, displacements: none };
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
  expect(groups_of(Array.from({ length: 20 }, (_, i) => ({ name: `q_${i}`, unit: '' }))).every(({ names }) => names.length < 20)).toBe(true);
});

test('a legend says what tells the names apart', () => {
  expect(short_names(['tip_x', 'tip_y'])).toEqual(['x', 'y']);
  expect(short_names(['arching_1', 'arching_12'])).toEqual(['Arching 1', 'Arching 12']);
  expect(short_names(['bend[1].x', 'bend[2].x'])).toEqual(['1.x', '2.x']);
  expect(short_names(['zoom'])).toEqual(['Zoom']);
});
