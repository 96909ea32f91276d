import { expect, test } from 'vitest';
import type { Mark } from '../../src/protocol/types';
import { flag_running } from '../../src/protocol/state';
import { History } from '../../src/state/history';
import { bars_of, lane_of, run_end_in } from '../../src/timeline/bars';
import { name_of } from '../../src/timeline/labels';
import type { State } from '../../src/protocol/state';

const mark = (time: number, name: string, text = '', end = time): Mark => ({ time, end, level: 'info', name, text });
const never = (): number => Infinity;

test('a task goes from its start to the next one, to the end of the run, or to its own end', () => {
  const marks = [mark(0, 'reach', 'move starts'), mark(4, 'move', 'move starts'), mark(6, 'run', 'done'), mark(7, 'long', 'hold', 9)];
  expect(bars_of(marks, never).map(({ name, kind, start, end }) => [name, kind, start, end])).toEqual([
    ['reach', 'move', 0, 4], ['move', '', 4, 6], ['long', 'hold', 7, 9],
  ]);
});

test('one that still runs ends where the states end', () => {
  expect(bars_of([mark(2, 'reach', 'move starts')], () => 3.5)[0].end).toBe(3.5);
});

test('two tasks of one name are two bars', () => {
  const marks = [mark(0, 'move', 'move starts'), mark(1, 'move', 'there'), mark(2, 'move', 'move starts'), mark(3, 'run', 'done')];
  const { bars, labels } = lane_of(marks, never, 0, 3);
  expect(bars.map(({ start, end }) => [start, end])).toEqual([[0, 2], [2, 3]]);
  expect(bars.map(({ ticks }) => ticks.map(name_of))).toEqual([['move'], ['run']]);
  expect(labels).toEqual([]);
});

test('what belongs to no task has a label, up to the next task', () => {
  const { bars, labels } = lane_of([mark(0, 'reset'), mark(4, 'reach', 'move starts'), mark(6, 'run', 'done')], never, 0, 10);
  expect(bars).toHaveLength(1);
  expect(labels.map((label) => [name_of(label), label.time, label.until])).toEqual([['reset', 0, 4]]);
});

test('a task that began before the line is on it, one that ended before is not', () => {
  const marks = [mark(0, 'a', 'move starts'), mark(2, 'b', 'move starts'), mark(8, 'run', 'done')];
  expect(lane_of(marks, never, 5, 10).bars.map(({ name }) => name)).toEqual(['b']);
});

test('the states say when the rig stopped running', () => {
  const history = new History();
  const add = (time: number, flags: number): void => history.add({ time, flags } as State);
  add(0, 0);
  expect(run_end_in(history, 0)).toBe(0);
  for (const time of [1, 2, 3]) add(time, flag_running);
  expect(run_end_in(history, 1)).toBe(3);
  add(4, 0);
  add(5, 0);
  expect(run_end_in(history, 1)).toBe(4);
});
