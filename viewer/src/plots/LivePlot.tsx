import { useEffect, useRef } from 'preact/hooks';
import { effect } from '@preact/signals';
import type { Hello, Scene } from '../protocol/types';
import { use_app } from '../ui/app';
import { fill } from './chart';
import { window_of } from './data';
import { PlotFrame } from './PlotFrame';
import { live_sources, short_names } from './sources';
import { use_chart } from './use_chart';

const window_s = 20;
/** Minimum width of the time window at the start, s. */
const least_s = 2;

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
  const { viewer, cursor } = use_app();
  const sources = live_sources(hello, scene);
  const source = sources.find(({ id }) => id === chosen) ?? sources[Math.min(place, sources.length - 1)];
  const latest = useRef(source);
  latest.current = source;
  const { host, chart, series } = use_chart(source.names, source.unit, () => {});
  useEffect(() => effect(() => {
    viewer.tick.value;
    const { history } = viewer;
    const newest = history.newest?.time;
    if (newest === undefined || !chart.current) return;
    // A held time keeps its place; the window moves only to keep it visible.
    const held = viewer.playback.held.value;
    const end = held === null ? newest : Math.min(newest, Math.max(held + window_s / 2, history.oldest!.time + window_s));
    const start = Math.max(history.oldest!.time, end - window_s);
    fill(chart.current, window_of(history, latest.current, end, window_s), [start, Math.max(end, start + least_s)]);
  }), []);
  viewer.tick.value;
  const at = cursor.value ?? viewer.playback.held.value;
  const state = at === null ? viewer.history.newest : viewer.history.at(at);
  return (
    <PlotFrame place={place} series={series} options={options} chosen={source.id} names={short_names(source.names)} part={source.part} host={host} choose={choose}
      values={source.names.map((_, i) => (state ? source.value(state, i) : null))} />
  );
}
