// A plot's y axis: its limits, chosen or typed, linear or logarithmic.
import { preferences, type PlotAxis } from '../state/preferences';

export const auto: PlotAxis = { low: null, high: null, log: false };

/** Returns the axis that was set for what is plotted. */
export function axis_of(id: string): PlotAxis {
  return { ...auto, ...preferences.plot_axes.value[id] };
}

/** Keeps an axis, or forgets it where nothing is set. */
export function set_axis(id: string, axis: PlotAxis): void {
  const { [id]: _, ...others } = preferences.plot_axes.peek();
  const is_auto = axis.low === null && axis.high === null && !axis.log;
  preferences.plot_axes.value = is_auto ? others : { ...others, [id]: axis };
}

/** Returns why a limit cannot be; null if it can. */
export function objection({ low, high, log }: PlotAxis): string | null {
  if (low !== null && high !== null && low >= high) return 'The lower limit must be below the upper one.';
  return log && (low ?? 1) <= 0 || log && (high ?? 1) <= 0 ? 'Limits of a log scale must be above 0.' : null;
}

/** Returns the range of the axis for values from `low` to `high`; null if there are no values. */
export function range_of(low: number | null, high: number | null, axis: PlotAxis): [number, number] {
  const [from, to] = axis.log ? decades(low, high) : roomy(low, high);
  const least = axis.low ?? from;
  const most = axis.high ?? to;
  if (least < most) return [least, most];
  // One limit was typed, and all values are beyond it.
  if (axis.log) return axis.low === null ? [most / 10, most] : [least, least * 10];
  const size = Math.abs(least) || 1;
  return axis.low === null ? [most - size, most] : [least, least + size];
}

/** Constant lines are centred, and there is a margin at the border. */
function roomy(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const flat = high - low < 1e-6 * size || size < 1e-9;
  const margin = flat ? 0.1 * size || 1 : 0.08 * (high - low);
  return [low - margin, high + margin];
}

/** Whole decades around positive values. */
function decades(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !(low > 0) || !Number.isFinite(high)) return [0.1, 10];
  const from = 10 ** Math.floor(Math.log10(low) + 1e-9);
  const to = 10 ** Math.ceil(Math.log10(high) - 1e-9);
  return [from, to > from ? to : 10 * from];
}
