// Data columns of a plot.
import type { History } from '../state/history';
import type { Source } from './sources';

/** Times, and values by series; null values interrupt a line. */
export type Columns = [number[], ...(number | null)[][]];

/** Maximum number of points of a drawn live plot; more cannot be resolved by the screen. */
const most_points = 500;

/**
 * Returns the last seconds of a source, thinned so that points keep their places between frames. Lines are interrupted
 * where the arm jumped to another position without motion (`leaps`).
 */
export function window_of(history: History, source: Source, until: number, seconds: number, most = most_points): Columns {
  const times: number[] = [];
  const series = source.names.map(() => [] as (number | null)[]);
  const columns: Columns = [times, ...series];
  if (!history.count) return columns;
  const first = history.index_at(until - seconds);
  const last = history.index_at(until);
  const stride = Math.max(1, Math.ceil((last - first) / most));
  for (let i = first; i <= last; ++i) {
    const state = history.at_index(i);
    const next = i < last ? history.at_index(i + 1) : state;
    const leaps = next.leaps !== state.leaps;
    const has_leapt = i > first && history.at_index(i - 1).leaps !== state.leaps;
    if (state.sequence % stride !== 0 && i !== last && !leaps && !has_leapt) continue;
    times.push(state.time);
    series.forEach((values, j) => values.push(source.value(state, j)));
    if (!leaps) continue;
    times.push((state.time + next.time) / 2);
    series.forEach((values) => values.push(null));
  }
  return columns;
}

/** Fetches a recording's quantities from the program. Throws with a message for the page. */
export async function fetch_series(base: string, names: string[], points: number, factor: number): Promise<Columns> {
  const address = new URL('series', base);
  address.searchParams.set('names', names.join(','));
  address.searchParams.set('points', String(points));
  const answer = await fetch(address, { credentials: 'same-origin' });
  if (!answer.ok) throw new Error(`The plot’s data were not received (${answer.status}).`);
  const series = (await answer.json()) as Record<string, (number | null)[]>;
  // Missing values interrupt the line.
  const scaled = (values: (number | null)[] = []): (number | null)[] =>
    (factor === 1 ? values : values.map((value) => (value === null ? null : value * factor)));
  return [series.time as number[], ...names.map((name) => scaled(series[name]))];
}

