// Tendons are coupled: those that end at one section act against each other, and those of later sections run through
// it. When the user moves one, the others follow, so that the lengths always belong to one shape. This is exact for
// continuous channels and approximate for guide disks; the rig then reports its own lengths.
import type { Controls, Range, TendonControl } from '../protocol/types';

export interface Pulled {
  /** Pulled-in length of each tendon, m. */
  displacements: number[];
  /** Two per section, rad. */
  bends: number[];
}

type Kind = 'planar' | 'spatial';

/** Returns the change of the section's bend per pulled-in length, rad/m, for the smallest change of bend. */
function bending({ radius, angle }: TendonControl, kind: Kind): [number, number] {
  if (kind === 'spatial') return [Math.cos(angle) / radius, Math.sin(angle) / radius];
  // In a planar arm only the in-plane offset has an effect.
  const x = radius * Math.cos(angle);
  return Math.abs(x) > 1e-6 * radius ? [1 / x, 0] : [0, 0];
}

/** Returns the range of tendon i with the bends of all other sections fixed. */
export function tendon_reach(kind: Kind, controls: Controls, { displacements, bends }: Pulled, i: number): Range {
  const tendon = controls.tendons![i];
  const at = displacements[i];
  const [ux, uy] = bending(tendon, kind);
  const square = ux * ux + uy * uy;
  if (square === 0) return [at, at];
  const limit = controls.sections[tendon.section].bend ?? Infinity;
  if (!Number.isFinite(limit)) return tendon.displacement;
  // The bend moves along a line; the part inside the disc of the limit is reachable.
  const [x, y] = bends.slice(2 * tendon.section, 2 * tendon.section + 2);
  const along = x * ux + y * uy;
  const half = Math.sqrt(Math.max(0, along * along - square * (x * x + y * y - limit * limit))) / square;
  const middle = at - along / square;
  return [Math.min(at, middle - half), Math.max(at, middle + half)];
}

/** Returns all tendons when tendon i moves to `value`, clamped to its range. */
export function pull(kind: Kind, controls: Controls, pulled: Pulled, i: number, value: number): Pulled {
  const tendons = controls.tendons!;
  const [low, high] = tendon_reach(kind, controls, pulled, i);
  const way = Math.min(high, Math.max(low, value)) - pulled.displacements[i];
  const [dx, dy] = bending(tendons[i], kind).map((each) => each * way);
  const { section } = tendons[i];
  const bends = [...pulled.bends];
  bends[2 * section] += dx;
  bends[2 * section + 1] += dy;
  const displacements = pulled.displacements.map((old, j) => {
    const { radius, angle } = tendons[j];
    return tendons[j].section < section ? old : old + radius * (Math.cos(angle) * dx + Math.sin(angle) * dy);
  });
  return { displacements, bends };
}
