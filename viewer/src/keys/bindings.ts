// Keys as in MuJoCo's simulate (Space, arrows, +/-, F1, Esc, Backspace, brackets) and Blender (numpad).
import { total_length } from '../scene/rings';
import { preferences, toggle_hidden, toggle_theme } from '../state/preferences';
import type { App } from '../ui/app';
import type { Binding } from './keys';

export function bindings_of(app: App): Binding[] {
  return [...time(app), ...view(app), ...rig(app), ...page(app)];
}

/**
 * Returns whether a key is active on the shown page: rig keys only work on the viewer's page, where the rig is visible.
 */
export function is_in_sight({ group }: Binding, route: App['route']['value'], has_rig = true): boolean {
  return (route === 'viewer' && has_rig) || group === 'Page';
}

function time({ viewer: { playback } }: App): Binding[] {
  const group = 'Time';
  return [
    { group, keys: ['Space'], what: 'Play or pause; live: hold the view, or back to now', run: () => playback.toggle() },
    { group, keys: ['ArrowRight'], what: 'One step forward', run: () => playback.step(1) },
    { group, keys: ['ArrowLeft'], what: 'One step back', run: () => playback.step(-1) },
    { group, keys: ['Shift+ArrowRight'], what: 'Half a second forward', run: () => playback.skip(0.5) },
    { group, keys: ['Shift+ArrowLeft'], what: 'Half a second back', run: () => playback.skip(-0.5) },
    { group, keys: ['+', 'NumpadAdd', '='], what: 'Play faster', run: () => playback.faster(1) },
    { group, keys: ['-', 'NumpadSubtract'], what: 'Play slower', run: () => playback.faster(-1) },
    { group, keys: ['Home'], what: 'To the start', run: () => playback.seek(0) },
    { group, keys: ['End'], what: 'To the end; live: to now', run: () => (playback.mode.value === 'live' ? playback.go_live() : playback.seek(Infinity)) },
  ];
}

const turn = 0.08;

function view(app: App): Binding[] {
  const group = 'View';
  const look = (azimuth: number, elevation: number) => () => {
    app.views.free();
    app.view.value?.orbit.look(azimuth, elevation);
    app.view.value?.invalidate();
  };
  const orbit = (left: number, up: number) => () => {
    app.views.free();
    app.view.value?.orbit.turn(left, up);
    app.view.value?.invalidate();
  };
  const pan = (left: number, up: number) => () => {
    app.views.free();
    const shown = app.view.value;
    shown?.orbit.pan(shown.camera, left, up);
    shown?.invalidate();
  };
  const zoom = (factor: number) => () => {
    app.views.free();
    app.view.value?.orbit.zoom(factor);
    app.view.value?.invalidate();
  };
  return [
    { group, keys: ['Numpad1', '1'], what: 'From the front, as camera 1', run: look(0, 0) },
    { group, keys: ['Numpad3', '3'], what: 'From the side, as camera 2', run: look(-Math.PI / 2, 0) },
    { group, keys: ['Numpad7', '7'], what: 'From above', run: look(0, Math.PI / 2) },
    { group, keys: ['Numpad0', '0', 'a'], what: 'Show the whole arm', run: () => (app.views.free(), app.view.value?.frame_arm()) },
    { group, keys: ['Numpad5', '5', 'Shift+Home'], what: 'The arm and all cameras in view', run: () => (app.views.free(), app.view.value?.frame_cameras()) },
    { group, keys: ['NumpadDecimal', '.'], what: 'Look at the picked point, or at the tip', run: () => look_at_point(app) },
    { group, keys: ['k'], what: 'Pick the tip of the backbone, or clear the picked point; a slider moves the point along the arm', run: () => pick_tip(app) },
    { group, keys: [']', 'BracketRight'], what: 'The next view: free, then each camera', run: () => app.views.cycle(1) },
    { group, keys: ['[', 'BracketLeft'], what: 'Previous view', run: () => app.views.cycle(-1) },
    { group, keys: ['Alt+ArrowLeft', 'Numpad4'], what: 'Orbit left', run: orbit(turn, 0) },
    { group, keys: ['Alt+ArrowRight', 'Numpad6'], what: 'Orbit right', run: orbit(-turn, 0) },
    { group, keys: ['Alt+ArrowUp', 'Numpad8'], what: 'Rise', run: orbit(0, turn) },
    { group, keys: ['Alt+ArrowDown', 'Numpad2'], what: 'Sink', run: orbit(0, -turn) },
    { group, keys: ['Alt+Shift+ArrowLeft'], what: 'Move the view to the left', run: pan(0.04, 0) },
    { group, keys: ['Alt+Shift+ArrowRight'], what: 'Move the view to the right', run: pan(-0.04, 0) },
    { group, keys: ['Alt+Shift+ArrowUp'], what: 'Move it up', run: pan(0, 0.04) },
    { group, keys: ['Alt+Shift+ArrowDown'], what: 'Move it down', run: pan(0, -0.04) },
    { group, keys: ['PageUp'], what: 'Nearer', run: zoom(0.9) },
    { group, keys: ['PageDown'], what: 'Farther', run: zoom(1 / 0.9) },
    { group, keys: ['t'], what: 'Trail of the tip, on or off', run: () => toggle_hidden('trail') },
    { group, keys: ['p'], what: 'Plots, shown or not', run: () => (preferences.show_plots.value = !preferences.show_plots.value) },
  ];
}

function toggle_push({ viewer, push_tool }: App): void {
  if (viewer.hello.value?.controls.push && !viewer.readonly) push_tool.value = !push_tool.value;
}

function look_at_point(app: App): void {
  const shown = app.view.value;
  const samples = shown?.state?.samples;
  if (!shown || !samples) return;
  app.views.free();
  shown.look_at_arm(app.viewer.picked.value);
}

function pick_tip({ viewer: { picked, scene } }: App): void {
  picked.value = picked.value === null && scene.value ? total_length(scene.value.arm) : null;
}

function rig(app: App): Binding[] {
  const { viewer } = app;
  const group = 'Rig';
  const ask = (what: string) => () => void viewer.commander.plain(what);
  return [
    { group, keys: ['Backspace'], what: 'Reset to the initial state', run: () => (viewer.readonly ? viewer.playback.seek(0) : viewer.blind || ask('reset')()) },
    { group, keys: ['h', 'F8'], what: 'Halt: stop all motion; also while you type in a field', anywhere: true, run: ask('halt') },
    { group, keys: ['g'], what: 'Push an elastic arm by dragging it, on or off', run: () => toggle_push(app) },
    { group, keys: ['r'], what: 'Run the tasks', run: () => viewer.blind || ask('run')() },
    { group, keys: ['c'], what: 'Cancel the run', run: () => viewer.readonly || ask('cancel')() },
  ];
}

function page(app: App): Binding[] {
  const group = 'Page';
  return [
    { group, keys: ['F1', '?'], what: 'This help', run: () => (app.dialog.value = app.dialog.value === 'help' ? null : 'help') },
    { group, keys: ['Escape'], what: 'Close; leave push mode; free view; clear selection', run: () => escape(app) },
    { group, keys: ['l'], what: 'Light or dark', run: toggle_theme },
  ];
}

function escape(app: App): void {
  if (app.dialog.value) app.dialog.value = null;
  else if (app.viewer.finding.value !== null && app.enlarged.value === app.viewer.finding.value) app.viewer.finding.value = null;
  else if (app.enlarged.value !== null) app.enlarged.value = null;
  else if (app.route.value !== 'viewer') return;
  else if (app.push_tool.value) app.push_tool.value = false;
  else if (app.views.current.value !== null) app.views.free();
  else app.viewer.picked.value = null;
}
