// The backbone between two samples is one arc, determined by the poses of both ends.
import { sample_stride } from '../protocol/state';

/** x, y, z, qw, qx, qy, qz. */
export type PoseBuffer = Float64Array;

export function new_pose(): PoseBuffer {
  return new Float64Array(7);
}

/**
 * The arc between two consecutive samples, with poses by fraction. Objects are reused, so that frames allocate nothing.
 */
export class Arc {
  /** Turning angle, rad. */
  angle = 0;
  /** Length including the present stretch, m. */
  length = 0;
  /** Direction of the bend in the frame of the start: angle of the bending plane from x towards y, rad. */
  plane = 0;
  private start = new Float64Array(7);
  private chord = new Float64Array(3);
  private axis = new Float64Array(3); // Rotation axis in the start's frame.
  private world = new Float64Array(3); // Rotation axis in the world.

  /** Sets the arc from sample i to sample i + 1 of a state's rows. */
  set(samples: ArrayLike<number>, i: number): this {
    const a = i * sample_stride + 1;
    const b = a + sample_stride;
    for (let j = 0; j < 7; ++j) this.start[j] = samples[a + j];
    for (let j = 0; j < 3; ++j) this.chord[j] = samples[b + j] - samples[a + j];
    this.turn(samples, a + 3, b + 3);
    rotate(this.start, this.axis[0], this.axis[1], this.axis[2], this.world);
    const chord = Math.hypot(this.chord[0], this.chord[1], this.chord[2]);
    this.length = chord / sinc(this.angle / 2);
    this.plane = Math.atan2(-this.axis[0], this.axis[1]);
    return this;
  }

  /** Computes the pose at the fraction f of the arc's length. */
  pose(f: number, out: PoseBuffer): PoseBuffer {
    const half = this.angle / 2;
    // The chord to f is the whole chord, turned back by half of the remaining angle.
    const scale = (f * sinc(f * half)) / sinc(half);
    const back = -(1 - f) * half;
    const c = Math.cos(back) * scale;
    const s = Math.sin(back) * scale;
    const [dx, dy, dz] = this.chord;
    const [ax, ay, az] = this.world;
    out[0] = this.start[0] + c * dx + s * (ay * dz - az * dy);
    out[1] = this.start[1] + c * dy + s * (az * dx - ax * dz);
    out[2] = this.start[2] + c * dz + s * (ax * dy - ay * dx);
    const w = Math.cos(f * half);
    const v = Math.sin(f * half);
    multiply(this.start, w, v * this.axis[0], v * this.axis[1], v * this.axis[2], out);
    return out;
  }

  private turn(samples: ArrayLike<number>, a: number, b: number): void {
    const aw = samples[a], ax = -samples[a + 1], ay = -samples[a + 2], az = -samples[a + 3];
    const bw = samples[b], bx = samples[b + 1], by = samples[b + 2], bz = samples[b + 3];
    let w = aw * bw - ax * bx - ay * by - az * bz;
    let x = aw * bx + ax * bw + ay * bz - az * by;
    let y = aw * by - ax * bz + ay * bw + az * bx;
    let z = aw * bz + ax * by - ay * bx + az * bw;
    if (w < 0) {
      w = -w; x = -x; y = -y; z = -z;
    }
    const sine = Math.hypot(x, y, z);
    this.angle = 2 * Math.atan2(sine, w);
    const scale = sine > 1e-12 ? 1 / sine : 0;
    this.axis[0] = x * scale;
    this.axis[1] = y * scale;
    this.axis[2] = z * scale;
  }
}

/** Returns sin(x)/x, smooth at 0. */
export function sinc(x: number): number {
  return Math.abs(x) < 1e-4 ? 1 - (x * x) / 6 : Math.sin(x) / x;
}

/** Rotates a vector by a pose's rotation. */
export function rotate(pose: ArrayLike<number>, x: number, y: number, z: number, out: Float64Array): Float64Array {
  const w = pose[3], a = pose[4], b = pose[5], c = pose[6];
  const tx = 2 * (b * z - c * y);
  const ty = 2 * (c * x - a * z);
  const tz = 2 * (a * y - b * x);
  out[0] = x + w * tx + (b * tz - c * ty);
  out[1] = y + w * ty + (c * tx - a * tz);
  out[2] = z + w * tz + (a * ty - b * tx);
  return out;
}

function multiply(pose: ArrayLike<number>, w: number, x: number, y: number, z: number, out: Float64Array): void {
  const pw = pose[3], px = pose[4], py = pose[5], pz = pose[6];
  out[3] = pw * w - px * x - py * y - pz * z;
  out[4] = pw * x + px * w + py * z - pz * y;
  out[5] = pw * y - px * z + py * w + pz * x;
  out[6] = pw * z + px * y - py * x + pz * w;
}

/** Returns the number of rows of an array of samples. */
export function sample_count(samples: ArrayLike<number>): number {
  return samples.length / sample_stride;
}

/** Returns the interval of the samples that contains s and the fraction in it; s is clamped to the ends. */
export function locate(samples: ArrayLike<number>, s: number): { interval: number; fraction: number } {
  const last = sample_count(samples) - 2;
  let low = 0;
  let high = last;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (samples[middle * sample_stride] <= s) low = middle;
    else high = middle - 1;
  }
  const from = samples[low * sample_stride];
  const to = samples[(low + 1) * sample_stride];
  const fraction = to > from ? (s - from) / (to - from) : 0;
  return { interval: low, fraction: Math.min(1, Math.max(0, fraction)) };
}

export interface BackbonePoint {
  s: number;
  position: [number, number, number];
  tangent: [number, number, number];
  curvature: number;
  plane: number;
}

/** Returns position and geometry of the backbone at s (along the unstretched arm). */
export function point_at(samples: ArrayLike<number>, s: number): BackbonePoint {
  const { interval, fraction } = locate(samples, s);
  const arc = new Arc().set(samples, interval);
  const pose = arc.pose(fraction, new_pose());
  const tangent = rotate(pose, 0, 0, 1, new Float64Array(3));
  return {
    s,
    position: [pose[0], pose[1], pose[2]],
    tangent: [tangent[0], tangent[1], tangent[2]],
    curvature: arc.length > 0 ? arc.angle / arc.length : 0,
    plane: arc.plane,
  };
}
