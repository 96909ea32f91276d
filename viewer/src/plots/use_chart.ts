import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import type uPlot from 'uplot';
import { theme_now } from '../state/preferences';
import { use_app } from '../ui/app';
import { axis_of } from './axis';
import { make_chart } from './chart';

/** Settings of a chart whose x axis is not time. */
export interface Alone {
  colors: string[];
  hover(place: number | null): void;
}

/**
 * Creates a chart in its host element and recreates it if the series or the theme change. It has the size of its host.
 */
export function use_chart(id: string, names: string[], unit: string, ready: (chart: uPlot) => void, alone?: Alone) {
  const app = use_app();
  const host = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot | null>(null);
  /** Names of the series that are not drawn. */
  const hidden = useSignal<string[]>([]);
  const theme = theme_now();
  const axis = axis_of(id);
  const signature = `${names.join('|')} ${unit} ${theme} ${axis.log}`;
  const latest = useRef({ id, ready });
  latest.current = { id, ready };
  /** Where the time stood before a click, which may turn out to be the first of two. */
  const before = useRef<number | null>(null);
  useEffect(() => {
    const { playback } = app.viewer;
    const made = make_chart({
      host: host.current!,
      names,
      unit,
      is_alone: alone !== undefined,
      colors: alone?.colors,
      now: () => (alone ? null : playback.mode.value === 'live' ? playback.held.value : playback.time.value),
      hover: (time) => (alone ? alone.hover(time) : (app.cursor.value = time)),
      seek: (time) => {
        if (alone) return;
        before.current = playback.mode.value === 'live' ? playback.held.value : playback.time.value;
        playback.seek(time);
      },
      zoom: (range) => {
        if (alone) return;
        if (range === null && app.zoom.peek() !== null) {
          if (before.current === null) playback.go_live();
          else playback.seek(before.current);
        }
        app.zoom.value = range;
      },
      axis: () => axis_of(latest.current.id),
    });
    chart.current = made;
    names.forEach((name, i) => hidden.peek().includes(name) && made.setSeries(i + 1, { show: false }));
    ready(made);
    const observer = new ResizeObserver(([{ contentRect }]) => {
      if (contentRect.width > 0) made.setSize({ width: Math.floor(contentRect.width), height: Math.floor(contentRect.height) });
    });
    observer.observe(host.current!);
    return () => {
      observer.disconnect();
      made.destroy();
      chart.current = null;
    };
  }, [signature]);
  useEffect(() => {
    if (chart.current) latest.current.ready(chart.current);
  }, [axis.low, axis.high]);
  const toggle = (name: string): void => {
    const shows = hidden.value.includes(name);
    hidden.value = shows ? hidden.value.filter((other) => other !== name) : [...hidden.value, name];
    chart.current?.setSeries(names.indexOf(name) + 1, { show: shows });
  };
  return { host, chart, axis, series: { names, hidden: hidden.value, toggle } };
}
