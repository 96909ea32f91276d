import { expect, test } from 'vitest';
import { key_step, limit_of } from '../../src/panels/Slider';

test('an arrow key goes a degree, or a hundredth of what is no angle', () => {
  expect(key_step(4, 180 / Math.PI, '°')).toBeCloseTo(Math.PI / 180, 12);
  expect(key_step(0.05, 1000, 'mm')).toBeCloseTo(0.0005, 12);
});

test('a typed value beyond a limit is known by more than rounding', () => {
  expect(limit_of(1.2, [-1, 1], 0.05)).toEqual({ side: 'above', limit: 1 });
  expect(limit_of(-1.2, [-1, 1], 0.05)).toEqual({ side: 'below', limit: -1 });
  expect(limit_of(1.04, [-1, 1], 0.05)).toBeNull();
});
