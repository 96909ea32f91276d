import { expect, test } from 'vitest';
import { Mesh } from 'three';
import { energy_text, has_forces } from '../../src/panels/ForcePanel';
import type { State } from '../../src/protocol/state';
import type { Hello } from '../../src/protocol/types';
import { make_forces, scale_end } from '../../src/scene/parts/forces';
import type { PartContext } from '../../src/scene/part';

test('a scale ends at 1, 2 or 5 times a power of ten', () => {
  for (const [force, end] of [[0.03, 0.05], [1, 1], [1.1, 2], [7, 10], [0.2, 0.2]]) expect(scale_end(force)).toBeCloseTo(end, 9);
  for (const none of [0, NaN, -1]) expect(scale_end(none)).toBe(1);
});

test('an energy has a unit in which it has digits', () => {
  expect(['0 J', '2.50 J', '−1.69 J', '173.1 mJ', '1.07 mJ', '51.2 µJ']).toEqual(
    [0, 2.5, -1.69, 0.1731, 1.07e-3, 51.2e-6].map(energy_text));
  expect(energy_text(1e-10)).toBe('0 J');
});

test('forces are shown where some are known', () => {
  const hello = (controls: object, quantities: { name: string; unit: string }[] = []): Hello => ({ controls, quantities }) as unknown as Hello;
  expect(has_forces(null)).toBe(false);
  expect(has_forces(hello({ inertia: false, contact: false }))).toBe(false);
  expect(has_forces(hello({ push: { length: 1, stiffness: 1, most: 1 } }))).toBe(true);
  expect(has_forces(hello({}, [{ name: 'energy_kinetic', unit: 'J' }]))).toBe(true);
});

test('a push is drawn from the point to the hand, and away when nothing pushes', () => {
  const [part] = make_forces({ scene: { arm: { elastic: true } }, span: 1, theme: 'dark' } as unknown as PartContext);
  const samples = new Float32Array([0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0]);
  const state = (more: object): State => ({ samples, contacts: new Float32Array(0), push: null, ...more }) as unknown as State;
  const push = part.group.children[0];
  const shafts = part.group.children[1] as Mesh & { count: number };
  part.draw!(state({}));
  expect([push.visible, shafts.count]).toEqual([false, 0]);
  part.draw!(state({ push: new Float32Array([1, 0.4, 0, 1, 2, 0, 0]) }));
  expect(push.visible).toBe(true);
  const [rod, tip, point] = push.children;
  expect(point.position.z).toBeCloseTo(1, 6);
  expect(rod.position.x).toBeGreaterThan(0.1);
  expect(tip.position.x).toBeGreaterThan(rod.position.x);
  expect(tip.position.x).toBeLessThan(0.4);
  part.draw!(state({ contacts: new Float32Array([0, 0.5, 0, 0, 0.5, -2, 0, 0, 2, 1]) }));
  expect([push.visible, shafts.count]).toEqual([false, 1]);
  part.dispose();
  expect(make_forces({ scene: { arm: {} }, span: 1, theme: 'dark' } as unknown as PartContext)).toEqual([]);
});
