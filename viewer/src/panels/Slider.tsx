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
  const track = useRef<HTMLDivElement>(null);
  const drag = useRef<{ x: number; value: number } | null>(null);
  const input = (target: number): void => change(Math.min(reach[1], Math.max(reach[0], target)));
  // A hand sees where a slider ends; who types does not.
  const type = (target: number): void => {
    const beyond = limit_of(target, reach, 0.5 * 10 ** -places / scale);
    if (beyond) notices.info(`${title}: ${said(target)} is ${beyond.side} the limit. It is set to ${said(beyond.limit)}.`);
    input(target);
  };
  const said = (x: number): string => `${fixed(x * scale, places)} ${unit}`;
  /** The slider's part of the track's pixels, in its values. */
  const per_pixel = (): number => (high - low) / Math.max(1, track.current!.clientWidth);
  return (
    <div class="slider">
      <div class="slider-head">
        <label for={id}>{label}</label>
        <NumberField label={`${title}, ${unit}`} value={value * scale} places={places} disabled={disabled}
          change={(typed) => type(typed / scale)} />
        <span class="unit">{unit}</span>
      </div>
      <div class="track" ref={track}>
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
          title={`${title}: ${said(reach[0])} to ${said(reach[1])}. Arrow keys, or drag; with Shift in fine steps`}
          aria-valuetext={`${(value * scale).toFixed(places)} ${unit}`}
          onInput={(event) => input(event.currentTarget.valueAsNumber)}
          onKeyDown={(event) => {
            const direction = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
            if (!direction || event.altKey) return;
            event.preventDefault();
            input(value + direction * key_step(high - low, scale, unit) * (event.shiftKey ? fine : 1));
          }}
          onPointerDown={(event) => {
            // The browser's own drag has no fine steps. Fingers keep it: they also scroll.
            if (event.pointerType === 'touch' || event.button !== 0 || disabled) return;
            event.preventDefault();
            event.currentTarget.focus();
            event.currentTarget.setPointerCapture(event.pointerId);
            const at = low + (event.clientX - track.current!.getBoundingClientRect().left) * per_pixel();
            // Who takes the knob, or wants fine steps, does not want it to jump.
            const stays = event.shiftKey || Math.abs(at - value) < knob * per_pixel();
            drag.current = { x: event.clientX, value: stays ? value : at };
            if (!stays) input(at);
          }}
          onPointerMove={(event) => {
            if (!drag.current || event.clientX === drag.current.x) return;
            const moved = (event.clientX - drag.current.x) * per_pixel() * (event.shiftKey ? fine : 1);
            drag.current = { x: event.clientX, value: drag.current.value + moved };
            input(drag.current.value);
          }}
          onLostPointerCapture={() => (drag.current = null)}
        />
      </div>
      <div class="ends" aria-hidden="true"><span>{fixed(reach[0] * scale, places)}</span><span>{fixed(reach[1] * scale, places)}</span></div>
    </div>
  );
}

/** With Shift a slider goes that much slower. */
const fine = 0.1;
/** Half the width of a slider's knob, px. */
const knob = 7;

/** Returns how far an arrow key moves a slider: one degree, or else 1 % of it. */
export function key_step(length: number, scale: number, unit: string): number {
  return unit === '°' ? 1 / scale : length / 100;
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
