// Individually driven tendons: plain functions, tested without a page.
import { actuator_force, actuator_lost, actuator_stride, type State } from '../protocol/state';
import type { ActuatorControl, Range } from '../protocol/types';

export interface ActuatorState {
  /** Displacement, m. */
  value: number;
  /** Tension, N. */
  force: number;
  slack: boolean;
  /** Lost steps of the motor. */
  lost: number;
}

/** Smaller tensions count as zero, N. */
const least_force = 1e-6;

/** Returns the actuators of a state; empty if the state has none. */
export function actuators_of({ actuators }: State): ActuatorState[] {
  return Array.from({ length: actuators.length / actuator_stride }, (_, i) => {
    const [value, force, lost] = [0, actuator_force, actuator_lost].map((part) => actuators[actuator_stride * i + part]);
    return { value, force, slack: force < least_force, lost };
  });
}

/** Returns all values when actuator i moves to `value`, alone or coupled with the others within all their limits. */
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

/** Returns the end of a scale for these forces: 1, 2 or 5 times a power of ten, at least 1 N. */
export function force_scale(forces: number[]): number {
  const most = Math.max(1, ...forces);
  const power = 10 ** Math.floor(Math.log10(most));
  return [1, 2, 5, 10].map((step) => step * power).find((end) => end >= most * (1 - 1e-9)) ?? 10 * power;
}

/** Formats a tension: three digits, at most two decimal places. */
export function force_text(force: number): string {
  const places = force < 10 ? 2 : force < 100 ? 1 : 0;
  return `${force.toFixed(places)} N`;
}
