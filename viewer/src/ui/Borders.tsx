import { useSignal } from '@preact/signals';
import { preferences, type Area } from '../state/preferences';
import { extent, limits_of, set_size, sizes_now } from './sizes';

const names: Record<Area, string> = { left: 'Width of the controls', right: 'Width of the pictures', plots: 'Height of the plots' };

/** The borders between the areas of the page: dragged, or moved by arrow keys. */
export function Borders() {
  return (
    <>
      <Border area="left" />
      <Border area="right" />
      {preferences.show_plots.value && <Border area="plots" />}
    </>
  );
}

/** Steps of the arrow keys, px; with Shift the small one. */
const steps = { large: 16, small: 2 };

function Border({ area }: { area: Area }) {
  const start = useSignal<{ at: number; size: number } | null>(null);
  const sizes = sizes_now();
  const [low, high] = limits_of(area, sizes, extent.value);
  const is_upright = area !== 'plots';
  // The right panel and the plots grow against the axes of the screen.
  const way = area === 'left' ? 1 : -1;
  const place = (event: PointerEvent): number => (is_upright ? event.clientX : event.clientY);
  const key = (event: KeyboardEvent): void => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const sign = { ArrowRight: is_upright ? 1 : 0, ArrowLeft: is_upright ? -1 : 0, ArrowDown: is_upright ? 0 : 1, ArrowUp: is_upright ? 0 : -1 }[event.key];
    if (sign) set_size(area, sizes[area] + way * sign * (event.shiftKey ? steps.small : steps.large));
    else if (event.key === 'Home') set_size(area, low);
    else if (event.key === 'End') set_size(area, high);
    else if (event.key === 'Enter') set_size(area, null);
    else return;
    event.preventDefault();
  };
  return (
    <div class="border" data-area={area} data-dragged={start.value !== null} role="separator" tabIndex={0}
      aria-orientation={is_upright ? 'vertical' : 'horizontal'} aria-label={names[area]}
      aria-valuenow={sizes[area]} aria-valuemin={low} aria-valuemax={high} aria-valuetext={`${sizes[area]} pixels`}
      title={`${names[area]}: drag, or arrow keys; a double click restores it`}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.currentTarget.setPointerCapture(event.pointerId);
        start.value = { at: place(event), size: sizes[area] };
      }}
      onPointerMove={(event) => {
        const from = start.value;
        if (from && place(event) !== from.at) set_size(area, from.size + way * (place(event) - from.at));
      }}
      onLostPointerCapture={() => (start.value = null)}
      onDblClick={() => set_size(area, null)} onKeyDown={key} />
  );
}
