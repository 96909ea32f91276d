// Finds the point of the backbone under the pointer, in screen pixels.
import { Vector3, type Camera } from 'three';
import { Arc, new_pose, sample_count } from '../math/arc';
import { sample_stride } from '../protocol/state';

export interface Hit {
  s: number;
  /** Distance from the pointer, px. */
  distance: number;
}

const steps = 6;

/** Returns the backbone's point nearest to the pixel (x, y) of a view of that size. */
export function nearest_point(
  samples: ArrayLike<number>, camera: Camera, width: number, height: number, x: number, y: number,
): Hit {
  const arc = new Arc();
  const pose = new_pose();
  const point = new Vector3();
  let best: Hit = { s: 0, distance: Infinity };
  let before: { x: number; y: number; s: number } | null = null;
  for (let i = 0; i + 1 < sample_count(samples); ++i) {
    arc.set(samples, i);
    const from = samples[i * sample_stride];
    const to = samples[(i + 1) * sample_stride];
    for (let j = i ? 1 : 0; j <= steps; ++j) {
      arc.pose(j / steps, pose);
      point.set(pose[0], pose[1], pose[2]).project(camera);
      if (Math.abs(point.z) > 1) {
        before = null;
        continue;
      }
      const here = { x: ((point.x + 1) / 2) * width, y: ((1 - point.y) / 2) * height, s: from + ((to - from) * j) / steps };
      const hit = before ? on_segment(before, here, x, y) : { s: here.s, distance: Math.hypot(here.x - x, here.y - y) };
      if (hit.distance < best.distance) best = hit;
      before = here;
    }
  }
  return best;
}

function on_segment(
  a: { x: number; y: number; s: number }, b: { x: number; y: number; s: number }, x: number, y: number,
): Hit {
  const dx = b.x - a.x;
  const dy = b.y - a.y;
  const square = dx * dx + dy * dy;
  const f = square > 0 ? Math.min(1, Math.max(0, ((x - a.x) * dx + (y - a.y) * dy) / square)) : 0;
  return { s: a.s + f * (b.s - a.s), distance: Math.hypot(a.x + f * dx - x, a.y + f * dy - y) };
}
