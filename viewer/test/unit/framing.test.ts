import { PerspectiveCamera, Vector3 } from 'three';
import { expect, test } from 'vitest';
import {
  distance_for, distance_for_all, farthest_look, first_distance, frustum_points, nearest_look, type Look,
} from '../../src/scene/framing';
import { Orbit } from '../../src/scene/orbit';
import { total_length } from '../../src/scene/rings';
import { FakeSession } from '../fake/session';
import { spatial_rig } from '../fake/rigs';

/** Returns the view coordinates of a point, in half pictures. */
function shown(point: Vector3, look: Look, distance: number): Vector3 {
  const orbit = new Orbit();
  orbit.target.copy(look.target);
  orbit.distance = distance;
  orbit.look(look.azimuth, look.elevation);
  const camera = new PerspectiveCamera(look.fov, look.aspect, 0.01, 100);
  orbit.place(camera);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
  return point.clone().project(camera);
}

test('from the distance of a point it is just within the picture', () => {
  let seed = 7;
  const random = (from: number, to: number): number => {
    seed = (seed * 16807) % 2147483647;
    return from + ((to - from) * seed) / 2147483647;
  };
  for (let i = 0; i < 200; ++i) {
    const look: Look = {
      target: new Vector3(random(-1, 1), random(-1, 1), random(-1, 1)), azimuth: random(-3, 3), elevation: random(-1.5, 1.5),
      fov: random(20, 60), aspect: random(0.5, 2.5),
    };
    const point = new Vector3(random(-2, 2), random(-2, 2), random(-2, 2)).add(look.target);
    const { x, y } = shown(point, look, distance_for(point, look));
    expect(Math.max(Math.abs(x), Math.abs(y)), `case ${i}`).toBeCloseTo(0.95, 6);
  }
});

test('near cameras are in the first picture, far ones leave the arm as large as it was', () => {
  const rig = spatial_rig();
  const span = total_length(rig.scene.arm);
  const rows = Float32Array.from(new FakeSession(rig).camera_rows());
  const look: Look = { target: new Vector3(0, 0.42 * span, 0), azimuth: 0.6, elevation: 0.34, fov: 38, aspect: 1.6 };
  const frusta = frustum_points(rig.scene, rows);
  expect(frusta).toHaveLength(5 * rig.scene.cameras.length);
  const distance = first_distance(frusta, look, span);
  expect(distance).toBeGreaterThanOrEqual(nearest_look * span);
  expect(distance).toBeLessThanOrEqual(farthest_look * span);
  const far = frusta.map((point) => point.clone().multiplyScalar(20));
  expect(first_distance(far, look, span)).toBe(nearest_look * span);
});

test('all cameras are in the picture that shall have them', () => {
  const rig = spatial_rig();
  const span = total_length(rig.scene.arm);
  const rows = Float32Array.from(new FakeSession(rig).camera_rows());
  const look: Look = { target: new Vector3(0, 0.42 * span, 0), azimuth: -1.1, elevation: 0.2, fov: 38, aspect: 1.4 };
  const points = frustum_points(rig.scene, rows);
  const distance = distance_for_all(points, look, span);
  for (const point of points) {
    const { x, y } = shown(point, look, distance);
    expect(Math.max(Math.abs(x), Math.abs(y))).toBeLessThanOrEqual(0.95 + 1e-6);
  }
});

test('a picture hangs straight before its camera', () => {
  const { scene } = spatial_rig();
  const rows = Float32Array.from(new FakeSession(spatial_rig()).camera_rows());
  const [pupil, ...corners] = frustum_points(scene, rows).slice(0, 5);
  const middle = corners.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(4);
  // The first camera stands on +Z and looks along -Z.
  expect(Math.hypot(middle.x - pupil.x, middle.y - pupil.y)).toBeLessThan(0.01 * pupil.distanceTo(middle));
  expect(middle.z).toBeLessThan(pupil.z);
});
