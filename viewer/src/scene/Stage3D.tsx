// The 3D view in the page: connects the state (state/) with the renderer (SceneView).
import { useEffect, useRef } from 'preact/hooks';
import { effect } from '@preact/signals';
import { preferences, theme_now } from '../state/preferences';
import { obstruction } from '../state/commander';
import { use_app } from '../ui/app';
import { Pointer } from './pointer';
import { SceneView } from './view';

export function Stage3D() {
  const app = use_app();
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => connect(canvas.current!, app), [app]);
  return (
    <canvas
      ref={canvas}
      class="stage-canvas"
      id="stage"
      tabIndex={0}
      role="img"
      aria-label="3D view of the arm and its surroundings. Alt and the arrow keys turn the view, Page Up and Page Down zoom, 1, 3 and 7 look from the front, the side and above."
    />
  );
}

function connect(canvas: HTMLCanvasElement, app: ReturnType<typeof use_app>): () => void {
  const { viewer, views } = app;
  let view: SceneView;
  try {
    view = new SceneView(canvas);
  } catch {
    viewer.notices.error('This browser offers no WebGL: there is no 3D view.');
    return () => {};
  }
  app.view.value = view;
  new Pointer(view, {
    can_drag: () => !viewer.still && viewer.freshness.peek() === 'live',
    drag_tip: (position) => viewer.commander.tip(position),
    drop_tip: () => viewer.commander.release_tip(),
    pick: (s) => (viewer.picked.value = s),
    leave_camera: () => views.free(),
    can_push: () => viewer.hello.peek()?.controls.push !== undefined && !viewer.still && viewer.freshness.peek() === 'live',
    pushes_anyway: () => app.push_tool.peek(),
    push: (s, to) => viewer.commander.push({ s, to }),
    release: () => void viewer.commander.release(),
  });
  let epoch = -1;
  const ends = [
    effect(() => {
      const scene = viewer.scene.value;
      const theme = theme_now();
      if (!scene) return view.show_ground(theme);
      const afresh = epoch !== viewer.epoch.value;
      epoch = viewer.epoch.value;
      if (afresh) view.state = viewer.shown;
      view.build(scene, theme, afresh);
      view.hide(preferences.hidden.peek());
      view.look_through(views.current.peek());
      view.show_ghosts(viewer.ghosts.peek());
      view.handles?.set_picked(viewer.picked.peek());
      for (const [camera, picture] of viewer.picture_of) view.show_picture(camera, picture);
      app.parts.value = view.parts.map(({ id, label }) => ({ id, label }));
    }),
    effect(() => view.hide(preferences.hidden.value)),
    effect(() => view.look_through(views.current.value)),
    effect(() => view.show_ghosts(viewer.ghosts.value)),
    effect(() => {
      view.handles?.set_picked(viewer.picked.value);
      if (viewer.shown) view.draw_state(viewer.shown);
    }),
    effect(() => {
      const { tip_goal, tip_result } = viewer.commander;
      view.handles?.set_goal(tip_goal.value, !tip_result.value || obstruction(tip_result.value) === null);
      view.invalidate();
    }),
  ];
  const on_state = (state: NonNullable<typeof viewer.shown>): void => view.draw_state(state, false);
  // A held view keeps the pictures of its time.
  const on_picture: Parameters<typeof viewer.picture_listeners.add>[0] = (camera, picture) => {
    if (viewer.playback.held.peek() === null) view.show_picture(camera, picture);
  };
  viewer.state_listeners.add(on_state);
  viewer.picture_listeners.add(on_picture);
  const observer = new ResizeObserver(() => {
    const box = canvas.parentElement!.getBoundingClientRect();
    view.resize(Math.round(box.width), Math.round(box.height));
  });
  observer.observe(canvas.parentElement!);
  return () => {
    observer.disconnect();
    ends.forEach((end) => end());
    viewer.state_listeners.delete(on_state);
    viewer.picture_listeners.delete(on_picture);
    view.dispose();
    app.view.value = null;
  };
}
