// Forward kinematics of constant-curvature sections, for the fake server and as a test reference.
import { rotate, sinc } from '../../src/math/arc';
import { sample_stride } from '../../src/protocol/state';

export interface SectionShape {
  length: number;
  bend_x: number;
  bend_y: number;
  stretch: number;
}

/** Returns samples as in a state message: `count` arcs per section, from the base's pose on. */
export function sample_arm(base: ArrayLike<number>, sections: SectionShape[], count: number): Float32Array {
  const rows = new Float32Array((sections.length * count + 1) * sample_stride);
  const pose = Float64Array.from(Array.from({ length: 7 }, (_, i) => base[i]));
  const step = new Float64Array(3);
  let s = 0;
  let row = 0;
  const write = (): void => {
    rows[row] = s;
    rows.set(pose, row + 1);
    row += sample_stride;
  };
  write();
  for (const section of sections) {
    const bend = Math.hypot(section.bend_x, section.bend_y) / count;
    const length = (section.length * section.stretch) / count;
    const direction = Math.atan2(section.bend_y, section.bend_x);
    const chord = length * sinc(bend / 2);
    const c = Math.cos(direction);
    const d = Math.sin(direction);
    for (let i = 0; i < count; ++i) {
      const side = chord * Math.sin(bend / 2);
      rotate(pose, side * c, side * d, chord * Math.cos(bend / 2), step);
      for (let j = 0; j < 3; ++j) pose[j] += step[j];
      turn(pose, Math.cos(bend / 2), -Math.sin(bend / 2) * d, Math.sin(bend / 2) * c);
      s += section.length / count;
      write();
    }
  }
  return rows;
}

function turn(pose: Float64Array, w: number, x: number, y: number): void {
  const [, , , pw, px, py, pz] = pose;
  pose[3] = pw * w - px * x - py * y;
  pose[4] = pw * x + px * w - pz * y;
  pose[5] = pw * y + py * w + pz * x;
  pose[6] = px * y - py * x + pz * w;
}

/** Default base pose: z along +Y, x along +X. */
export const upright: [number, number, number, number, number, number, number] = [
  0, 0, 0, Math.SQRT1_2, -Math.SQRT1_2, 0, 0,
];
