// What the arm's sliders stand for in each way of saying its shape: plain functions, tested without a page.
import { archings_of, cord_angles_of } from '../math/planar';
import type { State } from '../protocol/state';
import type { Controls, Range } from '../protocol/types';
import type { ArmMode } from '../state/preferences';
import type { ArmCommand } from '../state/commander';

export interface Shape {
  /** One number a slider: as `modes_of` and `slots_of` say. */
  values: number[];
  stretches: number[];
  /** The bends that the tendons' values stand for, two a section. */
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

/** The sliders of a mode, in the order of `Shape.values`. */
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

/** The sliders' values in a state. `start` is the tangent's angle at a planar arm's base. */
export function values_of(mode: ArmMode, kind: 'planar' | 'spatial', state: State, start = Math.PI / 2): number[] {
  if (mode === 'tendons') return Array.from(state.displacements);
  if (kind === 'spatial') return Array.from(state.bends);
  const towards_x = Array.from({ length: state.bends.length / 2 }, (_, i) => state.bends[2 * i]);
  if (mode === 'bends') return towards_x;
  // Archings are counter-clockwise: the bend (-2b, 0).
  const archings = towards_x.map((bend) => -bend / 2);
  return mode === 'archings' ? archings : cord_angles_of(archings, start);
}

/** The request that makes the arm so. */
export function command_of(mode: ArmMode, kind: 'planar' | 'spatial', values: number[], stretches: number[] | null): ArmCommand {
  const shape: ArmCommand =
    mode === 'bends'
      ? { bends: kind === 'spatial' ? pairs(values) : values.map((bend) => [bend, 0]) }
      : { [mode]: values };
  // Tendons say all of the shape: nothing may stand beside them.
  return stretches && mode !== 'tendons' ? { ...shape, stretches } : shape;
}

function pairs(values: number[]): [number, number][] {
  return Array.from({ length: values.length / 2 }, (_, i) => [values[2 * i], values[2 * i + 1]]);
}

/** Where the value i can be while the others stay; of tendons, those of the same shape: tendons.ts. */
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
  // A section's cord may leave the tangent at its start by half the bend.
  const before = archings_of(values.slice(0, i), start);
  const tangent = before.reduce((sum, arching) => sum + 2 * arching, start);
  return [tangent - limit / 2, tangent + limit / 2];
}

/** More than that to a side of the base's tangent is no way to see what a slider does: rad. */
const widest_cord = 1.25 * Math.PI;

/** How far the cord of the section i can lean from the base's tangent when all before lean that way too, rad. */
function cord_reach({ sections }: Controls, i: number): number {
  const limit = (j: number): number => sections[j].bend ?? Infinity;
  return sections.slice(0, i).reduce((sum, _, j) => sum + limit(j), limit(i) / 2);
}

/** The ends of the slider i: the limits and a bit more, so that one sees them. */
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

/** The values with the one at i changed, and what then no longer can be drawn to its reach. Of tendons: tendons.ts. */
export function changed(
  mode: Exclude<ArmMode, 'tendons'>, kind: 'planar' | 'spatial', controls: Controls, values: number[], i: number, value: number, start = Math.PI / 2,
): number[] {
  const next = [...values];
  const draw = (j: number, target: number): void => {
    const [low, high] = reach_of(mode, kind, controls, next, j, start);
    next[j] = Math.min(high, Math.max(low, target));
  };
  draw(i, value);
  // Cord angles lean on those before them.
  if (mode === 'cord_angles') for (let j = i + 1; j < next.length; ++j) draw(j, next[j]);
  return next;
}

/** The angle of a planar arm's base tangent from +X. */
export function start_tangent(base: ArrayLike<number>): number {
  const [, , , w, x, y, z] = Array.from(base);
  return Math.atan2(2 * (y * z - w * x), 2 * (x * z + w * y));
}
