// The 3D view; it draws only after changes.
import {
  DirectionalLight, HemisphereLight, Matrix4, type Object3D, PerspectiveCamera, Raycaster, Scene as World, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { point_at } from '../math/arc';
import type { Picture } from '../connection/images';
import type { State } from '../protocol/state';
import type { GhostMessage, Scene } from '../protocol/types';
import { Backdrop } from './backdrop';
import { see_through } from './camera_view';
import { floor_of, up_of_base, type Floor } from './floor_level';
import { distance_for_all, first_distance, frame_of, frustum_points, screen_points, type Look } from './framing';
import { Orbit } from './orbit';
import type { Label, Part, Theme } from './part';
import { make_handles, type Handles } from './parts/handles';
import { part_makers } from './parts/registry';
import { total_length } from './rings';
import { draws_in_software, Sharpness } from './sharpness';

/** Minimum time between two updates of the pictures in the view, ms. */
const picture_ms = 200;
/**
 * Colours of the light from above and from the floor, and strength of the light at the eye. The same in both themes, so
 * that things keep their colours.
 */
const light = { sky: 0xffffff, ground: 0xa8b2bb, eye: 0.9 };

export class SceneView {
  readonly orbit = new Orbit();
  readonly camera = new PerspectiveCamera(38, 1, 0.01, 100);
  readonly renderer: WebGLRenderer;
  parts: Part[] = [];
  handles: Handles | null = null;
  scene: Scene | null = null;
  state: State | null = null;
  span = 1;
  floor: Floor = { height: 0, obstacle: null };
  /** Called after a frame from another viewpoint, or with other labels, than the one before. */
  readonly look_listeners = new Set<() => void>();
  /** Number of drawn frames, for measuring the frame rate. */
  drawn = 0;
  /** The rig's camera whose view is shown; null for the free view. */
  through: string | null = null;
  private readonly world = new World();
  private readonly ambient = new HemisphereLight(light.sky, light.ground, 1);
  private readonly backdrop = new Backdrop();
  private readonly looked = new Matrix4();
  private looked_anew = true;
  private readonly sun = new DirectionalLight(0xffffff, 1);
  private readonly head_light = new DirectionalLight(0xffffff, light.eye);
  private readonly size = new Vector2(1, 1);
  private readonly sharpness: Sharpness;
  private readonly pictures = new Map<string, Picture | null>();
  private picture_timer: ReturnType<typeof setTimeout> | undefined;
  private frame = 0;
  private dirty = false;
  private is_to_frame = false;
  /** The parts do not have the present state yet. */
  private is_behind = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    const software = draws_in_software();
    this.renderer = new WebGLRenderer({ canvas, antialias: !software, powerPreference: 'high-performance' });
    this.sharpness = new Sharpness(software, () => this.request());
    this.sharpness.apply(this.renderer, true);
    this.camera.add(this.head_light);
    this.world.add(this.backdrop.mesh, this.ambient, this.sun, this.camera);
  }

  /** Sets the background, also before there is a scene. */
  show_ground(theme: Theme): void {
    this.backdrop.set_theme(theme);
    this.invalidate();
  }

  /** Rebuilds the scene; the viewpoint stays unless `frame_all`. */
  build(scene: Scene, theme: Theme, frame_all: boolean): void {
    this.clear();
    this.scene = scene;
    this.span = this.orbit.span = Math.max(1e-6, total_length(scene.arm));
    this.floor = floor_of(scene);
    const context = { scene, span: this.span, floor: this.floor.height, theme };
    this.handles = make_handles(context);
    this.parts = [...part_makers.flatMap((make) => make(context)), this.handles];
    for (const { group } of this.parts) this.world.add(group);
    this.show_ground(theme);
    this.ambient.intensity = Math.PI * Math.max(0.25, scene.light.ambient * 0.8);
    this.sun.intensity = Math.PI * scene.light.directional;
    this.sun.position.set(...scene.light.towards);
    if (frame_all) this.frame_all();
    this.is_to_frame = frame_all && !this.state;
    if (this.state) this.draw_state(this.state);
    this.invalidate();
  }

  /** Draws a state with the next frame: there may be many states between two. An unchanged state is not drawn again unless `anyway`. */
  draw_state(state: State, anyway = true): void {
    const before = this.state;
    this.state = state;
    // Camera positions are known only with a state.
    if (this.is_to_frame) this.frame_all();
    this.is_to_frame = false;
    if (!anyway && before && same(before.samples, state.samples) && same(before.cameras, state.cameras)
      && same(before.push ?? nothing, state.push ?? nothing) && same(before.contacts ?? nothing, state.contacts ?? nothing)) return;
    this.is_behind = true;
    this.invalidate();
  }

  /** The cameras' pictures hang in the view a few times a second: beside it they are shown in full. */
  show_picture(name: string, picture: Picture | null): void {
    this.pictures.set(name, picture);
    this.picture_timer ??= setTimeout(() => {
      this.picture_timer = undefined;
      for (const [camera, newest] of this.pictures) {
        // One of another run was closed meanwhile.
        if (!newest || newest.bitmap.width > 0) for (const part of this.parts) part.picture?.(camera, newest);
      }
      this.pictures.clear();
      this.request();
    }, picture_ms);
  }

  show_ghosts(ghosts: Record<string, GhostMessage>): void {
    for (const part of this.parts) part.ghosts?.(ghosts);
    this.invalidate();
  }

  hide(ids: string[]): void {
    for (const { id, group } of this.parts) group.visible = !ids.includes(id);
    this.looked_anew = true;
    this.invalidate();
  }

  look_through(name: string | null): void {
    this.through = name;
    for (const part of this.parts) part.inside?.(name);
    this.invalidate();
  }

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    this.size.set(width, height);
    this.renderer.setSize(width, height, false);
    this.looked_anew = true;
    this.invalidate();
  }

  /** The words of all visible things. */
  get labels(): Label[] {
    return this.parts.flatMap(({ group, labels }) => (group.visible ? labels ?? [] : []));
  }

  /** The opening view: holds the arm's workspace, the cameras and the screens behind the arm. */
  frame_all(): void {
    if (!this.scene) return;
    const look = this.look_at_reach(this.scene);
    const points = [...this.frusta(this.scene), ...screen_points(this.scene, look.target, this.floor.height, this.span)];
    const { right, up, distance } = frame_of(points, look, this.span);
    this.orbit.distance = distance;
    this.orbit.place(this.camera);
    this.camera.updateMatrixWorld();
    this.orbit.target.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 0), right)
      .addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 1), up);
    this.invalidate();
  }

  /** Frames the arm's workspace and the cameras that are near. */
  frame_arm(): void {
    if (!this.scene) return;
    const look = this.look_at_reach(this.scene);
    this.orbit.distance = first_distance(this.frusta(this.scene), look, this.span);
    this.invalidate();
  }

  /** Frames all cameras as well. */
  frame_cameras(): void {
    if (!this.scene) return;
    const look = this.look_at_reach(this.scene);
    this.orbit.distance = distance_for_all(this.frusta(this.scene), look, this.span);
    this.invalidate();
  }

  /** Looks at the arm's point at s, or at its tip. */
  look_at_arm(s: number | null): void {
    if (!this.scene || !this.state) return;
    const { position } = point_at(this.state.samples, s ?? total_length(this.scene.arm));
    this.orbit.target.set(...position);
    this.invalidate();
  }

  /** Returns the position of the arm's point at s, or of its tip, in pixels of the window. */
  on_screen(s = Infinity): { x: number; y: number } | null {
    if (!this.state) return null;
    const point = new Vector3(...point_at(this.state.samples, s).position).project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((point.x + 1) / 2) * box.width, y: box.top + ((1 - point.y) / 2) * box.height };
  }

  /** Returns the position of a point in pixels of the canvas; null if it is behind the eye. */
  pixel_of(x: number, y: number, z: number): { x: number; y: number } | null {
    const point = new Vector3(x, y, z).project(this.camera);
    if (Math.abs(point.z) > 1) return null;
    return { x: ((point.x + 1) / 2) * this.size.x, y: ((1 - point.y) / 2) * this.size.y };
  }

  /** Something has changed; a new frame is needed. */
  invalidate(): void {
    this.sharpness.moved();
    this.request();
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.picture_timer);
    this.sharpness.stop();
    this.clear();
    this.backdrop.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private request(): void {
    this.dirty = true;
    if (!this.frame) this.frame = requestAnimationFrame(this.render);
  }

  /** Returns the scene point under the pixel (x, y); null if there is none. */
  hit(x: number, y: number): Vector3 | null {
    this.catch_up();
    const pointer = new Vector2((2 * x) / this.size.x - 1, 1 - (2 * y) / this.size.y);
    const ray = new Raycaster();
    ray.setFromCamera(pointer, this.camera);
    ray.params.Line.threshold = 0;
    const groups = this.parts.filter(({ group, id }) => group.visible && id !== 'shadow').map(({ group }) => group);
    return ray.intersectObjects(groups, true).find(({ object }) => is_shown(object) && object.type !== 'LineSegments')?.point ?? null;
  }

  get width(): number {
    return this.size.x;
  }

  get height(): number {
    return this.size.y;
  }

  /** Turns to the middle of the arm's workspace. */
  private look_at_reach(scene: Scene): Look {
    const { base, kind } = scene.arm;
    const up = kind === 'planar' ? 0.45 : 0.42;
    this.orbit.target.set(base[0], base[1] + up_of_base(scene) * up * this.span, base[2]);
    const { target, azimuth, elevation } = this.orbit;
    return { target, azimuth, elevation, fov: this.camera.fov, aspect: this.size.x / this.size.y };
  }

  private frusta(scene: Scene): Vector3[] {
    return this.state ? frustum_points(scene, this.state.cameras) : [];
  }

  private clear(): void {
    for (const part of this.parts) {
      this.world.remove(part.group);
      part.dispose();
    }
    this.parts = [];
    this.looked_anew = true;
  }

  private tell_lookers(): void {
    seen_by.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    if (!this.looked_anew && seen_by.equals(this.looked)) return;
    this.looked_anew = false;
    this.looked.copy(seen_by);
    for (const listener of this.look_listeners) listener();
  }

  /** Gives the parts the present state. */
  private catch_up(): void {
    if (!this.is_behind || !this.state) return;
    this.is_behind = false;
    for (const part of this.parts) part.draw?.(this.state);
  }

  private render = (): void => {
    this.frame = 0;
    if (!this.dirty) return;
    this.dirty = false;
    this.catch_up();
    const through = this.through !== null && this.scene && this.state
      && see_through(this.camera, this.scene, this.state, this.through, this.size.x / this.size.y);
    if (!through) {
      this.camera.aspect = this.size.x / this.size.y;
      this.orbit.place(this.camera);
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrixWorld();
    this.sharpness.apply(this.renderer);
    const pixels = (this.camera.projectionMatrix.elements[5] * this.size.y * this.renderer.getPixelRatio()) / 2;
    for (const part of this.parts) part.seen_from?.(this.camera.position, pixels);
    this.renderer.render(this.world, this.camera);
    ++this.drawn;
    this.tell_lookers();
  };
}

const seen_by = new Matrix4();
const nothing = new Float32Array(0);

function is_shown(object: Object3D | null): boolean {
  for (let each = object; each; each = each.parent) if (!each.visible) return false;
  return true;
}

function same(a: Float32Array, b: Float32Array): boolean {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return false;
  return true;
}
