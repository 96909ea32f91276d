// Shared state of all components.
import { createContext } from 'preact';
import { useContext } from 'preact/hooks';
import { signal, type Signal } from '@preact/signals';
import type { KeyMap } from '../keys/keys';
import type { SceneView } from '../scene/view';
import type { Addition } from '../state/commander';
import type { Viewer } from '../state/viewer';
import { Views } from '../state/views';

export type Dialog = 'help' | 'examples' | 'experiment' | null;

export type NarrowTab = 'view' | 'controls' | 'cameras' | 'plots';

export interface App {
  viewer: Viewer;
  views: Views;
  view: Signal<SceneView | null>;
  /** Things in the 3D view that can be hidden. */
  parts: Signal<{ id: string; label: string }[]>;
  dialog: Signal<Dialog>;
  /** What the text of the experiment gets when its dialog opens. */
  editing: Signal<Addition>;
  route: Signal<'viewer' | 'teach'>;
  /** The left button pushes the dragged point of the arm. */
  push_tool: Signal<boolean>;
  /** The camera whose picture fills the page. */
  enlarged: Signal<string | null>;
  /** On narrow screens one panel is shown at a time. */
  narrow_tab: Signal<NarrowTab>;
  /** The time under the pointer in a plot or on the timeline, which all of them show. */
  cursor: Signal<number | null>;
  /** The part of the time that the plots show; null: all of it, or live its last seconds. */
  zoom: Signal<[number, number] | null>;
  keys: KeyMap;
  /** Takes a pasted address or token and connects with it. Returns false if it contains no token. */
  use_token(text: string): boolean;
}

export function make_app(viewer: Viewer, keys: KeyMap): App {
  return {
    viewer,
    views: new Views(() => viewer.scene.value?.cameras.map(({ name }) => name) ?? []),
    view: signal(null),
    parts: signal([]),
    dialog: signal(null),
    editing: signal({}),
    route: signal('viewer'),
    push_tool: signal(false),
    enlarged: signal(null),
    narrow_tab: signal('view'),
    cursor: signal(null),
    zoom: signal(null),
    keys,
    use_token: () => false,
  };
}

/** Opens the text of the experiment, with an addition. */
export function edit_experiment(app: App, addition: Addition = {}): void {
  app.editing.value = addition;
  app.dialog.value = 'experiment';
}

export const AppContext = createContext<App | null>(null);

export function use_app(): App {
  const app = useContext(AppContext);
  if (!app) throw new Error('outside of the app');
  return app;
}
