// Pointer input of the 3D view. Left orbits, right or middle pans, the wheel zooms. Left on the tip's handle drags the
// tip; with Shift or the push tool it pushes any point. A click picks a point of the backbone, a double click looks at
// the point under the pointer.
import { Plane, Raycaster, Vector2, Vector3 } from 'three';
import { sample_stride } from '../protocol/state';
import type { Vector3 as Triple } from '../protocol/types';
import { point_at } from '../math/arc';
import { nearest_point } from './pick';
import { radius_at, total_length } from './rings';
import type { SceneView } from './view';

export interface PointerHost {
  can_drag(): boolean;
  drag_tip(position: Triple): void;
  drop_tip(): void;
  pick(s: number | null): void;
  leave_camera(): void;
  /** The arm can be pushed now; `anyway`: also without Shift. */
  can_push(): boolean;
  pushes_anyway(): boolean;
  push(s: number, to: Triple): void;
  release(): void;
}

const click_px = 4;
const pick_px = 10;
const tip_px = 14;

type Action = 'orbit' | 'pan' | 'tip' | 'push' | null;

export class Pointer {
  private action: Action = null;
  private moved = 0;
  private last = new Vector2();
  /** s of the pushed point, m. */
  private pushed = 0;
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
    if (event.button === 0 && this.is_to_push(event) && this.grab_point(event)) this.action = 'push';
    else if (event.button !== 0 || event.shiftKey) this.action = 'pan';
    else if (this.host.can_drag() && this.over_tip(event)) this.grab(event);
    else this.action = 'orbit';
  };

  private move = (event: PointerEvent): void => {
    const { view } = this;
    if (!this.action) {
      view.canvas.style.cursor = this.cursor(event);
      return;
    }
    const dx = event.offsetX - this.last.x;
    const dy = event.offsetY - this.last.y;
    this.last.set(event.offsetX, event.offsetY);
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.action === 'tip' || this.action === 'push') return this.drag(event);
    if (this.moved < click_px) return;
    // Rotating a camera's view would show what the camera does not see, so the view leaves the camera.
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
    if (this.action === 'push') this.host.release();
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
    if (!this.view.state || !this.view.scene) return;
    this.host.pick(this.point_under(event));
  }

  /** Returns the arc length of the arm's point under the pointer. */
  private point_under(event: PointerEvent): number | null {
    const { view } = this;
    const { state, scene } = view;
    if (!state || !scene) return null;
    const hit = nearest_point(state.samples, view.camera, view.width, view.height, event.offsetX, event.offsetY);
    // A thick arm is hit anywhere on its skin.
    const thick = this.pixels_of(radius_at(scene.arm, hit.s));
    return hit.distance < Math.max(pick_px, thick) ? hit.s : null;
  }

  private is_to_push(event: PointerEvent): boolean {
    return this.host.can_push() && (event.shiftKey || this.host.pushes_anyway());
  }

  private cursor(event: PointerEvent): string {
    if (this.is_to_push(event)) return this.point_under(event) === null ? 'crosshair' : 'grab';
    return this.host.can_drag() && this.over_tip(event) ? 'grab' : '';
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

  /** Starts dragging the tip in the plane through it that faces the viewer; for a planar arm, in the arm's plane. */
  private grab(event: PointerEvent): void {
    const tip = this.tip(new Vector3());
    if (!tip) return;
    this.action = 'tip';
    this.hold(tip, event);
  }

  /** Starts dragging the arm's point under the pointer in the same way, with a spring. */
  private grab_point(event: PointerEvent): boolean {
    const s = this.point_under(event);
    const { state } = this.view;
    if (s === null || !state) return false;
    this.pushed = s;
    this.view.canvas.style.cursor = 'grabbing';
    this.hold(new Vector3(...point_at(state.samples, s).position), event);
    return true;
  }

  private hold(point: Vector3, event: PointerEvent): void {
    const normal = new Vector3(0, 0, 1);
    if (this.view.scene?.arm.kind !== 'planar') this.view.camera.getWorldDirection(normal);
    this.plane.setFromNormalAndCoplanarPoint(normal, point);
    this.grip.set(0, 0, 0);
    const under = this.under(event);
    if (under) this.grip.subVectors(point, under);
  }

  private drag(event: PointerEvent): void {
    const under = this.under(event);
    if (!under || this.moved < 1) return;
    under.add(this.grip);
    if (this.action === 'push') this.host.push(this.pushed, [under.x, under.y, under.z]);
    else this.host.drag_tip([under.x, under.y, under.z]);
  }

  private under(event: PointerEvent): Vector3 | null {
    const { view } = this;
    const pointer = new Vector2((2 * event.offsetX) / view.width - 1, 1 - (2 * event.offsetY) / view.height);
    this.ray.setFromCamera(pointer, view.camera);
    return this.ray.ray.intersectPlane(this.plane, new Vector3());
  }
}
