// The hand in the 3D view: left orbits, right or middle pans, the wheel zooms; on the tip's handle the left button drags
// the tip; a click picks a point of the backbone, a double click looks at what is there.
import { Plane, Raycaster, Vector2, Vector3 } from 'three';
import { sample_stride } from '../protocol/state';
import type { Vector3 as Triple } from '../protocol/types';
import { nearest_point } from './pick';
import { radius_at, total_length } from './rings';
import type { SceneView } from './view';

export interface PointerHost {
  can_drag(): boolean;
  drag_tip(position: Triple): void;
  drop_tip(): void;
  pick(s: number | null): void;
  leave_camera(): void;
}

const click_px = 4;
const pick_px = 10;
const tip_px = 14;

type Action = 'orbit' | 'pan' | 'tip' | null;

export class Pointer {
  private action: Action = null;
  private moved = 0;
  private last = new Vector2();
  private readonly plane = new Plane();
  private readonly grip = new Vector3();
  private readonly ray = new Raycaster();

  constructor(
    private readonly view: SceneView,
    private readonly host: PointerHost,
  ) {
    const { canvas } = view;
    canvas.addEventListener('pointerdown', this.down);
    canvas.addEventListener('pointermove', this.move);
    canvas.addEventListener('pointerup', this.up);
    canvas.addEventListener('pointercancel', this.cancel);
    canvas.addEventListener('wheel', this.wheel, { passive: false });
    canvas.addEventListener('dblclick', this.look_at);
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  private down = (event: PointerEvent): void => {
    const { canvas } = this.view;
    canvas.setPointerCapture(event.pointerId);
    this.moved = 0;
    this.last.set(event.offsetX, event.offsetY);
    if (event.button !== 0 || event.shiftKey) this.action = 'pan';
    else if (this.host.can_drag() && this.over_tip(event)) this.grab(event);
    else this.action = 'orbit';
  };

  private move = (event: PointerEvent): void => {
    const { view } = this;
    if (!this.action) {
      view.canvas.style.cursor = this.host.can_drag() && this.over_tip(event) ? 'grab' : '';
      return;
    }
    const dx = event.offsetX - this.last.x;
    const dy = event.offsetY - this.last.y;
    this.last.set(event.offsetX, event.offsetY);
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.action === 'tip') return this.drag(event);
    if (this.moved < click_px) return;
    // Turning what a camera sees would show something that it does not: one leaves it.
    this.host.leave_camera();
    if (this.action === 'orbit') view.orbit.turn((dx / view.height) * 4, (dy / view.height) * 4);
    else view.orbit.pan(view.camera, dx / view.height, dy / view.height);
    view.invalidate();
  };

  private up = (event: PointerEvent): void => {
    if (this.action === 'orbit' && this.moved < click_px) this.click(event);
    this.cancel();
  };

  private cancel = (): void => {
    if (this.action === 'tip') this.host.drop_tip();
    this.action = null;
    this.view.canvas.style.cursor = '';
  };

  private wheel = (event: WheelEvent): void => {
    event.preventDefault();
    this.host.leave_camera();
    const lines = event.deltaMode === 1 ? event.deltaY * 33 : event.deltaY;
    this.view.orbit.zoom(Math.exp(Math.min(200, Math.max(-200, lines)) * 0.0012));
    this.view.invalidate();
  };

  private look_at = (event: MouseEvent): void => {
    const point = this.view.hit(event.offsetX, event.offsetY);
    if (!point) return;
    this.host.leave_camera();
    this.view.orbit.target.copy(point);
    this.view.invalidate();
  };

  private click(event: PointerEvent): void {
    const { view } = this;
    const { state, scene } = view;
    if (!state || !scene) return;
    const hit = nearest_point(state.samples, view.camera, view.width, view.height, event.offsetX, event.offsetY);
    // A thick arm is hit anywhere on its skin.
    const thick = this.pixels_of(radius_at(scene.arm, hit.s));
    this.host.pick(hit.distance < Math.max(pick_px, thick) ? hit.s : null);
  }

  private pixels_of(length: number): number {
    const { view } = this;
    return (length / (2 * view.orbit.distance * Math.tan((view.camera.fov * Math.PI) / 360))) * view.height;
  }

  private tip(out: Vector3): Vector3 | null {
    const samples = this.view.state?.samples;
    if (!samples?.length) return null;
    const at = samples.length - sample_stride + 1;
    return out.set(samples[at], samples[at + 1], samples[at + 2]);
  }

  private over_tip(event: PointerEvent): boolean {
    const { view } = this;
    const tip = this.tip(new Vector3());
    if (!tip || !view.handles?.group.visible) return false;
    const arm = view.scene!.arm;
    const reach = Math.max(tip_px, 1.3 * this.pixels_of(radius_at(arm, total_length(arm), true)));
    tip.project(view.camera);
    const x = ((tip.x + 1) / 2) * view.width;
    const y = ((1 - tip.y) / 2) * view.height;
    return Math.hypot(x - event.offsetX, y - event.offsetY) < reach;
  }

  /** The tip moves in the plane through it that faces the viewer; a planar arm's in the arm's own plane. */
  private grab(event: PointerEvent): void {
    const tip = this.tip(new Vector3());
    if (!tip) return;
    this.action = 'tip';
    const normal = new Vector3(0, 0, 1);
    if (this.view.scene?.arm.kind !== 'planar') this.view.camera.getWorldDirection(normal);
    this.plane.setFromNormalAndCoplanarPoint(normal, tip);
    this.grip.set(0, 0, 0);
    const under = this.under(event);
    if (under) this.grip.subVectors(tip, under);
  }

  private drag(event: PointerEvent): void {
    const under = this.under(event);
    if (!under || this.moved < 1) return;
    under.add(this.grip);
    this.host.drag_tip([under.x, under.y, under.z]);
  }

  private under(event: PointerEvent): Vector3 | null {
    const { view } = this;
    const pointer = new Vector2((2 * event.offsetX) / view.width - 1, 1 - (2 * event.offsetY) / view.height);
    this.ray.setFromCamera(pointer, view.camera);
    return this.ray.ray.intersectPlane(this.plane, new Vector3());
  }
}
