import { useRef, useState } from 'preact/hooks';
import type { PlotAxis } from '../state/preferences';
import { use_app } from '../ui/app';
import { number_of } from '../ui/format';
import { objection, set_axis } from './axis';

interface Props {
  place: number;
  id: string;
  axis: PlotAxis;
}

/** Limits of a plot's y axis, typed or chosen from the values, and its scale. */
export function AxisFields({ place, id, axis }: Props) {
  const { notices } = use_app().viewer;
  const take = (next: PlotAxis): void => {
    const why = objection(next);
    if (why) notices.error(why);
    else set_axis(id, next);
  };
  return (
    <div class="axis-fields" role="group" aria-label={`Y axis of plot ${place + 1}`}>
      <span>y</span>
      <LimitField label={`Lower limit of y, plot ${place + 1}`} value={axis.low} change={(low) => take({ ...axis, low })} />
      <span>to</span>
      <LimitField label={`Upper limit of y, plot ${place + 1}`} value={axis.high} change={(high) => take({ ...axis, high })} />
      <label title="Logarithmic scale; values of 0 and below are not shown">
        <input type="checkbox" checked={axis.log}
          onChange={(event) => {
            const box = event.currentTarget;
            const log = box.checked;
            // The box shows what holds.
            box.checked = axis.log;
            take({ ...axis, log });
          }} />
        log
      </label>
      <button type="button" class="button quiet" title="Chooses limits from the values, on a linear scale" onClick={() => set_axis(id, { low: null, high: null, log: false })}>Auto</button>
    </div>
  );
}

/** A number that may be left empty. It holds from Enter on, or when the field is left. */
function LimitField({ label, value, change }: { label: string; value: number | null; change(value: number | null): void }) {
  const { notices } = use_app().viewer;
  const [typed, set_typed] = useState<string | null>(null);
  const field = useRef<HTMLInputElement>(null);
  const take = (): void => {
    if (typed === null) return;
    const number = number_of(typed);
    if (number !== null || !typed.trim()) change(number);
    else notices.error(`${label}: “${typed}” is not a number.`);
    set_typed(null);
  };
  return (
    <input ref={field} class="number" type="text" inputMode="decimal" placeholder="auto" aria-label={label}
      title={`${label}: type a number, then Enter; empty: chosen from the values`} value={typed ?? (value === null ? '' : String(value))}
      onInput={(event) => set_typed(event.currentTarget.value)} onFocus={(event) => event.currentTarget.select()} onBlur={take}
      onKeyDown={(event) => {
        if (event.key === 'Enter') field.current?.blur();
        if (event.key !== 'Escape') return;
        set_typed(null);
        event.stopPropagation();
        field.current?.blur();
      }} />
  );
}
