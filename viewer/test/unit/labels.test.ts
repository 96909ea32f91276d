import { expect, test } from 'vitest';
import type { Mark } from '../../src/protocol/types';
import { labels_of, name_of } from '../../src/timeline/labels';

const mark = (time: number, name: string, end = time): Mark => ({ time, end, level: 'info', name, text: '' });

test('marks of one instant share a label', () => {
  const labels = labels_of([mark(2, 'stand'), mark(5, 'end'), mark(2, 'run'), mark(2, 'run')], 0, 10);
  expect(labels.map((label) => [label.time, label.until, name_of(label)])).toEqual([[2, 5, 'stand, run'], [5, 10, 'end']]);
});

test('marks that cannot be told apart share one, so that each label has room', () => {
  const labels = labels_of([mark(4, 'a'), mark(4.05, 'b'), mark(4.1, 'c'), mark(4.2, 'd')], 0, 10);
  expect(labels.map(name_of)).toEqual(['a, b, c', 'd']);
  for (const { time, until } of labels) expect(until - time).toBeGreaterThan(0.1);
});

test('what began before the line stands at its start', () => {
  const labels = labels_of([mark(1, 'long', 6), mark(3.001, 'a'), mark(7, 'b')], 3, 10);
  expect(labels.map((label) => [label.time, label.end, name_of(label)])).toEqual([[3, 6, 'long, a'], [7, 7, 'b']]);
});
