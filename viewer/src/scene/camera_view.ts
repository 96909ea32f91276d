import { Quaternion, type PerspectiveCamera } from 'three';
import { camera_cx, camera_cy, camera_fx, camera_fy, camera_stride, type State } from '../protocol/state';
import type { Scene } from '../protocol/types';
import { total_length } from './rings';

/** Half a turn about x: converts a camera that looks along z with y down to one that looks along -z with y up. */
const flip = new Quaternion(1, 0, 0, 0);

/** Near clipping distance, in lengths of the arm. */
const nearest = 1e-3;

/** Returns the radius around the arm's base that contains everything: floor, objects and cameras. */
export function reach_of({ arm, screens, etalon, obstacles }: Scene, cameras: ArrayLike<number>): number {
  const [x, y, z] = arm.base;
  const span = arm.sections.reduce((sum, { length, stretch }) => sum + length * Math.max(1, stretch[1]), 0);
  let reach = 2.5 * span;
  const add = ([px, py, pz]: ArrayLike<number> & Iterable<number>, more: number): void => {
    reach = Math.max(reach, Math.hypot(px - x, py - y, pz - z) + more);
  };
  for (const { pose, size } of screens) add(pose, Math.hypot(...size) / 2);
  if (etalon) add(etalon.pose, Math.hypot(etalon.radius, etalon.height / 2));
  for (const obstacle of obstacles) {
    if (obstacle.kind === 'sphere') add(obstacle.center, obstacle.radius);
    else if (obstacle.kind === 'box') add(obstacle.center, Math.hypot(...obstacle.half_sizes));
    else if (obstacle.kind === 'plane') add(obstacle.point, 2.5 * span);
    else for (const end of [obstacle.from, obstacle.to]) add(end, obstacle.radius);
  }
  for (let at = 0; at + camera_stride <= cameras.length; at += camera_stride) add([cameras[at], cameras[at + 1], cameras[at + 2]], span);
  return reach;
}

/**
 * Puts the view into a rig's camera, so that its whole picture is visible. Returns false if the camera does not exist.
 */
export function see_through(
  camera: PerspectiveCamera, scene: Scene, { cameras }: State, name: string, aspect: number,
): boolean {
  const index = scene.cameras.findIndex((each) => each.name === name);
  const at = index * camera_stride;
  if (index < 0 || cameras.length < at + camera_stride) return false;
  const { width, height } = scene.cameras[index];
  camera.position.set(cameras[at], cameras[at + 1], cameras[at + 2]);
  camera.quaternion.set(cameras[at + 4], cameras[at + 5], cameras[at + 6], cameras[at + 3]).multiply(flip);
  const [x, y, z] = scene.arm.base;
  camera.near = nearest * total_length(scene.arm);
  camera.far = reach_of(scene, cameras) + Math.hypot(camera.position.x - x, camera.position.y - y, camera.position.z - z);
  let left = (-0.5 - cameras[at + camera_cx]) / cameras[at + camera_fx];
  let right = (width - 0.5 - cameras[at + camera_cx]) / cameras[at + camera_fx];
  let top = (0.5 + cameras[at + camera_cy]) / cameras[at + camera_fy];
  let bottom = (0.5 - height + cameras[at + camera_cy]) / cameras[at + camera_fy];
  const own = (right - left) / (top - bottom);
  if (aspect > own) {
    const more = ((right - left) * (aspect / own - 1)) / 2;
    left -= more;
    right += more;
  } else {
    const more = ((top - bottom) * (own / aspect - 1)) / 2;
    top += more;
    bottom -= more;
  }
  const n = camera.near;
  camera.projectionMatrix.makePerspective(left * n, right * n, top * n, bottom * n, n, camera.far, camera.coordinateSystem);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  return true;
}
