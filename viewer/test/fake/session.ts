// The rig of the fake server: live, or the recording of its last run.
import { rotate } from '../../src/math/arc';
import type { Pose } from '../../src/protocol/types';
import { point_at } from '../../src/math/arc';
import { FakeArm, type Bends } from './arm';
import { encode_state } from './encode';
import { draw_arm, encode_png, type PointInPicture } from './picture';
import type { RigDescription } from './rigs';

const recording_s = 6;

export class FakeSession {
  arm: FakeArm;
  time = 0;
  sequence = 0;
  leaps = 0;
  heads: { pan: number; tilt: number; zoom: number }[];
  stage = [0, 0, 0];
  mode: 'live' | 'recording';
  running = 0;
  recorded_at = 0;
  moving = false;
  /** False after a watched run, as with the program. */
  has_rig = true;
  has_recording = false;
  /** Simulates a run started in a terminal. */
  is_watched = false;

  constructor(readonly rig: RigDescription, mode: 'live' | 'recording' = 'live') {
    this.arm = new FakeArm(rig);
    this.heads = rig.scene.cameras.map(() => ({ pan: 0, tilt: 0, zoom: 1 }));
    this.mode = mode;
  }

  reset(): void {
    ++this.leaps;
    this.arm = new FakeArm(this.rig);
    this.heads.forEach((head) => Object.assign(head, { pan: 0, tilt: 0, zoom: 1 }));
    this.stage = [0, 0, 0];
    this.running = 0;
  }

  halt(): void {
    this.arm.target = this.arm.bends;
    this.arm.target_stretches = this.arm.stretches;
    this.running = 0;
  }

  step(dt: number): void {
    this.time += dt;
    this.moving = this.arm.step(dt);
    if (this.running) this.arm.command(this.rig.goal.map(([x, y]) => [x * this.share(), y * this.share()]));
  }

  share(): number {
    return Math.min(1, (this.time - this.running) / 3);
  }

  get duration(): number {
    return this.mode === 'recording' ? recording_s : 0;
  }

  /** The recorded motion: to the target and half the way back. */
  bends_at(time: number): Bends {
    const f = time < 4 ? time / 4 : 1 - (time - 4) / 4;
    return this.rig.goal.map(([x, y]) => [f * x, f * y]);
  }

  state(time = this.time): Buffer {
    if (this.mode === 'recording') this.arm.bends = this.bends_at(time);
    this.recorded_at = time;
    const recording = this.mode === 'recording';
    return encode_state({
      flags: (this.moving && !recording ? 1 : 0) | (this.running ? 2 : 0) | (recording ? 4 : 0),
      leaps: this.leaps,
      sequence: ++this.sequence,
      time,
      bends: this.arm.bends.flat(),
      stretches: this.arm.stretches,
      samples: this.arm.samples(),
      cameras: this.camera_rows(),
      displacements: this.arm.displacements(),
    });
  }

  hello(session: string): Record<string, unknown> {
    const recording = this.mode === 'recording';
    return {
      type: 'hello', version: '0.1.0', session, mode: this.mode, title: this.rig.title, scene: this.rig.scene,
      controls: this.rig.controls, duration: this.duration, interval: this.mode === 'recording' ? 1 / 60 : 0,
      marks: recording
        ? [
            { time: 0, end: 4, level: 'info', name: 'reach', text: 'move' },
            { time: 2.5, end: 2.7, level: 'warning', name: 'near', text: 'near the post: 4 cm' },
            { time: 4, end: 6, level: 'info', name: 'back', text: 'move' },
            { time: 5, end: 5, level: 'error', name: 'jump', text: 'section 1 jumps' },
          ]
        : [],
      quantities: recording
        ? ['x', 'y', 'z'].map((axis) => ({ name: `tip.${axis}`, unit: 'm' })).concat(
            this.arm.bends.map((_, i) => ({ name: `bend[${i + 1}].x`, unit: 'rad' })))
        : [],
      report: recording, rig: this.has_rig, recording: this.has_recording || recording, readonly: recording || this.is_watched,
    };
  }

  series(names: string[], points: number): Record<string, number[]> {
    const times = Array.from({ length: points }, (_, i) => (recording_s * i) / (points - 1));
    const out: Record<string, number[]> = { time: times };
    for (const name of names) {
      out[name] = times.map((time) => {
        const bends = this.bends_at(time);
        const section = /^bend\[(\d+)\]/.exec(name);
        return section ? bends[Number(section[1]) - 1][0] : this.arm.tip(bends)['xyz'.indexOf(name.at(-1)!)];
      });
    }
    return out;
  }

  camera_pose(i: number): Pose {
    const [x, y, z, ...q] = this.rig.camera_poses[i];
    const { pan, tilt } = this.heads[i];
    const turned = times(times(q, [Math.cos(pan / 2), 0, -Math.sin(pan / 2), 0]), [Math.cos(tilt / 2), Math.sin(tilt / 2), 0, 0]);
    const shift = rotate([0, 0, 0, ...q], ...(this.stage as [number, number, number]), new Float64Array(3));
    const moved = i === 0 ? shift : [0, 0, 0];
    return [x + moved[0], y + moved[1], z + moved[2], ...turned] as unknown as Pose;
  }

  camera_rows(): number[] {
    return this.rig.scene.cameras.flatMap(({ width, height }, i) => {
      const { pan, tilt, zoom } = this.heads[i];
      const f = this.rig.focal * zoom;
      return [...this.camera_pose(i), pan, tilt, zoom, ...this.stage, f, f, (width - 1) / 2, (height - 1) / 2, pan, tilt, zoom, ...this.stage];
    });
  }

  /** Returns everything that the cameras' pictures depend on. */
  seen_now(): string {
    return [...this.arm.bends, ...this.arm.stretches, ...this.camera_rows()].join();
  }

  /** Returns the grey values of a picture. */
  pixels(i: number, time = this.time): Uint8Array {
    if (this.mode === 'recording') this.arm.bends = this.bends_at(time);
    const { width, height } = this.rig.scene.cameras[i];
    return draw_arm(width, height, this.seen(i));
  }

  picture(i: number, pixels = this.pixels(i)): Buffer {
    const { width, height } = this.rig.scene.cameras[i];
    return encode_png(width, height, pixels);
  }

  /** Returns the image points of the backbone in the last drawn picture. */
  seen(i: number): PointInPicture[] {
    const { width, height } = this.rig.scene.cameras[i];
    const samples = this.arm.samples();
    const pose = this.camera_pose(i);
    const back = [0, 0, 0, pose[3], -pose[4], -pose[5], -pose[6]];
    const f = this.rig.focal * this.heads[i].zoom;
    const total = samples[samples.length - 8];
    const radius = this.rig.scene.arm.sections[0].radius[0];
    const out: PointInPicture[] = [];
    const p = new Float64Array(3);
    for (let j = 0; j <= 300; ++j) {
      const { position } = point_at(samples, (total * j) / 300);
      rotate(back, position[0] - pose[0], position[1] - pose[1], position[2] - pose[2], p);
      if (p[2] > 0) out.push({ u: (f * p[0]) / p[2] + width / 2, v: (f * p[1]) / p[2] + height / 2, radius: (f * radius) / p[2] });
    }
    return out;
  }
}

function times(a: number[], b: number[]): number[] {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}
