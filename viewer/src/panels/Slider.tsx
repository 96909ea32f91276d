// A slider with limits and the currently unreachable range, and a field for exact values.
import type { Range } from '../protocol/types';
import { useRef, useState } from 'preact/hooks';
import { use_app } from '../ui/app';
import { fixed, number_of } from '../ui/format';

export interface SliderProps {
  id: string;
  label: string;
  /** Accessible name for screen readers, if the label alone is ambiguous. */
  title?: string;
  value: number;
  /** Actual value, if it differs from the commanded one. */
  actual?: number;
  span: Range;
  /** Currently reachable range; the rest is shaded. */
  reach: Range;
  /** Factor from value to display, for example to degrees. */
  scale: number;
  unit: string;
  places: number;
  disabled?: boolean;
  change(value: number): void;
}

export function Slider(props: SliderProps) {
  const { id, label, title = label, value, span, reach, scale, unit, places, disabled, change } = props;
  const [low, high] = span;
  const part = (x: number): number => (100 * (Math.min(high, Math.max(low, x)) - low)) / (high - low);
  const [from, to] = [part(reach[0]), part(reach[1])];
  const limited = reach[0] > low || reach[1] < high;
  const { notices } = use_app().viewer;
  const input = (target: number): void => change(Math.min(reach[1], Math.max(reach[0], target)));
  // A hand sees where a slider ends; who types does not.
  const type = (target: number): void => {
    const beyond = limit_of(target, reach, 0.5 * 10 ** -places / scale);
    if (beyond) notices.info(`${title}: ${said(target)} is ${beyond.side} the limit. It is set to ${said(beyond.limit)}.`);
    input(target);
  };
  const said = (x: number): string => `${fixed(x * scale, places)} ${unit}`;
  return (
    <div class="slider">
      <label for={id}>{label}</label>
      <div class="track">
        <span class="unreachable" style={{ left: 0, width: `${from}%` }} />
        <span class="unreachable" style={{ left: `${to}%`, right: 0 }} />
        {limited && <span class="limit" style={{ left: `${from}%` }} />}
        {limited && <span class="limit" style={{ left: `${to}%` }} />}
        {low < 0 && high > 0 && <span class="zero" style={{ left: `${part(0)}%` }} />}
        {props.actual !== undefined && Math.abs(props.actual - value) > 0.005 * (high - low) && <span class="actual" style={{ left: `${part(props.actual)}%` }} />}
        <input
          id={id}
          type="range"
          min={low}
          max={high}
          step={(high - low) / 2000}
          value={value}
          disabled={disabled}
          aria-label={title}
          title={`${title}: ${said(reach[0])} to ${said(reach[1])}`}
          aria-valuetext={`${(value * scale).toFixed(places)} ${unit}`}
          onInput={(event) => input(event.currentTarget.valueAsNumber)}
          onKeyDown={(event) => {
            // A key press moves by 1 % of the slider, with Shift by 0.1 %.
            const direction = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
            if (!direction || event.altKey) return;
            event.preventDefault();
            input(value + (direction * (high - low)) / (event.shiftKey ? 1000 : 100));
          }}
        />
      </div>
      <NumberField label={`${title}, ${unit}`} value={value * scale} places={places} disabled={disabled}
        change={(typed) => type(typed / scale)} />
      <span class="unit">{unit}</span>
    </div>
  );
}

interface NumberFieldProps {
  label: string;
  value: number;
  places: number;
  disabled?: boolean;
  change(value: number): void;
}

/** The limit that a value is beyond by more than `rounding`; null within them. */
export function limit_of(target: number, [low, high]: Range, rounding: number): { side: 'above' | 'below'; limit: number } | null {
  if (target > high + rounding) return { side: 'above', limit: high };
  return target < low - rounding ? { side: 'below', limit: low } : null;
}

/** Shows a changing value and lets one type another: what is typed holds from Enter on, which leaves the field. */
export function NumberField({ label, value, places, disabled, change }: NumberFieldProps) {
  const [typed, set_typed] = useState<string | null>(null);
  const field = useRef<HTMLInputElement>(null);
  const { notices } = use_app().viewer;
  const take = (): void => {
    if (typed === null) return;
    const number = number_of(typed);
    if (number !== null) change(number);
    else notices.error(`${label}: “${typed}” is not a number. The value stays ${shown}.`);
    set_typed(null);
  };
  const shown = value.toFixed(places);
  return (
    <input
      ref={field}
      class="number"
      type="text"
      inputMode="decimal"
      aria-label={label}
      title={`${label}: type a number, then Enter`}
      disabled={disabled}
      value={typed ?? (Number(shown) === 0 ? (0).toFixed(places) : shown)}
      onInput={(event) => set_typed(event.currentTarget.value)}
      onFocus={(event) => event.currentTarget.select()}
      onBlur={take}
      onKeyDown={(event) => {
        // What leaves the field is taken; and the keys are the page's again.
        if (event.key === 'Enter') field.current?.blur();
        if (event.key !== 'Escape') return;
        set_typed(null);
        event.stopPropagation();
        field.current?.blur();
      }}
    />
  );
}
