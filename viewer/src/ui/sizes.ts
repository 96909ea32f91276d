// Sizes of the areas around the 3D view: as dragged, within limits, so that none vanishes.
import { effect, signal } from '@preact/signals';
import { preferences, type Area } from '../state/preferences';

export type Sizes = Record<Area, number>;

export interface Extent {
  width: number;
  height: number;
}

/** Up to this width, px, one panel is shown at a time (layout.css). */
const narrow = 900;
/** Smallest sizes, px. */
const least: Sizes = { left: 240, right: 200, plots: 110 };
const least_stage: Extent = { width: 300, height: 160 };
/** Height of the header and the timeline, px. */
const around = 46 + 48;

function clamp(value: number, low: number, high: number): number {
  return Math.max(low, Math.min(high, value));
}

/** Returns the sizes, px, that the areas have in a window until they are dragged. */
export function standard_of({ width, height }: Extent): Sizes {
  const compact = height <= 780 || width <= 1360;
  return { left: compact ? 296 : 300, right: compact ? 262 : 336, plots: Math.round(clamp(0.23 * height, 150, 240)) };
}

/** Returns the smallest and the largest size of an area, px, beside the others. */
export function limits_of(area: Area, { left, right }: Sizes, { width, height }: Extent): [number, number] {
  const room = {
    left: width - right - least_stage.width,
    right: width - left - least_stage.width,
    plots: height - around - least_stage.height,
  }[area];
  return [least[area], Math.max(least[area], room)];
}

/** Returns the sizes, px, in a window: as wanted where there is room. What was stored may be anything. */
export function fitted(wanted: Partial<Record<Area, unknown>>, extent: Extent): Sizes {
  const standard = standard_of(extent);
  const asked = (area: Area): number => {
    const size = wanted[area];
    return typeof size === 'number' && Number.isFinite(size) ? size : standard[area];
  };
  const sizes: Sizes = { left: asked('left'), right: least.right, plots: asked('plots') };
  sizes.left = clamp(sizes.left, ...limits_of('left', sizes, extent));
  sizes.right = clamp(asked('right'), ...limits_of('right', sizes, extent));
  sizes.plots = clamp(sizes.plots, ...limits_of('plots', sizes, extent));
  return sizes;
}

const has_window = typeof innerWidth === 'number';
/** The page's size, px. */
export const extent = signal<Extent>(has_window ? { width: innerWidth, height: innerHeight } : { width: 1440, height: 900 });

/** Returns the sizes of the areas now, px. */
export function sizes_now(): Sizes {
  return fitted(preferences.sizes.value, extent.value);
}

/** Sets the size of an area, px, within its limits; null: its standard one. */
export function set_size(area: Area, size: number | null): void {
  const { [area]: _, ...others } = preferences.sizes.peek();
  if (size === null) preferences.sizes.value = others;
  else preferences.sizes.value = { ...others, [area]: Math.round(clamp(size, ...limits_of(area, sizes_now(), extent.peek()))) };
}

/** Keeps the style sheets' variables at the sizes. */
export function apply_sizes(): void {
  addEventListener('resize', () => (extent.value = { width: innerWidth, height: innerHeight }));
  effect(() => {
    const { left, right, plots } = sizes_now();
    const is_narrow = extent.value.width <= narrow;
    const { style } = document.documentElement;
    style.setProperty('--left', is_narrow ? '0px' : `${left}px`);
    style.setProperty('--right', is_narrow ? '0px' : `${right}px`);
    style.setProperty('--plots', is_narrow || !preferences.show_plots.value ? '0px' : `${plots}px`);
  });
}
