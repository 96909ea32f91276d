// Objects around the arm are placed as the protocol specifies: corners and rims in the world.
import { Box3, type BufferGeometry, type Group, type LineSegments, Mesh, type MeshBasicMaterial, type MeshLambertMaterial, type Object3D, Vector3 } from 'three';
import { expect, test } from 'vitest';
import type { SceneObstacle } from '../../src/protocol/types';
import type { Part } from '../../src/scene/part';
import { cut, make_stand } from '../../src/scene/parts/stand';
import { spatial_rig } from '../fake/rigs';

const half = Math.SQRT1_2;
const span = 2;

function stand(change: { screens?: object[]; etalon?: object | null; obstacles?: object[] }): Part[] {
  const scene = { ...spatial_rig().scene, screens: [], etalon: null, obstacles: [], ...change } as ReturnType<typeof spatial_rig>['scene'];
  return make_stand({ scene, span, floor: 0, theme: 'dark' });
}

/** Returns the world positions of all vertices of an object. */
function corners(object: Object3D): Vector3[] {
  object.updateMatrixWorld(true);
  const all: Vector3[] = [];
  object.traverse((each) => {
    const positions = (each as Mesh<BufferGeometry>).geometry?.getAttribute('position');
    for (let i = 0; positions && i < positions.count; ++i) all.push(new Vector3().fromBufferAttribute(positions, i).applyMatrix4(each.matrixWorld));
  });
  return all;
}

const obstacle = (of: SceneObstacle): Object3D => stand({ obstacles: [of] })[0].group;
const has = (all: Vector3[], x: number, y: number, z: number): boolean => all.some((corner) => corner.distanceTo(new Vector3(x, y, z)) < 1e-6);

function expect_box(object: Object3D, min: number[], max: number[], places = 6): void {
  const box = new Box3().setFromPoints(corners(object));
  min.forEach((value, i) => expect(box.min.getComponent(i)).toBeCloseTo(value, places));
  max.forEach((value, i) => expect(box.max.getComponent(i)).toBeCloseTo(value, places));
}

test('a screen lies in its plane, width along x and height along y, and faces along z', () => {
  // Rotated by a quarter around y: its x points to -Z, its z to X.
  const [part] = stand({ screens: [{ pose: [1, 2, 3, half, 0, half, 0], size: [4, 6], brightness: 1 }] });
  const [whole, above] = part.group.children as Group[];
  const [sheet, edge] = whole.children as [Mesh, LineSegments];
  for (const drawn of [sheet, edge]) {
    part.group.updateMatrixWorld(true);
    for (const [y, z] of [[-1, 1], [5, 1], [-1, 5], [5, 5]]) expect(has(corners(part.group), 1, y, z)).toBe(true);
    expect(drawn.matrixWorld.determinant()).toBeCloseTo(1);
  }
  expect_box(part.group, [1, -1, 1], [1, 5, 5]);
  const [a, b, c] = corners(sheet);
  const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
  expect(normal.toArray().map((x) => Math.round(x * 1e6) / 1e6 + 0)).toEqual([1, 0, 0]);
  expect((sheet.material as MeshBasicMaterial).transparent).toBe(false);
  // What is below the floor is left out, but not for a camera.
  expect_box(above, [1, 0, 1], [1, 5, 5]);
  expect([whole.visible, above.visible]).toEqual([false, true]);
  part.inside!('front');
  expect([whole.visible, above.visible]).toEqual([true, false]);
});

test('an outline is cut where it crosses', () => {
  const square = [[0, 0], [2, 0], [2, 2], [0, 2]].map(([x, y]) => new Vector3(x, y, 0));
  expect(cut(square, ({ y }) => y + 1)).toEqual(square);
  expect(cut(square, ({ y }) => y - 3)).toEqual([]);
  expect(cut(square, ({ y }) => y - 0.5).map(({ x, y }) => [x, y])).toEqual([[2, 0.5], [2, 2], [0, 2], [0, 0.5]]);
});

test('the etalon stands along its y, with red lines at its z and each quarter of a turn', () => {
  const etalon = { radius: 0.5, height: 2, line_width: 0.1, color: [0.1, 0.1, 0.1], line_color: [0.8, 0.05, 0.05] };
  // Rotated by a quarter around x: its y points to Z, its z to -Y.
  const [part] = stand({ etalon: { ...etalon, pose: [1, 2, 3, half, half, 0, 0] } });
  const [body, ...strips] = (part.group as Group).children as Mesh[];
  part.group.updateMatrixWorld(true);
  expect_box(body, [0.5, 1.5, 2], [1.5, 2.5, 4]);
  expect(strips).toHaveLength(4);
  const middles = strips.map((strip) => {
    const all = corners(strip);
    const box = new Box3().setFromPoints(all);
    expect(box.min.z).toBeCloseTo(2);
    expect(box.max.z).toBeCloseTo(4);
    // The line has the given width along the cylinder's surface.
    expect(all[0].clone().setZ(0).distanceTo(all[4].clone().setZ(0))).toBeCloseTo(0.1, 2);
    for (const corner of all) expect(Math.hypot(corner.x - 1, corner.y - 2)).toBeCloseTo(0.501, 6);
    const { color } = strip.material as MeshLambertMaterial;
    expect(color.toArray()).toEqual(etalon.line_color);
    return all[2];
  });
  const wanted = [[1, 1.499], [1.501, 2], [1, 2.501], [0.499, 2]];
  middles.forEach(({ x, y }, i) => expect(Math.hypot(x - wanted[i][0], y - wanted[i][1])).toBeLessThan(1e-6));
});

test('a box is turned about its middle', () => {
  const turned: SceneObstacle = { name: 'a', kind: 'box', center: [1, 2, 3], half_sizes: [0.1, 0.2, 0.3], rotation: [2 * half, 0, 0, 2 * half] };
  // Rotated by a quarter around z: its x points to Y. The quaternion need not have length one.
  expect_box(obstacle(turned), [0.8, 1.9, 2.7], [1.2, 2.1, 3.3]);
  const { rotation: _, ...straight } = turned;
  expect_box(obstacle(straight as SceneObstacle), [0.9, 1.8, 2.7], [1.1, 2.2, 3.3]);
});

test('a sphere, and a capsule from one middle to the other', () => {
  expect_box(obstacle({ name: 'a', kind: 'sphere', center: [1, 2, 3], radius: 0.5 }), [0.5, 1.5, 2.5], [1.5, 2.5, 3.5]);
  const capsule = obstacle({ name: 'a', kind: 'capsule', from: [1, 2, 3], to: [1, 2, 7], radius: 0.5 });
  expect_box(capsule, [0.5, 1.5, 2.5], [1.5, 2.5, 7.5]);
  // Downwards: the rotation from y to the axis is half a turn about an arbitrary axis.
  expect_box(obstacle({ name: 'a', kind: 'capsule', from: [1, 2, 3], to: [1, -2, 3], radius: 0.5 }), [0.5, -2.5, 2.5], [1.5, 2.5, 3.5]);
  // Obliquely: each point has the distance `radius` from the line between the end points.
  const [from, to] = [new Vector3(1, 2, 3), new Vector3(2, 3, 4.5)];
  const way = to.clone().sub(from);
  const all = corners(obstacle({ name: 'a', kind: 'capsule', from: from.toArray(), to: to.toArray(), radius: 0.5 }));
  for (const corner of all) {
    const t = Math.min(1, Math.max(0, corner.clone().sub(from).dot(way) / way.lengthSq()));
    expect(corner.distanceTo(from.clone().addScaledVector(way, t))).toBeCloseTo(0.5, 6);
  }
});

test('a plane goes through its point across its normal', () => {
  const normal = new Vector3(1, 2, 2);
  const all = corners(obstacle({ name: 'a', kind: 'plane', point: [1, 2, 3], normal: [1, 2, 2] }));
  for (const corner of all) expect(corner.clone().sub(new Vector3(1, 2, 3)).dot(normal)).toBeCloseTo(0, 6);
  const middle = new Box3().setFromPoints(all).getCenter(new Vector3());
  expect(middle.distanceTo(new Vector3(1, 2, 3))).toBeLessThan(1e-6);
  expect(Math.max(...all.map((corner) => corner.distanceTo(middle)))).toBeCloseTo(1.6 * span * Math.SQRT2, 6);
  expect_box(obstacle({ name: 'a', kind: 'plane', point: [0, -1, 0], normal: [0, 3, 0] }), [-3.2, -1, -3.2], [3.2, -1, 3.2]);
});

test('each thing has a part of its own, by its name', () => {
  const screen = { pose: [0, 0, 0, 1, 0, 0, 0], size: [1, 1], brightness: 1 };
  const ball: SceneObstacle = { name: 'ball', kind: 'sphere', center: [0, 0, 0], radius: 1 };
  expect(stand({ screens: [screen], obstacles: [ball] }).map(({ id, label }) => [id, label])).toEqual(
    [['screen 1', 'Screen'], ['obstacle ball', 'Obstacle “ball”']]);
  expect(stand({ screens: [screen, screen] }).map(({ label }) => label)).toEqual(['Screen 1', 'Screen 2']);
});
