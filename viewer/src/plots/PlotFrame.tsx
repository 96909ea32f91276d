import type { RefObject } from 'preact';
import { useSignal } from '@preact/signals';
import { theme_now, type PlotAxis } from '../state/preferences';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { AxisFields } from './AxisFields';
import { series_color } from './chart';
import { csv_of, cut, save, type Table } from './csv';

interface Props {
  place: number;
  options: { id: string; label: string; unit: string }[];
  chosen: string;
  names: string[];
  /** Colours of the series, if they have their own. */
  colors?: string[];
  /** Note that only a part of the series is shown. */
  part: string | undefined;
  /** Values at the cursor or at the playback time. */
  values: (number | null | undefined)[];
  host: RefObject<HTMLDivElement>;
  /** Which are drawn: by their full names, in the same order. */
  series: { names: string[]; hidden: string[]; toggle(name: string): void };
  axis: PlotAxis;
  /** All series as a table. */
  table(): Table | null | Promise<Table | null>;
  /** The x axis is the time. */
  is_timed?: boolean;
  choose(id: string): void;
}

/** A plot's head: what is drawn, and its values at the cursor. */
export function PlotFrame({ place, options, chosen, names, part, values, host, choose, colors, series, axis, table, is_timed }: Props) {
  const { viewer, zoom } = use_app();
  const theme = theme_now();
  const is_open = useSignal(false);
  const size = Math.max(...values.map((value) => Math.abs(value ?? 0)));
  const is_set = axis.low !== null || axis.high !== null || axis.log;
  const keep = async (): Promise<void> => {
    try {
      const all = await table();
      if (!all) return viewer.notices.info('There are no values to save yet.');
      const range = is_timed && zoom.value ? zoom.value : ([-Infinity, Infinity] as [number, number]);
      save(all.name, csv_of(cut(all, range, (i) => !series.hidden.includes(series.names[i]))));
    } catch (error) {
      viewer.notices.error(error);
    }
  };
  return (
    <figure class="plot">
      <figcaption>
        <select aria-label={`Plot ${place + 1} shows`} title="What this plot shows" value={chosen} onChange={(event) => choose(event.currentTarget.value)}>
          {options.map(({ id, label, unit }) => <option key={id} value={id}>{unit ? `${label}, ${unit}` : label}</option>)}
        </select>
        <ul class="legend">
          {names.map((name, i) => (
            <li key={name}>
              <button type="button" aria-pressed={!series.hidden.includes(series.names[i])} onClick={() => series.toggle(series.names[i])}
                aria-label={`Draw ${name}`} title={`Draw ${name}, or not`}>
                <span class="swatch" style={{ background: colors?.[i] ?? series_color(i, theme) }} />
                {name} <output aria-live="off">{format(values[i], size)}</output>
              </button>
            </li>
          ))}
          {part && <li class="part">{part}</li>}
          {axis.log && <li class="part">log scale</li>}
        </ul>
        <span class="plot-tools">
          {is_timed && zoom.value && (
            <button type="button" class="button quiet" title="Shows the whole time range again (same as a double click in the plot)" onClick={() => (zoom.value = null)}>Whole time</button>
          )}
          <button type="button" class="icon-button" aria-expanded={is_open.value} data-set={is_set} aria-label={`Y axis of plot ${place + 1}`}
            title="Limits and scale of the y axis" onClick={() => (is_open.value = !is_open.value)}><Icon name="axis" /></button>
          <button type="button" class="icon-button" aria-label={`Save plot ${place + 1} as CSV`}
            title="Save the shown series as CSV, with their units" onClick={() => void keep()}><Icon name="save" /></button>
        </span>
      </figcaption>
      {is_open.value && <AxisFields place={place} id={chosen} axis={axis} />}
      <div class="chart" ref={host} />
    </figure>
  );
}

/** Formats a value; "0" if it is negligible compared with the others. */
function format(value: number | null | undefined, size: number): string {
  if (value === null || value === undefined) return '';
  return Math.abs(value) < 1e-4 * size ? '0' : `${+value.toPrecision(4)}`.replace('-', '−');
}
