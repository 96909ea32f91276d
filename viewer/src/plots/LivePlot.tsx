import { useEffect, useRef } from 'preact/hooks';
import { effect } from '@preact/signals';
import type { Hello, Scene } from '../protocol/types';
import type { Viewer } from '../state/viewer';
import { use_app } from '../ui/app';
import { fill } from './chart';
import type { Table } from './csv';
import { window_of } from './data';
import { PlotFrame } from './PlotFrame';
import { live_sources, short_names } from './sources';
import { use_chart } from './use_chart';

const window_s = 20;
/** Minimum width of the time window at the start, s. */
const least_s = 2;

/** Returns the times that are shown: those of the zoom, or the last seconds. */
function shown_range({ history, playback }: Viewer, zoom: [number, number] | null): [number, number] | null {
  const newest = history.newest?.time;
  const oldest = history.oldest?.time;
  if (newest === undefined || oldest === undefined) return null;
  if (zoom) return zoom;
  // A held time keeps its place; the window moves only to keep it visible.
  const held = playback.held.value;
  const end = held === null ? newest : Math.min(newest, Math.max(held + window_s / 2, oldest + window_s));
  return [Math.max(oldest, end - window_s), end];
}

interface Props {
  hello: Hello;
  scene: Scene;
  place: number;
  chosen: string;
  options: { id: string; label: string; unit: string }[];
  choose(id: string): void;
}

/** Plot of the last seconds of the rig in a sliding window. */
export function LivePlot({ hello, scene, place, chosen, options, choose }: Props) {
  const { viewer, cursor, zoom } = use_app();
  const sources = live_sources(hello, scene);
  const source = sources.find(({ id }) => id === chosen) ?? sources[Math.min(place, sources.length - 1)];
  const latest = useRef(source);
  latest.current = source;
  const draw = (made: Parameters<typeof fill>[0] | null): void => {
    const range = shown_range(viewer, zoom.value);
    if (!range || !made) return;
    const [start, end] = range;
    fill(made, window_of(viewer.history, latest.current, end, end - start), [start, Math.max(end, start + (zoom.value ? 0 : least_s))]);
  };
  const { host, chart, axis, series } = use_chart(source.id, source.names, source.unit, draw);
  useEffect(() => effect(() => {
    viewer.tick.value;
    const { oldest } = viewer.history;
    // The page forgets what was long ago.
    if (zoom.value && oldest && zoom.value[1] <= oldest.time) zoom.value = null;
    draw(chart.current);
  }), []);
  const table = (): Table | null => {
    const range = shown_range(viewer, zoom.value);
    if (!range) return null;
    return {
      name: source.label,
      heads: [{ name: 'time', unit: 's' }, ...source.names.map((name) => ({ name: `${source.label} ${name}`, unit: source.unit }))],
      columns: window_of(viewer.history, source, range[1], range[1] - range[0], Infinity),
    };
  };
  viewer.tick.value;
  const at = cursor.value ?? viewer.playback.held.value;
  const state = at === null ? viewer.history.newest : viewer.history.at(at);
  return (
    <PlotFrame place={place} series={series} axis={axis} table={table} is_timed options={options} chosen={source.id} names={short_names(source.names)} part={source.part} host={host} choose={choose}
      values={source.names.map((_, i) => (state ? source.value(state, i) : null))} />
  );
}
