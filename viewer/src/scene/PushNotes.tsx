// Pushing the arm: switch, instructions, and the force of the pointer.
import { useEffect, useRef } from 'preact/hooks';
import { flag_push, push_force, push_to } from '../protocol/state';
import { point_at } from '../math/arc';
import { size_at } from '../plots/sources';
import { force_text } from '../panels/actuators';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';

/** When switched on, the left button pushes the dragged point of the arm. */
export function PushTool() {
  const { viewer, push_tool } = use_app();
  if (!viewer.hello.value?.controls.push || viewer.readonly) return null;
  const on = push_tool.value;
  return (
    <button type="button" class="push-tool" aria-pressed={on} disabled={viewer.still} onClick={() => (push_tool.value = !on)}
      title="If on, dragging a point of the arm pushes the arm (G). If off, hold Shift while you drag.">
      <Icon name="hand" />Push
    </button>
  );
}

/** Instructions of the push mode, and the force beside the pointer's end of the spring. */
export function PushNote() {
  const { viewer, push_tool } = use_app();
  const pushed = (viewer.flags.value & flag_push) !== 0;
  if (!viewer.hello.value) return null;
  return (
    <>
      {push_tool.value && !pushed && !viewer.still && (
        <div class="push-note" role="status">Push: drag a point of the arm. Esc to stop.</div>
      )}
      {pushed && <PushLabel />}
    </>
  );
}

function PushLabel() {
  const app = use_app();
  const label = useRef<HTMLDivElement>(null);
  useEffect(() => {
    // Updated with every drawn state, because a label that lags behind the pointer is distracting.
    const place = (): void => {
      const state = app.viewer.shown;
      const view = app.view.value;
      const element = label.current;
      if (!element) return;
      const push = state?.push;
      const force = push ? size_at(push, push_force) : 0;
      let at = push && view ? view.pixel_of(push[push_to], push[push_to + 1], push[push_to + 2]) : null;
      if (push && view && state && !is_drawn(push, state.samples)) {
        const tip = arrow_tip(push, state.samples, view.span);
        at = view.pixel_of(tip[0], tip[1], tip[2]);
      }
      element.hidden = !at;
      if (!at) return;
      element.textContent = force_text(force);
      element.style.transform = `translate(${Math.round(at.x + 10)}px, ${Math.round(at.y - 30)}px)`;
    };
    place();
    app.viewer.state_listeners.add(place);
    return () => void app.viewer.state_listeners.delete(place);
  }, [app]);
  return <div class="push-label" id="push-label" ref={label} />;
}

/** Returns whether there is a spring, with its other end away from the pushed point. */
export function is_drawn(push: Float32Array, samples: Float32Array): boolean {
  const { position } = point_at(samples, push[0]);
  return Math.hypot(...position.map((x, i) => x - push[push_to + i])) > 1e-6;
}

/** Returns the end of the arrow for a force without a spring. */
export function arrow_tip(push: Float32Array, samples: Float32Array, span: number): number[] {
  const { position } = point_at(samples, push[0]);
  const size = size_at(push, push_force) || 1;
  return position.map((x, i) => x + (arrow_share * span * push[push_force + i]) / size);
}

/** Share of the arm's length. */
const arrow_share = 0.18;
