// Tendons that can be pulled in one by one: plain functions, tested without a page.
import { actuator_force, actuator_lost, actuator_stride, type State } from '../protocol/state';
import type { ActuatorControl, Range } from '../protocol/types';

export interface ActuatorState {
  /** m */
  value: number;
  /** N */
  force: number;
  slack: boolean;
  /** Of its motor. */
  lost: number;
}

/** Less than that no tendon pulls, N. */
const least_force = 1e-6;

/** As they are in a state; none of one that does not tell of them. */
export function actuators_of({ actuators }: State): ActuatorState[] {
  return Array.from({ length: actuators.length / actuator_stride }, (_, i) => {
    const [value, force, lost] = [0, actuator_force, actuator_lost].map((part) => actuators[actuator_stride * i + part]);
    return { value, force, slack: force < least_force, lost };
  });
}

/** All of them when the one at i goes to `value`: alone, or together with the others, as far as all of these can. */
export function moved(actuators: ActuatorControl[], values: number[], i: number, value: number, together: boolean): number[] {
  const clamp = ([low, high]: Range, target: number): number => Math.min(high, Math.max(low, target));
  const target = clamp(actuators[i].range, value);
  if (!together) return values.map((old, j) => (j === i ? target : old));
  const way = target - values[i];
  const share = actuators[i].together.reduce((least, part, j) => {
    const step = part * way;
    if (Math.abs(step) < 1e-12) return least;
    const [low, high] = actuators[j].range;
    return Math.min(least, Math.max(0, (step > 0 ? high - values[j] : low - values[j]) / step));
  }, 1);
  return values.map((old, j) => clamp(actuators[j].range, old + share * way * actuators[i].together[j]));
}

/** The end of a scale on which the greatest of these can be read: 1, 2 or 5 times a power of ten, from 1 N on. */
export function force_scale(forces: number[]): number {
  const most = Math.max(1, ...forces);
  const power = 10 ** Math.floor(Math.log10(most));
  return [1, 2, 5, 10].map((step) => step * power).find((end) => end >= most * (1 - 1e-9)) ?? 10 * power;
}

/** A tension as one reads it: three digits, and no more than two places. */
export function force_text(force: number): string {
  const places = force < 10 ? 2 : force < 100 ? 1 : 0;
  return `${force.toFixed(places)} N`;
}
