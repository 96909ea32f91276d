// Tendons hang together: those that end with a section pull against each other, and those of later sections run through
// it. A hand moves one, and the others go along, so that all of them stay lengths of one shape. Exact in a continuous
// channel; between guide disks near enough for a hand, for the rig's own lengths come back a moment later.
import type { Controls, Range, TendonControl } from '../protocol/types';

export interface Pulled {
  /** m, positive pulled in: one a tendon. */
  displacements: number[];
  /** rad, two a section. */
  bends: number[];
}

type Kind = 'planar' | 'spatial';

/** The change of its section's bend, rad a metre, that pulling the tendon makes with the least bending. */
function bending({ radius, angle }: TendonControl, kind: Kind): [number, number] {
  if (kind === 'spatial') return [Math.cos(angle) / radius, Math.sin(angle) / radius];
  // In a plane only what of its place lies there pulls.
  const x = radius * Math.cos(angle);
  return Math.abs(x) > 1e-6 * radius ? [1 / x, 0] : [0, 0];
}

/** Where the tendon i can be while the bends of all other sections stay. */
export function tendon_reach(kind: Kind, controls: Controls, { displacements, bends }: Pulled, i: number): Range {
  const tendon = controls.tendons![i];
  const at = displacements[i];
  const [ux, uy] = bending(tendon, kind);
  const square = ux * ux + uy * uy;
  if (square === 0) return [at, at];
  const limit = controls.sections[tendon.section].bend ?? Infinity;
  if (!Number.isFinite(limit)) return tendon.displacement;
  // The bend moves along a line, of which a piece lies in the disc of the limit.
  const [x, y] = bends.slice(2 * tendon.section, 2 * tendon.section + 2);
  const along = x * ux + y * uy;
  const half = Math.sqrt(Math.max(0, along * along - square * (x * x + y * y - limit * limit))) / square;
  const middle = at - along / square;
  return [Math.min(at, middle - half), Math.max(at, middle + half)];
}

/** All tendons when the one at i goes to `value`, drawn to its reach. */
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
