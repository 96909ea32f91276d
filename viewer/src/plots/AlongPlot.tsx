import { useEffect, useRef } from 'preact/hooks';
import { effect, useSignal } from '@preact/signals';
import type { Along } from '../protocol/types';
import { use_app } from '../ui/app';
import { fill } from './chart';
import type { Table } from './csv';
import type { Columns } from './data';
import { PlotFrame } from './PlotFrame';
import { along_option } from './sources';
import { use_chart } from './use_chart';

interface Props {
  place: number;
  options: { id: string; label: string; unit: string }[];
  choose(id: string): void;
}

/** Quantities along the arm at the shown time, over arc length in m. */
export function AlongPlot({ place, options, choose }: Props) {
  const { viewer } = use_app();
  const at = useSignal<number | null>(null);
  const along = viewer.shown_extras.value?.along;
  const curves = along?.curves ?? [];
  const names = curves.map(({ label }) => label);
  const colors = curves.map(({ color }) => color);
  const draw = (made: Parameters<typeof fill>[0] | null): void => {
    const now = viewer.shown_extras.peek()?.along;
    // The chart is rebuilt when the curves change.
    if (made && now && made.series.length === now.curves.length + 1) fill(made, columns_of(now), [0, now.length]);
  };
  const latest = useRef(draw);
  latest.current = draw;
  const { host, chart, axis, series } = use_chart(along_option.id, names, along?.unit ?? '', draw, { colors, hover: (place) => (at.value = place) });
  useEffect(() => effect(() => {
    viewer.shown_extras.value;
    latest.current(chart.current);
  }), []);
  const i = along && at.value !== null ? Math.round((at.value / along.length) * ((curves[0]?.values.length ?? 1) - 1)) : -1;
  const table = (): Table | null => along
    ? { name: along_option.label, heads: [{ name: 's', unit: 'm' }, ...names.map((name) => ({ name, unit: along.unit }))], columns: columns_of(along) }
    : null;
  return (
    <PlotFrame place={place} series={series} axis={axis} table={table} options={options} chosen={along_option.id} names={names} colors={colors}
      part={along ? `${along.unit} over m` : 'Available while a servo is running'} host={host} choose={choose}
      values={curves.map(({ values }) => (i < 0 ? largest(values) : values[i]))} />
  );
}

export function columns_of({ length, curves }: Along): Columns {
  const count = curves[0]?.values.length ?? 0;
  return [Array.from({ length: count }, (_, i) => (length * i) / Math.max(1, count - 1)), ...curves.map(({ values }) => values)];
}

/** Without a cursor position, the largest values are shown. */
function largest(values: (number | null)[]): number {
  return Math.max(...values.map((value) => value ?? 0));
}
