import type { Line } from 'three';
import { expect, test } from 'vitest';
import type { State } from '../../src/protocol/state';
import { make_trail, most_points } from '../../src/scene/parts/trail';
import { spatial_rig } from '../fake/rigs';

/** The trail of an arm 1 m long, and the drawn points. */
function made() {
  const [part] = make_trail({ scene: spatial_rig().scene, span: 1, floor: 0, theme: 'dark' });
  const { geometry } = part.group as Line;
  const drawn = () => {
    const positions = geometry.getAttribute('position');
    return Array.from({ length: geometry.drawRange.count }, (_, i) => positions.getX(i));
  };
  const show = (time: number, x: number, leaps = 0): void =>
    part.draw!({ time, leaps, samples: new Float32Array([0, x, 0, 0, 1, 0, 0, 0]) } as State);
  return { show, drawn, length: () => geometry.drawRange.count };
}

test('it goes where the tip was seen to go, one point a millimetre at most', () => {
  const { show, drawn } = made();
  for (let i = 0; i <= 10; ++i) show(i / 60, i / 8);
  expect(drawn()).toEqual(Array.from({ length: 11 }, (_, i) => i / 8));
  show(11 / 60, 10 / 8 + 1e-4);
  expect(drawn()).toHaveLength(11);
});

test('a reset puts the tip elsewhere, and no way leads there', () => {
  const { show, drawn } = made();
  for (let i = 0; i <= 10; ++i) show(i / 60, i / 8);
  show(11 / 60, 0, 1);
  expect(drawn()).toEqual([0]);
  show(12 / 60, 0.125, 1);
  expect(drawn()).toEqual([0, 0.125]);
});

test('where time goes back, however little, it begins anew', () => {
  const { show, drawn } = made();
  for (let i = 0; i <= 10; ++i) show(i / 60, i / 8);
  show(9 / 60, 9 / 8);
  expect(drawn()).toEqual([9 / 8]);
});

test('where one scrubs on far it begins anew; where nothing moved meanwhile it goes on', () => {
  const { show, drawn } = made();
  show(0, 0);
  show(0.1, 0.125);
  show(3, 0.5);
  expect(drawn()).toEqual([0.5]);
  show(10, 0.5);
  show(10.1, 0.625);
  expect(drawn()).toEqual([0.5, 0.625]);
});

test('it is bounded, and keeps its newest half at least', () => {
  const { show, drawn, length } = made();
  let longest = 0;
  for (let i = 0; i <= 3 * most_points; ++i) {
    show(i / 60, i / 128);
    longest = Math.max(longest, length());
  }
  expect(longest).toBeLessThanOrEqual(most_points);
  const points = drawn();
  expect(points.length).toBeGreaterThanOrEqual(most_points / 2);
  expect(points.at(-1)).toBe((3 * most_points) / 128);
  points.slice(1).forEach((x, i) => expect(x - points[i]).toBeCloseTo(1 / 128, 9));
});
