import { Color, type InstancedMesh, Matrix4, Vector3 as Vector } from 'three';
import { expect, test } from 'vitest';
import { make_tendons } from '../../src/scene/parts/tendons';
import { decode_state } from '../../src/protocol/state';
import type { Vector3 } from '../../src/protocol/types';
import { encode_state } from '../fake/encode';
import { spatial_rig } from '../fake/rigs';

const straight: Vector3[] = [[0, 0.01, 0], [0.5, 0.01, 0], [1, 0.01, 0]];

function state(actuators: number[]) {
  // Along z from the origin, 1 m long.
  const samples = [0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0];
  const bytes = encode_state({ flags: 0, sequence: 1, time: 1, bends: [0, 0], stretches: [1], samples, cameras: [], displacements: [], actuators });
  return decode_state(new Uint8Array(bytes).buffer);
}

function made(tendons: Vector3[][] | undefined) {
  const { scene } = spatial_rig();
  return make_tendons({ scene: { ...scene, arm: { ...scene.arm, tendons } }, span: 1, floor: 0, theme: 'dark' });
}

test('tendons run beside the backbone, and their colours say which pulls', () => {
  const [part] = made([straight, straight.map(([s, x]) => [s, 0, -x])]);
  const rods = part.group.children[0] as InstancedMesh;
  part.draw!(state([0, 0, 0, 0, 5, 0]));
  expect(rods.visible).toBe(true);
  // The end of the first tendon's second rod, and the start of the second tendon's first rod.
  const point = (i: number, y: number): number[] => {
    const matrix = new Matrix4();
    rods.getMatrixAt(i, matrix);
    return new Vector(0, y, 0).applyMatrix4(matrix).toArray().map((x) => Math.round(1e5 * x) / 1e5 + 0);
  };
  expect(point(1, 0.5)).toEqual([0.01, 0, 1]);
  expect(point(2, -0.5)).toEqual([0, -0.01, 0]);
  const [slack, taut] = [0, 2].map((i) => {
    const color = new Color();
    rods.getColorAt(i, color);
    return color;
  });
  expect(taut.r).toBeGreaterThan(taut.g + 0.3);
  expect(Math.abs(slack.r - slack.g)).toBeLessThan(0.15);
});

test('tendons are not drawn where nobody knows how they pull, or where there are none', () => {
  const [part] = made([straight]);
  part.draw!(state([]));
  expect(part.group.children[0].visible).toBe(false);
  expect(made([])).toEqual([]);
  expect(made(undefined)).toEqual([]);
});
