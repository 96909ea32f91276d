// Meaning of the arm's sliders in each shape representation: plain functions, tested without a page.
import { archings_of, cord_angles_of } from '../math/planar';
import type { State } from '../protocol/state';
import type { Controls, Range } from '../protocol/types';
import type { ArmMode } from '../state/preferences';
import type { ArmCommand } from '../state/commander';

export interface Shape {
  /** One number per slider, see `modes_of` and `slots_of`. */
  values: number[];
  stretches: number[];
  /** Bends that correspond to the tendon values, two per section, rad. */
  bends: number[];
}

export interface Slot {
  section: number;
  label: string;
  /** Unit of the display. */
  unit: 'deg' | 'mm';
}

export const mode_names: Record<ArmMode, string> = {
  bends: 'Bends', archings: 'Archings', cord_angles: 'Cord angles', tendons: 'Tendons',
};

export function modes_of(kind: 'planar' | 'spatial', controls: Controls): ArmMode[] {
  const shapes: ArmMode[] = kind === 'planar' ? ['archings', 'cord_angles', 'bends'] : ['bends'];
  return controls.tendons || controls.actuators ? [...shapes, 'tendons'] : shapes;
}

/** Returns the sliders of a mode, in the order of `Shape.values`. */
export function slots_of(mode: ArmMode, kind: 'planar' | 'spatial', controls: Controls): Slot[] {
  if (mode === 'tendons') {
    return (controls.tendons ?? []).map(({ section }, i) => ({ section, label: `Tendon ${i + 1}`, unit: 'mm' }));
  }
  return controls.sections.flatMap((_, section): Slot[] => {
    if (kind === 'spatial') {
      return [
        { section, label: 'towards x', unit: 'deg' },
        { section, label: 'towards y', unit: 'deg' },
      ];
    }
    const label = { bends: 'bend towards x', archings: 'arching', cord_angles: 'cord angle' }[mode];
    return [{ section, label, unit: 'deg' }];
  });
}

/** Returns the slider values of a state. `start` is the tangent angle at a planar arm's base, rad. */
export function values_of(mode: ArmMode, kind: 'planar' | 'spatial', state: State, start = Math.PI / 2): number[] {
  if (mode === 'tendons') return Array.from(state.displacements);
  if (kind === 'spatial') return Array.from(state.bends);
  const towards_x = Array.from({ length: state.bends.length / 2 }, (_, i) => state.bends[2 * i]);
  if (mode === 'bends') return towards_x;
  // Archings are positive counter-clockwise: the bend is (-2b, 0).
  const archings = towards_x.map((bend) => -bend / 2);
  return mode === 'archings' ? archings : cord_angles_of(archings, start);
}

/** Returns the request that commands this shape. */
export function command_of(mode: ArmMode, kind: 'planar' | 'spatial', values: number[], stretches: number[] | null): ArmCommand {
  const shape: ArmCommand =
    mode === 'bends'
      ? { bends: kind === 'spatial' ? pairs(values) : values.map((bend) => [bend, 0]) }
      : { [mode]: values };
  // Tendons determine the complete shape, so stretches are omitted.
  return stretches && mode !== 'tendons' ? { ...shape, stretches } : shape;
}

function pairs(values: number[]): [number, number][] {
  return Array.from({ length: values.length / 2 }, (_, i) => [values[2 * i], values[2 * i + 1]]);
}

/** Returns the reachable range of value i with the others fixed. For tendons see tendons.ts. */
export function reach_of(
  mode: Exclude<ArmMode, 'tendons'>, kind: 'planar' | 'spatial', controls: Controls, values: number[], i: number, start = Math.PI / 2,
): Range {
  const limit = controls.sections[kind === 'spatial' ? i >> 1 : i].bend ?? Infinity;
  if (kind === 'spatial') {
    const other = values[i ^ 1];
    const rest = Math.sqrt(Math.max(0, limit * limit - other * other));
    return [-rest, rest];
  }
  if (mode === 'bends') return [-limit, limit];
  if (mode === 'archings') return [-limit / 2, limit / 2];
  // A section's cord deviates from the tangent at its start by at most half the bend limit.
  const before = archings_of(values.slice(0, i), start);
  const tangent = before.reduce((sum, arching) => sum + 2 * arching, start);
  return [tangent - limit / 2, tangent + limit / 2];
}

/** Largest shown cord angle to either side of the base tangent, rad; a wider slider would be hard to read. */
const widest_cord = 1.25 * Math.PI;

/**
 * Returns how far the cord of section i can turn from the base tangent if all sections before turn the same way, rad.
 */
function cord_reach({ sections }: Controls, i: number): number {
  const limit = (j: number): number => sections[j].bend ?? Infinity;
  return sections.slice(0, i).reduce((sum, _, j) => sum + limit(j), limit(i) / 2);
}

/** Returns the ends of slider i: slightly beyond the limits, so that the limits are visible. */
export function span_of(mode: ArmMode, kind: 'planar' | 'spatial', controls: Controls, i: number, value: number, start = Math.PI / 2): Range {
  if (mode === 'tendons') {
    const [low, high] = controls.tendons?.[i].displacement ?? [-0.1, 0.1];
    const margin = 0.06 * (high - low);
    return [low - margin, high + margin];
  }
  if (mode === 'cord_angles') {
    const most = Math.min(widest_cord, 1.06 * cord_reach(controls, i));
    return [Math.min(start - most, value), Math.max(start + most, value)];
  }
  const limit = controls.sections[kind === 'spatial' ? i >> 1 : i].bend ?? 2 * Math.PI;
  const most = 1.06 * (mode === 'archings' ? limit / 2 : limit);
  return [Math.min(-most, value), Math.max(most, value)];
}

/**
 * Returns the values with value i changed, and all values clamped to their reachable ranges. For tendons see
 * tendons.ts.
 */
export function changed(
  mode: Exclude<ArmMode, 'tendons'>, kind: 'planar' | 'spatial', controls: Controls, values: number[], i: number, value: number, start = Math.PI / 2,
): number[] {
  const next = [...values];
  const draw = (j: number, target: number): void => {
    const [low, high] = reach_of(mode, kind, controls, next, j, start);
    next[j] = Math.min(high, Math.max(low, target));
  };
  draw(i, value);
  // Reachable cord angles depend on those before them.
  if (mode === 'cord_angles') for (let j = i + 1; j < next.length; ++j) draw(j, next[j]);
  return next;
}

/** Returns the angle of a planar arm's base tangent from +X, rad. */
export function start_tangent(base: ArrayLike<number>): number {
  const [, , , w, x, y, z] = Array.from(base);
  return Math.atan2(2 * (y * z - w * x), 2 * (x * z + w * y));
}
