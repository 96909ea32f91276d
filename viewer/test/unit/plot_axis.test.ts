import { expect, test } from 'vitest';
import { axis_of, auto, objection, range_of, set_axis } from '../../src/plots/axis';
import { csv_of, cut, type Table } from '../../src/plots/csv';
import { preferences } from '../../src/state/preferences';

test('limits are chosen from the values with a margin, or typed', () => {
  const [low, high] = range_of(0, 10, auto);
  expect([low < 0 && low > -2, high > 10 && high < 12]).toEqual([true, true]);
  expect(range_of(null, null, auto)).toEqual([-1, 1]);
  expect(range_of(5, 5, auto)[0]).toBeLessThan(5);
  expect(range_of(0, 10, { low: -3, high: 4, log: false })).toEqual([-3, 4]);
  expect(range_of(0, 10, { low: 2, high: null, log: false })[0]).toBe(2);
});

test('a typed limit holds where all values are beyond it', () => {
  const [low, high] = range_of(0, 10, { low: 50, high: null, log: false });
  expect(low).toBe(50);
  expect(high).toBeGreaterThan(50);
  expect(range_of(1, 10, { low: null, high: 0.01, log: true })).toEqual([0.001, 0.01]);
});

test('a log axis goes by whole decades', () => {
  expect(range_of(0.03, 20, { ...auto, log: true })).toEqual([0.01, 100]);
  expect(range_of(1, 1, { ...auto, log: true })).toEqual([1, 10]);
  expect(range_of(null, null, { ...auto, log: true })).toEqual([0.1, 10]);
});

test('limits that cannot be are refused', () => {
  expect(objection({ low: 1, high: 2, log: false })).toBeNull();
  expect(objection({ low: 2, high: 2, log: false })).toContain('below');
  expect(objection({ low: 0, high: null, log: true })).toContain('above 0');
  expect(objection({ low: null, high: -1, log: true })).toContain('above 0');
});

test('axes are kept by what is plotted, and forgotten when nothing is set', () => {
  set_axis('tip', { low: 1, high: null, log: false });
  expect(axis_of('tip')).toEqual({ low: 1, high: null, log: false });
  expect(axis_of('bends')).toEqual(auto);
  set_axis('tip', auto);
  expect(preferences.plot_axes.value).toEqual({});
});

const table: Table = {
  name: 'Bends', heads: [{ name: 'time', unit: 's' }, { name: 'a', unit: '°' }, { name: 'b, "c"', unit: '' }],
  columns: [[0, 0.5, 1], [1, null, 1 / 3], [2, null, null]],
};

test('a table has names and units first, and no row without a value', () => {
  expect(csv_of(table)).toBe('time [s],a [deg],"b, ""c"""\n0,1,2\n1,0.3333333333,\n');
});

test('a table is cut to what is shown', () => {
  const { heads, columns } = cut(table, [0.4, 2], (i) => i === 0);
  expect(heads.map(({ name }) => name)).toEqual(['time', 'a']);
  expect(columns).toEqual([[0.5, 1], [null, 1 / 3]]);
});
