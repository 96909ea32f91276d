/** Formats a time as shown on the page. */
export function format_time(seconds: number): string {
  if (!Number.isFinite(seconds)) return '–';
  const sign = seconds < 0 ? '−' : '';
  const all = Math.abs(seconds);
  const minutes = Math.floor(all / 60);
  const rest = (all - 60 * minutes).toFixed(2).padStart(minutes ? 5 : 4, '0');
  return minutes ? `${sign}${minutes}:${rest}` : `${sign}${rest} s`;
}

/** Returns a duration in its two largest units. */
export function duration_text(seconds: number): string {
  const units: [string, number][] = [['d', 86400], ['h', 3600], ['min', 60], ['s', 1]];
  const whole = Math.ceil(seconds);
  const first = units.findIndex(([, size]) => whole >= size);
  if (first < 0) return '0 s';
  const [name, size] = units[first];
  const text = `${Math.floor(whole / size)} ${name}`;
  const next = units[first + 1];
  const rest = next ? Math.floor((whole % size) / next[1]) : 0;
  return rest ? `${text} ${rest} ${next![0]}` : text;
}

/** Formats a number with `places` decimals and a real minus sign. */
export function fixed(value: number, places: number): string {
  if (!Number.isFinite(value)) return '–';
  const text = value.toFixed(places);
  return (Number(text) === 0 ? (0).toFixed(places) : text).replace('-', '−');
}

/** Returns the useful number of decimals for lengths of an arm of this size, in metres. */
export function length_places(span: number): number {
  return Math.min(5, Math.max(2, 3 - Math.floor(Math.log10(span))));
}

/** Parses a typed number, with a decimal point or comma and either minus sign; null if invalid, such as 0x10. */
export function number_of(typed: string): number | null {
  const text = typed.trim().replace(',', '.').replace('−', '-');
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) && Number.isFinite(Number(text)) ? Number(text) : null;
}

export const degree = 180 / Math.PI;

export function angle(radians: number, places = 1): string {
  return `${fixed(radians * degree, places)}°`;
}

export function vector(values: ArrayLike<number>, places: number): string {
  return Array.from(values, (value) => fixed(value, places)).join(', ');
}

/** Capitalises the first letter. */
export function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** How far a picture is from the instant that is shown, in words; nothing where that is less than `least`, s. */
export function lag_of(picture: number, shown: number | undefined, least: number): string {
  if (shown === undefined || !Number.isFinite(picture)) return '';
  const off = Math.abs(picture - shown);
  if (off < least + 1e-3) return '';
  return `${off.toFixed(2)} s ${picture < shown ? 'earlier' : 'later'}`;
}
