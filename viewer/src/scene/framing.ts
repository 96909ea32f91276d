// Viewing distances of the free view.
import { Quaternion, Vector3 } from 'three';
import { camera_stride } from '../protocol/state';
import type { Scene } from '../protocol/types';
import { hang, type Hanging } from './parts/cameras';
import { total_length } from './rings';

/** Initial viewing distance, in lengths of the arm: at least the first value, at most the second. */
export const [nearest_look, farthest_look] = [2.9, 3.8];
/** Free margin at the borders, as a share of half the picture. */
const margin = 0.05;

/** The opening view goes no farther away than this, in lengths of the arm: it would be too small. */
export const farthest_opening = 9;

/** How much of a large screen the opening view holds, to each side of the arm, in lengths of the arm. */
const screen_share = 0.8;

export interface Look {
  target: Vector3;
  azimuth: number;
  elevation: number;
  /** Vertical field of view, degrees. */
  fov: number;
  aspect: number;
}

/** Returns the smallest distance from the target at which a point is in the picture. */
export function distance_for(point: Vector3, { target, azimuth, elevation, fov, aspect }: Look): number {
  const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
  const [x, y, z] = [point.x - target.x, point.y - target.y, point.z - target.z];
  const right = ca * x - sa * z;
  const up = -se * sa * x + ce * y - se * ca * z;
  const near = ce * sa * x + se * y + ce * ca * z;
  const high = Math.tan((fov * Math.PI) / 360) * (1 - margin);
  return near + Math.max(Math.abs(right) / (high * aspect), Math.abs(up) / high);
}

/** Returns the corners of the cameras' frusta: pupil and four picture corners of each camera. */
export function frustum_points(scene: Scene, cameras: Float32Array): Vector3[] {
  const hanging: Hanging = { left: 0, right: 0, top: 0, bottom: 0, depth: 1 };
  const turn = new Quaternion();
  return scene.cameras.flatMap((camera, i) => {
    const at = i * camera_stride;
    if (cameras.length < at + camera_stride) return [];
    const { left, right, top, bottom, depth } = hang(cameras, at, camera, scene.arm.base, total_length(scene.arm), hanging);
    turn.set(cameras[at + 4], cameras[at + 5], cameras[at + 6], cameras[at + 3]);
    const pupil = new Vector3(cameras[at], cameras[at + 1], cameras[at + 2]);
    const corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    return [pupil, ...corners.map(([u, v]) => new Vector3(u, v, depth).applyQuaternion(turn).add(pupil))];
  });
}

/** Returns the initial distance: the arm appears large, and nearby parts of the camera frusta are visible. */
export function first_distance(frusta: Vector3[], look: Look, span: number): number {
  const near = frusta.map((point) => distance_for(point, look)).filter((distance) => distance <= farthest_look * span);
  return Math.max(nearest_look * span, ...near);
}

/** Returns the distance at which all points and the arm are visible. */
export function distance_for_all(points: Vector3[], look: Look, span: number): number {
  return Math.max(nearest_look * span, ...points.map((point) => distance_for(point, look)));
}

/**
 * Returns the corners of the screens' parts behind the arm, above the floor: of a screen much larger than the arm, what is
 * within `screen_share` of the place nearest to the middle of its workspace.
 */
export function screen_points(scene: Scene, middle: Vector3, floor: number, span: number): Vector3[] {
  const most = screen_share * span;
  return scene.screens.flatMap(({ pose: [x, y, z, qw, qx, qy, qz], size: [width, height] }) => {
    const turn = new Quaternion(qx, qy, qz, qw);
    const nearest = middle.clone().sub(new Vector3(x, y, z)).applyQuaternion(turn.clone().invert());
    const ends = (size: number, at: number): number[] =>
      [-1, 1].map((side) => Math.min(size / 2, Math.max(-size / 2, at + side * most)));
    return ends(width, nearest.x).flatMap((u) => ends(height, nearest.y).map((v) => {
      const corner = new Vector3(u, v, 0).applyQuaternion(turn);
      return new Vector3(x + corner.x, Math.max(floor, y + corner.y), z + corner.z);
    }));
  });
}

/** A place of the free view beside its look: the target moves to the right and up, m. */
export interface Frame {
  right: number;
  up: number;
  distance: number;
}

/**
 * Returns the nearest place in the look's direction from which all points and the arm are in the picture. Points that
 * would move it too far away are left out, the farthest first.
 */
export function frame_of(points: Vector3[], look: Look, span: number): Frame {
  const near = nearest_look * span;
  const far = farthest_opening * span;
  let kept = points;
  for (;;) {
    const frame = frame_around(kept, look, near);
    if (frame.distance <= far || kept.length === 0) return { ...frame, distance: Math.min(far, frame.distance) };
    let worst = kept[0];
    for (const point of kept) if (distance_for(point, look) > distance_for(worst, look)) worst = point;
    kept = kept.filter((point) => point !== worst);
  }
}

function frame_around(points: Vector3[], { target, azimuth, elevation, fov, aspect }: Look, near: number): Frame {
  const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
  const high = Math.tan((fov * Math.PI) / 360) * (1 - margin);
  const wide = high * aspect;
  // Without points: the arm's own frame, in the middle.
  const most = { left: -near * wide, right: near * wide, down: -near * high, up: near * high };
  for (const point of points) {
    const [x, y, z] = [point.x - target.x, point.y - target.y, point.z - target.z];
    const right = ca * x - sa * z;
    const up = -se * sa * x + ce * y - se * ca * z;
    const towards = ce * sa * x + se * y + ce * ca * z;
    most.left = Math.min(most.left, right - towards * wide);
    most.right = Math.max(most.right, right + towards * wide);
    most.down = Math.min(most.down, up - towards * high);
    most.up = Math.max(most.up, up + towards * high);
  }
  return {
    right: (most.left + most.right) / 2,
    up: (most.down + most.up) / 2,
    distance: Math.max((most.right - most.left) / (2 * wide), (most.up - most.down) / (2 * high)),
  };
}
