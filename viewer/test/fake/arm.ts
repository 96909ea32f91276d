// The fake rig's arm: bends follow their targets with limited rate; inverse kinematics by damped least squares.
import { sample_arm } from './forward';
import type { RigDescription } from './rigs';

export type Bends = [number, number][];

export const arcs_of_section = 4;

export class FakeArm {
  bends: Bends;
  stretches: number[];
  target: Bends;
  target_stretches: number[];

  constructor(readonly rig: RigDescription) {
    this.bends = rig.scene.arm.sections.map(() => [0, 0]);
    this.target = this.bends;
    this.stretches = this.bends.map(() => 1);
    this.target_stretches = this.stretches;
  }

  get planar(): boolean {
    return this.rig.scene.arm.kind === 'planar';
  }

  command(bends: Bends, stretches?: number[]): void {
    if (bends.length !== this.bends.length || bends.flat().some((b) => !Number.isFinite(b))) {
      throw new Error(`bends: ${this.bends.length} pairs of finite numbers are needed`);
    }
    this.target = bends.map((bend, i) => this.drawn(bend, i));
    if (stretches) {
      const limits = this.rig.controls.sections;
      this.target_stretches = stretches.map((f, i) => Math.min(limits[i].stretch[1], Math.max(limits[i].stretch[0], f)));
    }
  }

  step(dt: number): boolean {
    let moving = false;
    this.bends = this.bends.map(([x, y], i) => {
      const [tx, ty] = this.target[i];
      const far = Math.hypot(tx - x, ty - y);
      const most = (this.rig.controls.sections[i].bend_rate ?? 2) * dt;
      if (far <= most) return this.target[i];
      moving = true;
      return [x + ((tx - x) * most) / far, y + ((ty - y) * most) / far];
    });
    this.stretches = this.stretches.map((f, i) => f + Math.max(-0.2 * dt, Math.min(0.2 * dt, this.target_stretches[i] - f)));
    return moving;
  }

  samples(bends = this.bends): Float32Array {
    const { arm } = this.rig.scene;
    const shapes = arm.sections.map(({ length }, i) => ({
      length, bend_x: bends[i][0], bend_y: bends[i][1], stretch: this.stretches[i],
    }));
    return sample_arm(arm.base, shapes, arcs_of_section);
  }

  tip(bends: Bends): number[] {
    const rows = this.samples(bends);
    return [...rows.subarray(rows.length - 7, rows.length - 4)];
  }

  displacements(): number[] {
    const { tendons } = this.rig.controls;
    return (tendons ?? []).map(({ section, radius, angle }) =>
      this.bends.slice(0, section + 1).reduce((sum, [x, y]) => sum + radius * (x * Math.cos(angle) + y * Math.sin(angle)), 0),
    );
  }

  /** Returns the bends whose tendon lengths are nearest to these. */
  from_tendons(lengths: number[]): Bends {
    let before: [number, number] = [0, 0];
    return this.bends.map((_, section) => {
      let x = 0;
      let y = 0;
      for (let i = 3 * section; i < 3 * section + 3; ++i) {
        const { radius, angle } = this.rig.controls.tendons![i];
        x += ((2 / 3) * lengths[i] * Math.cos(angle)) / radius;
        y += ((2 / 3) * lengths[i] * Math.sin(angle)) / radius;
      }
      const bend: [number, number] = [x - before[0], y - before[1]];
      before = [x, y];
      return bend;
    });
  }

  inverse(position: number[]): { converged: boolean; reason: string; bends: Bends; position_error: number } {
    let bends = this.target.map(([x, y]) => [x, y] as [number, number]);
    const span = this.rig.scene.arm.sections.reduce((sum, { length }) => sum + length, 0);
    let error = Infinity;
    for (let turn = 0; turn < 80 && error > 1e-6 * span; ++turn) {
      bends = this.improve(bends, position);
      const tip = this.tip(bends);
      error = Math.hypot(...position.map((p, i) => p - tip[i]));
    }
    const converged = error < 1e-3 * span;
    return { converged, reason: converged ? 'converged' : 'out of reach', bends, position_error: error };
  }

  private drawn([x, y]: [number, number], i: number): [number, number] {
    const limit = this.rig.controls.sections[i].bend ?? Infinity;
    const size = Math.hypot(x, y);
    return size > limit ? [(x * limit) / size, (y * limit) / size] : [x, y];
  }

  private improve(bends: Bends, position: number[]): Bends {
    const tip = this.tip(bends);
    const span = this.rig.scene.arm.sections.reduce((sum, { length }) => sum + length, 0);
    let wanted = position.map((p, i) => p - tip[i]);
    const far = Math.hypot(...wanted);
    if (far > 0.1 * span) wanted = wanted.map((w) => (w * 0.1 * span) / far);
    const axes = this.planar ? [0] : [0, 1];
    const columns = bends.flatMap((_, i) => axes.map((axis) => {
      const moved = bends.map((bend) => [...bend] as [number, number]);
      moved[i][axis] += 1e-3;
      return this.tip(moved).map((p, j) => (p - tip[j]) / 1e-3);
    }));
    // Gauss-Seidel on (J J^T + d) y = e, three rows.
    const y = [0, 0, 0];
    const damping = 1e-3 * span * span;
    const normal = [0, 1, 2].map((r) => [0, 1, 2].map((c) => columns.reduce((sum, col) => sum + col[r] * col[c], r === c ? damping : 0)));
    for (let k = 0; k < 60; ++k) {
      for (let r = 0; r < 3; ++r) {
        y[r] = (wanted[r] - normal[r].reduce((sum, n, c) => (c === r ? sum : sum + n * y[c]), 0)) / normal[r][r];
      }
    }
    return bends.map((bend, i) => {
      const next = [...bend] as [number, number];
      axes.forEach((axis, k) => (next[axis] += columns[i * axes.length + k].reduce((sum, c, j) => sum + c * y[j], 0)));
      return this.drawn(next, i);
    });
  }
}
