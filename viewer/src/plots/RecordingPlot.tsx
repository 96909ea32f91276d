import { useEffect, useRef } from 'preact/hooks';
import { effect, useSignal } from '@preact/signals';
import type { Hello } from '../protocol/types';
import { use_app } from '../ui/app';
import { fill } from './chart';
import { fetch_series, type Columns } from './data';
import { PlotFrame } from './PlotFrame';
import { short_names, shown_groups } from './sources';
import { use_chart } from './use_chart';

const points = 2000;

interface Props {
  hello: Hello;
  place: number;
  chosen: string;
  options: { id: string; label: string; unit: string }[];
  choose(id: string): void;
}

/** Plot of a recording's quantities over its whole time. Angles are in degrees. */
export function RecordingPlot({ hello, place, chosen, options, choose }: Props) {
  const { viewer, cursor } = use_app();
  const columns = useSignal<Columns | null>(null);
  const groups = shown_groups(hello);
  const group = groups.find(({ id }) => id === chosen) ?? standard(groups, place);
  const duration = Math.max(hello.duration, 1e-9);
  const draw = (chart: Parameters<typeof fill>[0] | null): void => {
    if (chart && columns.value) fill(chart, columns.value, [0, duration]);
  };
  const names = group?.names ?? [];
  const { host, chart, series } = use_chart(names, group?.unit ?? '', draw);
  const wanted = useRef('');
  useEffect(() => {
    if (!group) return;
    wanted.current = group.id;
    columns.value = null;
    fetch_series(document.baseURI, names, points, group.factor).then(
      (fetched) => {
        if (wanted.current !== group.id) return;
        columns.value = fetched;
        draw(chart.current);
      },
      (error: unknown) => viewer.notices.error(error),
    );
  }, [group?.id]);
  useEffect(() => effect(() => {
    viewer.playback.time.value;
    chart.current?.redraw(false);
  }), []);
  const at = cursor.value ?? viewer.playback.time.value;
  const row = columns.value ? nearest(columns.value[0], at) : -1;
  return (
    <PlotFrame place={place} series={series} options={options} chosen={group?.id ?? ''} names={short_names(names)} part={group?.part} host={host} choose={choose}
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
