// The arm's soft shadow on the floor, straight below it: crisp and dark where the arm touches the floor, wide and faint
// where it is high above. Computed here, as a small picture of the arm's surroundings only: in software renderers a
// shadow map costs as much as all other drawing.
import { Arc, new_pose, sample_count } from '../math/arc';
import type { Ring } from './rings';
import { sample_stride } from '../protocol/state';

/** Edge length of the shadow's picture, texels. */
export const shade_size = 72;
/** Growth of the blurred border with height, and its largest width in lengths of the arm. */
const [growth, widest] = [0.3, 0.14];

/** Darkness of the floor around the arm, 0 to 255, row by row, and the rectangle that it covers. */
export class Shade {
  readonly texels = new Uint8Array(shade_size * shade_size);
  /** Edges of the covered rectangle, m. */
  left = 0;
  near = 0;
  right = 1;
  far = 1;
  private readonly points: Float64Array;
  private readonly arc = new Arc();
  private readonly pose = new_pose();
  /** Of each point: x, z, radius, blur, darkness. */
  private static readonly stride = 5;

  constructor(private readonly rings: Ring[], private readonly span: number, private readonly floor: number) {
    this.points = new Float64Array(Shade.stride * rings.length);
  }

  /** Computes the shadow of the arm in this shape. */
  lay(samples: ArrayLike<number>): void {
    this.place(samples);
    this.bound();
    this.texels.fill(0);
    for (let i = 1; i < this.rings.length; ++i) this.cast(Shade.stride * i);
  }

  private place(samples: ArrayLike<number>): void {
    const { points, rings, floor, span } = this;
    const last = sample_count(samples) - 2;
    let interval = 0;
    this.arc.set(samples, 0);
    for (let i = 0, at = 0; i < rings.length; ++i, at += Shade.stride) {
      const { s, radius } = rings[i];
      const before = interval;
      while (interval < last && s >= samples[(interval + 1) * sample_stride]) ++interval;
      if (interval !== before) this.arc.set(samples, interval);
      const from = samples[interval * sample_stride];
      const to = samples[(interval + 1) * sample_stride];
      const [x, y, z] = this.arc.pose(to > from ? Math.min(1, Math.max(0, (s - from) / (to - from))) : 0, this.pose);
      const height = y - floor;
      const blur = Math.min(widest * span, 0.004 * span + 0.5 * radius + growth * Math.max(0, height));
      points[at] = x;
      points[at + 1] = z;
      points[at + 2] = radius;
      points[at + 3] = blur;
      // What is below the floor casts no shadow on it.
      points[at + 4] = height > -2 * radius ? Math.min(1, 0.35 + (0.65 * 3 * radius) / (3 * radius + blur)) : 0;
    }
  }

  private bound(): void {
    const { points } = this;
    this.left = this.near = Infinity;
    this.right = this.far = -Infinity;
    for (let at = 0; at < points.length; at += Shade.stride) {
      const reach = points[at + 2] + points[at + 3];
      this.left = Math.min(this.left, points[at] - reach);
      this.right = Math.max(this.right, points[at] + reach);
      this.near = Math.min(this.near, points[at + 1] - reach);
      this.far = Math.max(this.far, points[at + 1] + reach);
    }
  }

  /** Darkens the texels around the piece between a point and the one before. */
  private cast(at: number): void {
    const { points, texels, left, near } = this;
    const dark = 255 * points[at + 4];
    if (dark <= 0) return;
    const before = at - Shade.stride;
    const [x0, z0, x1, z1] = [points[before], points[before + 1], points[at], points[at + 1]];
    const [radius, blur] = [points[at + 2], points[at + 3]];
    const reach = radius + blur;
    const [width, depth] = [(this.right - left) / shade_size, (this.far - near) / shade_size];
    const column = (x: number): number => Math.min(shade_size - 1, Math.max(0, Math.floor((x - left) / width)));
    const row = (z: number): number => Math.min(shade_size - 1, Math.max(0, Math.floor((z - near) / depth)));
    const [first, last] = [column(Math.min(x0, x1) - reach), column(Math.max(x0, x1) + reach)];
    const [dx, dz] = [x1 - x0, z1 - z0];
    const square = dx * dx + dz * dz;
    const end = row(Math.max(z0, z1) + reach);
    for (let j = row(Math.min(z0, z1) - reach); j <= end; ++j) {
      const z = near + (j + 0.5) * depth - z0;
      for (let i = first, to = j * shade_size + first; i <= last; ++i, ++to) {
        const x = left + (i + 0.5) * width - x0;
        const f = square > 0 ? Math.min(1, Math.max(0, (x * dx + z * dz) / square)) : 0;
        const off = Math.hypot(x - f * dx, z - f * dz);
        if (off >= reach) continue;
        // Half of the border is within the arm's outline.
        const g = Math.min(1, (reach - off) / (blur + Math.min(blur, radius)));
        const value = dark * g * g * (3 - 2 * g);
        if (value > texels[to]) texels[to] = value;
      }
    }
  }
}
