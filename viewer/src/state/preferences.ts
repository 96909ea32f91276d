// User preferences stored in this browser. Nothing of an experiment is stored.
import { effect, signal, type Signal } from '@preact/signals';

const prefix = 'flexura.';

function kept<T>(name: string, standard: T): Signal<T> {
  let start = standard;
  try {
    const text = localStorage.getItem(prefix + name);
    if (text !== null) start = JSON.parse(text) as T;
  } catch {
    // Storage may be disabled or contain an invalid value; the default is used.
  }
  const value = signal(start);
  effect(() => {
    const text = JSON.stringify(value.value);
    try {
      localStorage.setItem(prefix + name, text);
    } catch {
      // The value cannot be stored.
    }
  });
  return value;
}

export type Theme = 'system' | 'dark' | 'light';
export type ArmMode = 'bends' | 'archings' | 'cord_angles' | 'tendons';

/** Areas around the 3D view whose size can be changed. */
export type Area = 'left' | 'right' | 'plots';

/** Of a plot's y axis. A limit of null is chosen from the values. */
export interface PlotAxis {
  low: number | null;
  high: number | null;
  log: boolean;
}

export const preferences = {
  theme: kept<Theme>('theme', 'system'),
  keys: kept('keys', true),
  hidden: kept<string[]>('hidden', []),
  /** Null until the user chooses: the first mode that the arm has. */
  arm_mode: kept<ArmMode | null>('arm_mode', null),
  /** The other tendons follow the one that is moved. */
  tendons_together: kept('tendons_together', true),
  plots: kept<[string, string]>('plots', ['tip', 'bends']),
  recording_plots: kept<[string, string]>('recording_plots', ['', '']),
  show_plots: kept('show_plots', true),
  /** Limits of the plots' y axes and their kind, by what is plotted. */
  plot_axes: kept<Record<string, PlotAxis>>('plot_axes', {}),
  /** Sizes of the areas around the 3D view that were dragged, px; the others have their standard ones. */
  sizes: kept<Partial<Record<Area, number>>>('sizes', {}),
  /** First hints that were dismissed. */
  known_hints: kept<string[]>('known_hints', []),
  /** How fast tasks play, of real time; 0: as fast as possible. */
  run_speed: kept('run_speed', 1),
  /** Camera sliders mark where the axes truly stand. */
  true_axes: kept('true_axes', false),
  /** What is measured in the pictures and drawn upon them. */
  overlays: kept<string[]>('overlays', []),
};

export type Preferences = typeof preferences;

const asks_for_light = typeof matchMedia === 'function' ? matchMedia('(prefers-color-scheme: light)') : null;
const system_light = signal(asks_for_light?.matches ?? false);
asks_for_light?.addEventListener('change', ({ matches }) => (system_light.value = matches));

/** Returns the current theme. */
export function theme_now(): 'dark' | 'light' {
  const theme = preferences.theme.value;
  if (theme !== 'system') return theme;
  return system_light.value ? 'light' : 'dark';
}

export function toggle_theme(): void {
  preferences.theme.value = theme_now() === 'dark' ? 'light' : 'dark';
}

function toggle(list: Signal<string[]>, id: string): void {
  list.value = list.value.includes(id) ? list.value.filter((other) => other !== id) : [...list.value, id];
}

export function toggle_hidden(id: string): void {
  toggle(preferences.hidden, id);
}

export function toggle_overlay(id: string): void {
  toggle(preferences.overlays, id);
}
