import { expect, test } from 'vitest';
import { lag_of, number_of } from '../../src/ui/format';

test.each([
  ['12', 12], [' 12.5 ', 12.5], ['0,25', 0.25], ['−3', -3], ['-3.', -3], ['+.5', 0.5], ['1e3', 1000], ['2.5E-2', 0.025], ['007', 7],
])('%j is a number', (typed, number) => {
  expect(number_of(typed)).toBe(number);
});

test.each(['', ' ', '0x10', '0b1', '0o7', 'Infinity', 'NaN', '1e999', '1 2', '1.2.3', '1,2,3', '--1', '.', '-', 'e5', '5°', '1_000'])(
  '%j is none', (typed) => {
    expect(number_of(typed)).toBeNull();
  },
);

test('a picture says how far it is from the instant that is shown', () => {
  expect(lag_of(1.93, 2, 0.02)).toBe('0.07 s earlier');
  expect(lag_of(2.5, 2, 0.02)).toBe('0.50 s later');
  expect(lag_of(1.99, 2, 0.02)).toBe('');
  expect(lag_of(1, undefined, 0.02)).toBe('');
});
