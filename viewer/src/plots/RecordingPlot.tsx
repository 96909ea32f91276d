import { useEffect, useRef } from 'preact/hooks';
import { effect, useSignal } from '@preact/signals';
import type { Hello } from '../protocol/types';
import { use_app } from '../ui/app';
import { fill } from './chart';
import type { Table } from './csv';
import { fetch_series, type Columns } from './data';
import { PlotFrame } from './PlotFrame';
import { short_names, shown_groups } from './sources';
import { use_chart } from './use_chart';

const points = 2000;
/** Times as many points as that, where the plot is zoomed. */
const most_finer = 16;
/** Most points that the program sends (docs/viewer-protocol.md). */
const most_points = 100_000;

interface Props {
  hello: Hello;
  place: number;
  chosen: string;
  options: { id: string; label: string; unit: string }[];
  choose(id: string): void;
}

/** Plot of a recording's quantities over its whole time. Angles are in degrees. */
export function RecordingPlot({ hello, place, chosen, options, choose }: Props) {
  const { viewer, cursor, zoom } = use_app();
  const columns = useSignal<Columns | null>(null);
  const groups = shown_groups(hello);
  const group = groups.find(({ id }) => id === chosen) ?? standard(groups, place);
  const duration = Math.max(hello.duration, 1e-9);
  const draw = (chart: Parameters<typeof fill>[0] | null): void => {
    if (chart && columns.value) fill(chart, columns.value, zoom.value ?? [0, duration]);
  };
  // A part of the time needs finer points than the whole of it.
  const finer = zoom.value ? Math.min(most_finer, Math.max(1, 2 ** Math.floor(Math.log2(duration / (zoom.value[1] - zoom.value[0]))))) : 1;
  const names = group?.names ?? [];
  const { host, chart, axis, series } = use_chart(group?.id ?? '', names, group?.unit ?? '', draw);
  const wanted = useRef('');
  const latest = useRef(draw);
  latest.current = draw;
  useEffect(() => {
    if (!group) return;
    const id = `${group.id} ${finer}`;
    if (!wanted.current.startsWith(`${group.id} `)) columns.value = null;
    wanted.current = id;
    fetch_series(document.baseURI, names, points * finer, group.factor).then(
      (fetched) => {
        if (wanted.current !== id) return;
        columns.value = fetched;
        latest.current(chart.current);
      },
      (error: unknown) => viewer.notices.error(error),
    );
  }, [group?.id, finer]);
  useEffect(() => effect(() => {
    zoom.value;
    latest.current(chart.current);
  }), []);
  useEffect(() => effect(() => {
    viewer.playback.time.value;
    chart.current?.redraw(false);
  }), []);
  // Every state of the recording, not only what is drawn.
  const table = async (): Promise<Table | null> => {
    if (!group) return null;
    const all = Math.min(most_points, Math.max(2, Math.ceil(duration / Math.max(hello.interval, 1e-6)) + 1));
    return {
      name: group.label,
      heads: [{ name: 'time', unit: 's' }, ...names.map((name) => ({ name, unit: group.unit }))],
      columns: await fetch_series(document.baseURI, names, all, group.factor),
    };
  };
  const at = cursor.value ?? viewer.playback.time.value;
  const row = columns.value ? nearest(columns.value[0], at) : -1;
  return (
    <PlotFrame place={place} series={series} axis={axis} table={table} is_timed options={options} chosen={group?.id ?? ''} names={short_names(names)} part={group?.part} host={host} choose={choose}
      values={names.map((_, i) => (row >= 0 ? columns.value![i + 1][row] : null))} />
  );
}

/** Returns the default group of a plot: the tip first, then a servo's errors, then the others in order. */
function standard<G extends { id: string }>(groups: G[], place: number): G | undefined {
  const rank = ({ id }: G): number => (id.startsWith('tip') ? 0 : id.startsWith('servo') ? 1 : 2);
  const order = [...groups].sort((a, b) => rank(a) - rank(b));
  return order[Math.min(place, order.length - 1)];
}

function nearest(times: number[], time: number): number {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return high >= 0 && Math.abs(times[high] - time) < Math.abs(times[low] - time) ? high : low;
}
