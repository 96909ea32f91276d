// uPlot with the page's colours and the shared cursor.
import uPlot from 'uplot';
import type { PlotAxis } from '../state/preferences';
import { range_of } from './axis';
import type { Columns } from './data';

export interface ChartOptions {
  host: HTMLElement;
  names: string[];
  unit: string;
  /** Time of the playback line. */
  now(): number | null;
  hover(time: number | null): void;
  seek(time: number): void;
  /** Shows a part of the x axis; null: all of it. */
  zoom(range: [number, number] | null): void;
  /** The y axis; whether it is logarithmic does not change. */
  axis(): PlotAxis;
  /** The x axis is not the time shared with the other plots. */
  is_alone?: boolean;
  colors?: string[];
}

/** Distinguishable on both backgrounds, and with colour blindness as far as possible for nine colours. */
const palettes = {
  dark: ['#4dabf7', '#ff922b', '#51cf66', '#f06595', '#ffd43b', '#22b8cf', '#b197fc', '#ff8787', '#94d82d'],
  light: ['#1971c2', '#d9480f', '#2b8a3e', '#a61e4d', '#a86a00', '#0b7285', '#6741d9', '#c92a2a', '#5c940d'],
};

/** A shorter drag, px, is a click. */
const least_drag = 6;

export function make_chart({ host, names, unit, now, hover, seek, zoom, axis: y_axis, is_alone, colors }: ChartOptions): uPlot {
  const style = getComputedStyle(document.documentElement);
  const color = (name: string): string => style.getPropertyValue(name).trim();
  const palette = colors ?? palettes[document.documentElement.dataset.theme === 'light' ? 'light' : 'dark'];
  const font = '11px system-ui, sans-serif';
  const axis: uPlot.Axis = {
    stroke: color('--text-quiet'),
    font,
    grid: { stroke: color('--grid'), width: 1 },
    ticks: { stroke: color('--grid'), width: 1, size: 4 },
  };
  const chart = new uPlot({
    width: Math.max(100, host.clientWidth),
    height: Math.max(60, host.clientHeight),
    legend: { show: false },
    padding: [8, 10, 0, 0],
    scales: { x: { time: false }, y: { distr: y_axis().log ? 3 : 1, range: (_, low, high) => range_of(low, high, y_axis()) } },
    cursor: {
      ...(is_alone ? {} : { sync: { key: 'flexura' } }), points: { size: 6 }, y: false,
      drag: { x: !is_alone, y: false, setScale: false, dist: least_drag },
      bind: { dblclick: () => () => (zoom(null), null) },
    },
    axes: [
      { ...axis, size: 24, values: (_, all) => all.map((t) => `${+t.toFixed(3)}`) },
      { ...axis, size: 52, values: (_, all) => all.map((value) => (value === null ? '' : `${+value.toPrecision(6)}`.replace('-', '−'))) },
    ],
    series: [
      {},
      ...names.map((name, i) => ({
        label: name, stroke: palette[i % palette.length], width: 1.5, points: { show: false },
        dash: i >= palette.length ? [6, 3] : undefined, gaps: visible, value: (_: uPlot, v: number | null) => `${v ?? '–'} ${unit}`,
      })),
    ],
    hooks: {
      setCursor: [(u) => hover(u.cursor.left !== undefined && u.cursor.left >= 0 ? u.posToVal(u.cursor.left, 'x') : null)],
      setSelect: [(u) => {
        const { left, width } = u.select;
        if (width < least_drag) return;
        u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
        const range: [number, number] = [u.posToVal(left, 'x'), u.posToVal(left + width, 'x')];
        // The other plot has the same selection: it must not find its axis zoomed already.
        queueMicrotask(() => zoom(range));
      }],
      draw: [(u) => draw_now(u, now(), color('--accent'))],
    },
  }, [[], ...names.map(() => [])] as unknown as uPlot.AlignedData, host);
  chart.over.addEventListener('click', ({ detail }) => {
    const { left } = chart.cursor;
    // The second click of a double click belongs to it.
    if (detail > 1) return;
    if (left !== undefined && left >= 0) seek(chart.posToVal(left, 'x'));
  });
  return chart;
}

/** Gaps between points that fall into one pixel are widened by a pixel on both sides to be visible. */
const visible: uPlot.Series.GapsRefiner = (_, __, ___, ____, found) =>
  found.map(([from, to]): [number, number] => [from - devicePixelRatio, to + devicePixelRatio]);

export function series_color(i: number, theme: 'dark' | 'light'): string {
  return palettes[theme][i % palettes[theme].length];
}

export function fill(chart: uPlot, columns: Columns, range: [number, number]): void {
  // Other series were selected, and their chart does not exist yet.
  if (columns.length !== chart.series.length) return;
  const drawn = chart.scales.y.distr === 3 ? positive(columns) : columns;
  chart.batch(() => {
    chart.setData(drawn as unknown as uPlot.AlignedData, false);
    chart.setScale('x', { min: range[0], max: range[1] });
  });
}

/** A log scale has no place for 0 and below: gaps. */
function positive([places, ...series]: Columns): Columns {
  return [places, ...series.map((values) => values.map((value) => (value !== null && value > 0 ? value : null)))];
}

function draw_now(chart: uPlot, time: number | null, color: string): void {
  if (time === null) return;
  const x = Math.round(chart.valToPos(time, 'x', true));
  const { left, top, width, height } = chart.bbox;
  if (x < left || x > left + width) return;
  const { ctx } = chart;
  ctx.save();
  ctx.strokeStyle = color;
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(x, top);
  ctx.lineTo(x, top + height);
  ctx.stroke();
  ctx.restore();
}
