// Messages between page and program: docs/viewer-protocol.md. SI units and radians throughout.

export type Vector3 = [number, number, number];
/** x, y, z, qw, qx, qy, qz in the world. */
export type Pose = [number, number, number, number, number, number, number];
export type Range = [number, number];
export type Level = 'info' | 'warning' | 'error';

/** A pixel, [u, v]. */
export type Corner = [number, number];

/** What separates the arm from its surroundings in a picture. Two corners are a rectangle. */
export interface SeeingChoice {
  region?: Corner[];
  color?: Vector3;
  base?: Corner;
}

export interface SceneSection {
  length: number;
  radius: Range;
  max_bend: number | null;
  stretch: Range;
}

export interface SceneMarker {
  from: number;
  to: number;
  color: Vector3;
}

export interface SceneDisk {
  at: number;
  radius: number;
  thickness: number;
}

export interface SceneArm {
  kind: 'planar' | 'spatial';
  sections: SceneSection[];
  color: Vector3;
  tip: 'flat' | 'round';
  markers: SceneMarker[];
  disks: SceneDisk[];
  disk_color: Vector3;
  base: Pose;
  /** Path of each actuator: s, x and y of the cross-section, m. */
  tendons?: Vector3[][];
  /** The arm is elastic: forces bend it. */
  elastic?: boolean;
  visible: boolean;
}

export interface SceneScreen {
  pose: Pose;
  size: [number, number];
  brightness: number;
}

export interface SceneEtalon {
  pose: Pose;
  radius: number;
  height: number;
  line_width: number;
  color: Vector3;
  line_color: Vector3;
}

export type SceneObstacle = { name: string } & (
  | { kind: 'plane'; point: Vector3; normal: Vector3 }
  | { kind: 'sphere'; center: Vector3; radius: number }
  | { kind: 'capsule'; from: Vector3; to: Vector3; radius: number }
  | { kind: 'box'; center: Vector3; half_sizes: Vector3; rotation?: [number, number, number, number] }
);

export interface SceneCamera {
  name: string;
  width: number;
  height: number;
  channels: 1 | 3;
  /** What the experiment says about the arm in the pictures; the background is a file's name. */
  seeing?: { region?: Corner[]; color?: Vector3; background?: string };
}

export interface Scene {
  arm: SceneArm;
  screens: SceneScreen[];
  etalon: SceneEtalon | null;
  obstacles: SceneObstacle[];
  cameras: SceneCamera[];
  light: { towards: Vector3; ambient: number; directional: number };
  background: number;
}

export interface SectionControl {
  bend: number | null;
  stretch: Range;
  bend_rate: number | null;
}

export interface HeadControl {
  camera: string;
  pan: Range;
  tilt: Range;
  zoom: Range;
  /** Default: ratio. */
  zoom_unit?: 'ratio' | 'count';
}

export interface StageControl {
  camera: string;
  x: Range;
  y: Range;
  z: Range;
}

/** A tendon that ends at a section: displacements in m, positive pulled in, and its place around the backbone. */
export interface TendonControl {
  section: number;
  displacement: Range;
  radius: number;
  angle: number;
}

/** An individually driven tendon that ends at a section; values are pulled-in lengths, m. */
export interface ActuatorControl {
  name: string;
  section: number;
  range: Range;
  /** Displacement of every actuator per metre of this one that avoids tendons pulling against each other. */
  together: number[];
  /** The motor may lose steps. */
  motor: boolean;
}

export interface PushControl {
  length: number;
  stiffness: number;
  most: number;
}

export interface Controls {
  sections: SectionControl[];
  tendons: null | TendonControl[];
  actuators?: ActuatorControl[];
  /** Weight and loads act on the arm and can be switched off. */
  weight?: boolean;
  /** The arm can be pushed: largest s, m; stiffness of the spring, N/m; largest force, N. */
  push?: PushControl;
  /** The arm has inertia and energies. */
  inertia?: boolean;
  /** The arm can touch obstacles, which exert forces on it. */
  contact?: boolean;
  heads: HeadControl[];
  stages: StageControl[];
  tasks: { name: string; kind: string }[];
}

export interface Mark {
  time: number;
  end: number;
  level: Level;
  name: string;
  text: string;
}

export interface Quantity {
  name: string;
  unit: string;
  /** Group of quantities that are shown together. */
  group?: string;
}

/** A live rig, a recording of a run, or picture files without a rig. */
export type Mode = 'live' | 'recording' | 'pictures';

export interface Hello {
  type: 'hello';
  version: string;
  session: string;
  mode: Mode;
  title: string;
  scene: Scene;
  controls: Controls;
  duration: number;
  /** Time between two states of a recording, s; 0 live. */
  interval: number;
  marks: Mark[];
  quantities: Quantity[];
  /** Result of a recorded run in one line; may be "". */
  headline?: string;
  report: boolean;
  /** The progress of a campaign follows in messages `campaign`; the report is that of the campaign. */
  campaign?: boolean;
  /** There is a rig to switch to. */
  rig: boolean;
  /** There is a recording to open. */
  recording: boolean;
  /** Experiments for `open`; empty if the program was started with a file. */
  examples?: { name: string; title: string }[];
  readonly: boolean;
  /** Speed of a run that was started in a terminal, relative to real time; 0: as fast as possible. */
  speed?: number | null;
}

export interface EventMessage {
  type: 'event';
  time: number;
  level: Level;
  name: string;
  text: string;
  /** Show at once as a notice. */
  notice?: boolean;
}

export type Outcome = 'done' | 'unsafe' | 'cancelled' | 'failed';

export interface ProgressMessage {
  type: 'progress';
  what?: string;
  fraction?: number;
  /** Time left, s; null if it is not known yet. */
  left?: number | null;
  done?: boolean;
  outcome?: Outcome;
  /** When done: there is a recording of the run. */
  recording?: boolean;
  text?: string;
}

export type Condition = 'idle' | 'moving' | 'running' | 'done' | 'halted' | 'failed' | 'unsafe';

/** The rig's, or of a recorded run at the time that is shown. */
export interface ConditionMessage {
  type: 'condition';
  condition: Condition;
  /** Why; may be "". */
  text: string;
}

/** Numbers of runs by intervals of equal width of a measure. */
export interface CampaignHistogram {
  name: string;
  low: number;
  high: number;
  bins: number[];
}

/** How far a campaign is. */
export interface CampaignMessage {
  type: 'campaign';
  runs: number;
  total: number;
  /** Number of runs with each status. */
  statuses: Record<string, number>;
  /** Finished runs per second; 0 if none has finished for a while, null if not known yet or complete. */
  rate: number | null;
  /** Time left, s, if known. */
  left: number | null;
  /** Why the campaign is complete; "" if runs are missing. */
  reason: string;
  measures: CampaignHistogram[];
  /** Why the results cannot be read. */
  error?: string;
}

/** Drawn upon a camera's picture; one file a kind in src/overlays. */
export interface Layer {
  id: string;
  kind: string;
  color?: string;
  /** Label of its eye, also for layers without a ghost. */
  label?: string;
  [key: string]: unknown;
}

export interface OverlayMessage {
  type: 'overlay';
  camera: string;
  layers: Layer[];
}

export interface GhostMessage {
  type: 'ghost';
  id: string;
  color?: string;
  poses?: Pose[];
}

/** Extras beside the arm and on its pictures at one time: kind 3 of the binary messages. */
export interface Extras {
  time: number;
  title: string;
  text: string;
  ghosts: ExtraGhost[];
  overlays: ExtraOverlay[];
  along?: Along;
  /** By the names of a recording's quantities. */
  values: Record<string, number | null>;
}

export interface ExtraGhost {
  id: string;
  label: string;
  color: string;
  poses: Pose[];
}

/** Overlay of the picture with this number; without a number, of any picture of the camera. */
export interface ExtraOverlay {
  camera: string;
  number?: number;
  reason?: string;
  layers: Layer[];
}

/** Curves of values at equal shares of the arm's length. */
export interface Along {
  label: string;
  unit: string;
  length: number;
  curves: { id: string; label: string; color: string; values: (number | null)[] }[];
}

/** A reply without an id reports an error that belongs to no request. */
export type Reply = { type: 'reply'; id: number | null; result?: unknown; error?: string };

export type TextMessage =
  | Hello
  | { type: 'scene'; scene: Scene }
  | EventMessage
  | ProgressMessage
  | ConditionMessage
  | CampaignMessage
  | Reply
  | OverlayMessage
  | GhostMessage;

/** A problem of a text; line 0 means the whole. */
export interface TextProblem {
  line: number;
  column: number;
  text: string;
}

export interface ExperimentText {
  text: string;
  /** A name for a new file that does not exist yet, and its folder. */
  name: string;
  folder: string;
}

export interface TipResult {
  converged: boolean;
  reason: string;
  bends: [number, number][];
  position_error: number;
  /** The arm moves there. */
  moved?: boolean;
  /** Why the arm does not move there, if it would be unsafe. */
  danger?: string;
}

/** What the program found in a picture, or why it found nothing. */
export interface MeasureResult {
  found: boolean;
  reason: string;
  notes: string[];
  number: number;
  layers: Layer[];
}

export interface ShapeResult {
  found: boolean;
  reason: string;
  notes: string[];
  /** Numbers of the pictures, by camera. */
  numbers: number[];
  poses?: Pose[];
  bends?: [number, number][];
  sigma?: number;
  rms_px?: number;
}

/** Red, green and blue of the arm at a pixel, from 0 to 255. */
export interface ColorResult {
  color: Vector3;
  number: number;
}

export interface PixelResult {
  value: number[];
  bits: number;
  label: string;
  depth: number | null;
  s: number | null;
  number: number;
}
