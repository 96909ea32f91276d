// Decoding of binary messages. Arrays are views into the message; nothing is copied.
import type { Extras } from './types';

export const kind_state = 1;
export const kind_image = 2;
export const kind_extras = 3;

export const flag_moving = 1;
export const flag_running = 2;
export const flag_recording = 4;
export const flag_unsafe = 8;
export const flag_weightless = 16;
export const flag_energy = 32;
export const flag_push = 64;
export const flag_pace = 128;

/** Numbers in a row of `samples`: s, x, y, z, qw, qx, qy, qz. */
export const sample_stride = 8;
/** Numbers in a row of `cameras`. */
export const camera_stride = 23;

/** Numbers in a row of `actuators`. */
export const actuator_stride = 3;
export const actuator_force = 1;
export const actuator_lost = 2;

/** Numbers of a push: s, the point to which the spring pulls, the force. */
export const push_size = 7;
export const push_to = 1;
export const push_force = 4;

/** Numbers in a row of `contacts`: obstacle, s, point, force, normal force, slip state. */
export const contact_stride = 10;
export const contact_point = 2;
export const contact_force = 5;
export const contact_normal = 8;
export const contact_slip = 9;

/** Column indices in a camera's row. */
export const camera_pan = 7;
export const camera_tilt = 8;
export const camera_zoom = 9;
export const camera_stage = 10;
export const camera_fx = 13;
export const camera_fy = 14;
export const camera_cx = 15;
export const camera_cy = 16;
/** Pan, tilt, zoom and stage x, y, z as they are commanded, or reported: what commands and the model count in. */
export const camera_commanded = 17;

export interface State {
  flags: number;
  /** Number of jumps to another position without motion. */
  leaps: number;
  sequence: number;
  time: number;
  /** Bends x, y of each section, rad. */
  bends: Float32Array;
  stretches: Float32Array;
  samples: Float32Array;
  cameras: Float32Array;
  displacements: Float32Array;
  /** Rows of individually driven tendons: displacement, m; tension, N; lost motor steps. */
  actuators: Float32Array;
  /** Kinetic, elastic and gravitational energy, J, of arms with inertia. */
  energy?: Float32Array | null;
  /** The push on the arm; null if there is none. */
  push?: Float32Array | null;
  /** Simulation speed relative to real time, if slower. */
  pace?: number | null;
  /** Rows of contact points. */
  contacts?: Float32Array;
  /** Extras that belong to this state. */
  extras?: Extras | null;
}

export interface ImageMessage {
  camera: number;
  /** 'application/octet-stream': an unknown format that cannot be decoded. */
  type: 'image/jpeg' | 'image/png' | 'application/octet-stream';
  number: number;
  time: number;
  file: Uint8Array;
}

const state_header = 28;
const image_header = 16;
const image_types = ['image/jpeg', 'image/png'] as const;

/** Returns the kind of a binary message, 0 if it is empty. */
export function kind_of(buffer: ArrayBuffer): number {
  return buffer.byteLength > 0 ? new DataView(buffer).getUint8(0) : 0;
}

/** Decodes a state; throws if its length does not match its counts. */
export function decode_state(buffer: ArrayBuffer): State {
  if (buffer.byteLength < state_header) throw new Error('a state shorter than its header');
  const view = new DataView(buffer);
  const sections = view.getUint16(2, true);
  const samples = view.getUint16(4, true);
  const cameras = view.getUint16(6, true);
  const tendons = view.getUint16(8, true);
  const actuators = view.getUint16(24, true);
  const flags = view.getUint8(1);
  const energy = flags & flag_energy ? 3 : 0;
  const push = flags & flag_push ? push_size : 0;
  const pace = flags & flag_pace ? 1 : 0;
  const contacts = contact_stride * view.getUint16(26, true);
  const numbers = 3 * sections + sample_stride * samples + camera_stride * cameras + tendons + actuator_stride * actuators
    + energy + push + pace + contacts;
  if (buffer.byteLength !== state_header + 4 * numbers) {
    throw new Error(`a state of ${buffer.byteLength} bytes, expected ${state_header + 4 * numbers}`);
  }
  let at = state_header;
  const take = (count: number): Float32Array => {
    const part = new Float32Array(buffer, at, count);
    at += 4 * count;
    return part;
  };
  return {
    flags,
    leaps: view.getUint16(10, true),
    sequence: view.getUint32(12, true),
    time: view.getFloat64(16, true),
    bends: take(2 * sections),
    stretches: take(sections),
    samples: take(sample_stride * samples),
    cameras: take(camera_stride * cameras),
    displacements: take(tendons),
    actuators: take(actuator_stride * actuators),
    energy: energy ? take(energy) : null,
    push: push ? take(push) : null,
    pace: pace ? take(pace)[0] : null,
    contacts: take(contacts),
  };
}

/** Decodes an image; its file is a view into the message. */
export function decode_image(buffer: ArrayBuffer): ImageMessage {
  if (buffer.byteLength < image_header) throw new Error('an image shorter than its header');
  const view = new DataView(buffer);
  return {
    camera: view.getUint8(1),
    type: image_types[view.getUint16(2, true)] ?? 'application/octet-stream',
    number: view.getUint32(4, true),
    time: view.getFloat64(8, true),
    file: new Uint8Array(buffer, image_header),
  };
}

/** Decodes extras; null if they are empty. */
export function decode_extras(buffer: ArrayBuffer): Extras | null {
  const extras = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 1))) as Partial<Extras>;
  const { time = 0, title = '', text = '', ghosts = [], overlays = [], along, values = {} } = extras;
  if (!ghosts.length && !overlays.length && !along) return null;
  return { time, title, text, ghosts, overlays, along, values };
}
