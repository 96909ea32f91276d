// Rings of the tube along the arm and their appearance: fixed by the scene, while their positions follow every state.
import type { SceneArm, Vector3 } from '../protocol/types';

export interface Ring {
  /** Along the unstretched arm, m. */
  s: number;
  radius: number;
  /** Offset along the tangent at s: caps extend beyond the arm's end. */
  offset: number;
  /** Components of the normal: away from the backbone, and along it. */
  outward: number;
  along: number;
  color: Vector3;
}

/** Subdivision of the arm: just fine enough for a smooth outline on a projector. */
export interface Fineness {
  arm: number;
  section: number;
  cap: number;
}

const fine: Fineness = { arm: 120, section: 11, cap: 9 };
/** For views in which the arm is thin: its outline is accurate to a quarter of a pixel, with fewer vertices. */
export const medium: Fineness = { arm: 72, section: 11, cap: 5 };
export const coarse: Fineness = { arm: 40, section: 6, cap: 2 };

/** Width of the rim of a flat tip, as a share of its radius. */
const rim_share = 0.08;

export function total_length(arm: SceneArm): number {
  return arm.sections.reduce((sum, { length }) => sum + length, 0);
}

/**
 * Returns the arm's radius at s. Where two sections meet, it is that of the next one or, with `before`, of the previous
 * one.
 */
export function radius_at(arm: SceneArm, s: number, before = false): number {
  let start = 0;
  for (const section of arm.sections) {
    const end = start + section.length;
    if (s < end || (before && s <= end) || section === arm.sections[arm.sections.length - 1]) {
      const f = section.length > 0 ? Math.min(1, Math.max(0, (s - start) / section.length)) : 0;
      return section.radius[0] + f * (section.radius[1] - section.radius[0]);
    }
    start = end;
  }
  return 0;
}

/** Returns all rings, base first: cap, sections with doubled rings where colour or radius jump, tip. */
export function plan_rings(
  arm: SceneArm, paint: (s: number) => Vector3 = painter(arm), fineness: Fineness = fine,
): Ring[] {
  const total = total_length(arm);
  const rings: Ring[] = [];
  const edges = arm.markers.flatMap(({ from, to }) => [from, to]);
  let start = 0;
  for (const section of arm.sections) {
    const end = start + section.length;
    const slope = (section.radius[1] - section.radius[0]) / section.length;
    const norm = Math.hypot(1, slope);
    const count = Math.max(fineness.section, Math.round((fineness.arm * section.length) / total));
    const stops = stops_of(start, end, count, edges);
    const tiny = 1e-9 * total;
    for (let i = 0; i + 1 < stops.length; ++i) {
      // The colour is taken inside each interval, so that marker edges are sharp.
      const color = paint((stops[i] + stops[i + 1]) / 2);
      for (const s of [stops[i], stops[i + 1]]) {
        const last = rings[rings.length - 1];
        const radius = section.radius[0] + slope * (s - start);
        const same = last && Math.abs(last.s - s) < tiny && last.radius === radius && same_color(last.color, color);
        if (!same) rings.push({ s, radius, offset: 0, outward: 1 / norm, along: -slope / norm, color });
      }
    }
    start = end;
  }
  const smooth = smooth_joints(rings, 1e-9 * total);
  return [...base_cap(smooth[0]), ...smooth, ...tip_cap(smooth[smooth.length - 1], arm.tip, fineness.cap)];
}

/**
 * Where sections of equal radius and different taper meet, both have the normal between theirs, so that no edge is seen.
 * Where the radius jumps, the step between them faces along the arm.
 */
function smooth_joints(rings: Ring[], tiny: number): Ring[] {
  const out: Ring[] = [];
  rings.forEach((ring, i) => {
    const before = rings[i - 1];
    if (before && ring.s - before.s < tiny) {
      if (Math.abs(ring.radius - before.radius) < 1e-6 * before.radius) {
        const [outward, along] = [before.outward + ring.outward, before.along + ring.along];
        const norm = Math.hypot(outward, along);
        const normal = { outward: outward / norm, along: along / norm };
        out[out.length - 1] = { ...before, ...normal };
        out.push({ ...ring, ...normal });
        return;
      }
      const face = { outward: 0, along: ring.radius < before.radius ? 1 : -1 };
      out.push({ ...before, ...face }, { ...ring, ...face });
    }
    out.push(ring);
  });
  return out;
}

export function painter(arm: SceneArm): (s: number) => Vector3 {
  return (s) => arm.markers.find(({ from, to }) => s >= from && s <= to)?.color ?? arm.color;
}

function stops_of(start: number, end: number, count: number, edges: number[]): number[] {
  const stops = Array.from({ length: count + 1 }, (_, i) => start + ((end - start) * i) / count);
  for (const edge of edges) if (edge > start && edge < end) stops.push(edge);
  return stops.sort((a, b) => a - b).filter((s, i, all) => i === 0 || s - all[i - 1] > 1e-9 * (end - start));
}

function same_color(a: Vector3, b: Vector3): boolean {
  return a[0] === b[0] && a[1] === b[1] && a[2] === b[2];
}

function base_cap(first: Ring): Ring[] {
  const flat = { ...first, outward: 0, along: -1 };
  return [{ ...flat, radius: 0 }, flat];
}

function tip_cap(last: Ring, kind: SceneArm['tip'], count: number): Ring[] {
  if (kind === 'flat') {
    const flat = { ...last, outward: 0, along: 1 };
    // A narrow rim that catches light, as every real edge has one.
    const rim = { ...last, outward: Math.SQRT1_2, along: Math.SQRT1_2, radius: (1 - rim_share) * last.radius };
    return [rim, { ...flat, radius: rim.radius }, { ...flat, radius: 0 }];
  }
  return Array.from({ length: count }, (_, i) => {
    const angle = ((i + 1) / count) * (Math.PI / 2);
    const outward = Math.cos(angle);
    const along = Math.sin(angle);
    return { ...last, offset: last.radius * along, radius: last.radius * outward, outward, along };
  });
}
