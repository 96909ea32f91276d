// Values of a plot as a table.
import type { Columns } from './data';

export interface Table {
  /** Without its ending. */
  name: string;
  /** One for each column, the first one included: name and unit. */
  heads: { name: string; unit: string }[];
  columns: Columns;
}

/** Units as ASCII text: many programs read CSV in another encoding. */
const ascii_units: Record<string, string> = { '°': 'deg', 'µm': 'um' };

/** Returns lines of comma-separated values, the names and units first; rows without any value are left out. */
export function csv_of({ heads, columns }: Table): string {
  const head = heads.map(({ name, unit }) => quoted(unit ? `${name} [${ascii_units[unit] ?? unit}]` : name)).join(',');
  const [first, ...series] = columns;
  const rows = first.flatMap((place, i) => {
    const values = series.map((each) => each[i] ?? null);
    return values.some((value) => value !== null) ? [[place, ...values].map(text_of).join(',')] : [];
  });
  return `${[head, ...rows].join('\n')}\n`;
}

function quoted(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function text_of(value: number | null): string {
  return value === null || !Number.isFinite(value) ? '' : String(+value.toPrecision(10));
}

/** Returns the rows from one place to another, with the series that are not hidden. */
export function cut({ name, heads, columns }: Table, [from, to]: [number, number], is_shown: (series: number) => boolean): Table {
  const [first, ...series] = columns;
  const kept = first.map((place) => place >= from && place <= to);
  const rows = <T>(values: T[]): T[] => values.filter((_, i) => kept[i]);
  return {
    name,
    heads: heads.filter((_, i) => i === 0 || is_shown(i - 1)),
    columns: [rows(first), ...series.filter((_, i) => is_shown(i)).map(rows)],
  };
}

/** Gives the browser a table to save. */
export function save(name: string, text: string): void {
  save_file(`${name.toLowerCase().replace(/[^a-z0-9]+/g, '_').replace(/^_|_$/g, '') || 'plot'}.csv`, text, 'text/csv');
}

/** Gives the browser a file to save. */
export function save_file(name: string, text: string, type: string): void {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // Safari reads it later.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
