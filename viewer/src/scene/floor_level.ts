// Where the floor is, and how far the arm passes through it.
import { Arc, new_pose, sample_count } from '../math/arc';
import { sample_stride } from '../protocol/state';
import type { Scene, SceneArm } from '../protocol/types';
import { radius_at, total_length } from './rings';

/** Share of the arm's length between a hanging arm's straight tip and the floor. */
const below = 0.05;
/** How far below the base a floor may be, in lengths of the arm. */
const deepest = 2.5;
/** The smallest depth that is worth a word, as a share of the arm's length. */
const least = 2e-3;
/** Points per interval between two samples. */
const steps = 4;

export interface Floor {
  /** Height, m. */
  height: number;
  /** The obstacle that is this floor; null if the page only draws one. */
  obstacle: string | null;
}

/** Returns 1 for an arm that stands or points sideways, -1 for one that hangs. */
export function up_of_base({ arm: { base } }: Scene): 1 | -1 {
  const [, , , w, x, y, z] = base;
  return 2 * (y * z - w * x) >= -1e-9 ? 1 : -1;
}

/**
 * Returns the floor: the highest horizontal plane among the obstacles that is not above the base. Without one it is
 * drawn below a standing arm, or below the workspace of a hanging one: at the world's height 0 where that is not far below.
 */
export function floor_of(scene: Scene): Floor {
  const span = total_length(scene.arm);
  const base = scene.arm.base[1];
  let floor: Floor | null = null;
  for (const obstacle of scene.obstacles) {
    if (obstacle.kind !== 'plane') continue;
    const { name, point, normal } = obstacle;
    const is_level = normal[1] > 0.999 * Math.hypot(...normal);
    if (!is_level || point[1] > base + 1e-3 * span || point[1] < base - deepest * span) continue;
    if (!floor || point[1] > floor.height) floor = { height: point[1], obstacle: name };
  }
  if (floor) return floor;
  if (up_of_base(scene) > 0) return { height: base, obstacle: null };
  const highest = base - (1 + below) * span;
  return { height: highest >= 0 && base < deepest * span ? 0 : highest, obstacle: null };
}

/** Returns how far the arm's skin is below the floor, m; 0 where it is not. */
export function depth_below(samples: ArrayLike<number>, arm: SceneArm, floor: number): number {
  const span = total_length(arm);
  const arc = new Arc();
  const pose = new_pose();
  let depth = 0;
  for (let i = 0; i + 1 < sample_count(samples); ++i) {
    arc.set(samples, i);
    const from = samples[i * sample_stride];
    const to = samples[(i + 1) * sample_stride];
    for (let j = 1; j <= steps; ++j) {
      const [, y, , w, a, b, c] = arc.pose(j / steps, pose);
      // Across a rising arm the skin's lowest point is higher than a radius below the backbone.
      const rise = 2 * (b * c - w * a);
      const radius = radius_at(arm, from + ((to - from) * j) / steps);
      depth = Math.max(depth, floor - y + radius * Math.sqrt(Math.max(0, 1 - rise * rise)));
    }
  }
  return depth > least * span ? depth : 0;
}

/** Formats a depth: "12 mm", "3.4 cm" or "1.25 m". */
export function depth_text(depth: number): string {
  if (depth >= 1) return `${depth.toFixed(2)} m`;
  return depth >= 0.1 ? `${(100 * depth).toFixed(1)} cm` : `${(1000 * depth).toFixed(depth < 0.01 ? 1 : 0)} mm`;
}
