import type { RefObject } from 'preact';
import { theme_now } from '../state/preferences';
import { series_color } from './chart';

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
  choose(id: string): void;
}

/** A plot's head: what is drawn, and its values at the cursor. */
export function PlotFrame({ place, options, chosen, names, part, values, host, choose, colors, series }: Props) {
  const theme = theme_now();
  const size = Math.max(...values.map((value) => Math.abs(value ?? 0)));
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
        </ul>
      </figcaption>
      <div class="chart" ref={host} />
    </figure>
  );
}

/** Formats a value; "0" if it is negligible compared with the others. */
function format(value: number | null | undefined, size: number): string {
  if (value === null || value === undefined) return '';
  return Math.abs(value) < 1e-4 * size ? '0' : `${+value.toPrecision(4)}`.replace('-', '−');
}
