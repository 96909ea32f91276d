// The arm's skin: rings swept along the arcs. Its buffers are allocated once per scene and filled for each state.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Sphere, Vector3 } from 'three';
import { Arc, new_pose, sample_count } from '../math/arc';
import { sample_stride } from '../protocol/state';
import type { Ring } from './rings';

/** Available numbers of sides; chosen so that facets deviate from the round tube by at most `most_off`. */
export const sides = [16, 32, 64, 128];
/** Largest deviation of a facet's middle from the round tube, px. */
const most_off = 0.25;

/** Returns the index in `sides` for a tube of this radius in pixels. */
export function fineness_of(radius: number): number {
  const enough = sides.findIndex((count) => radius * (1 - Math.cos(Math.PI / count)) < most_off);
  return enough < 0 ? sides.length - 1 : enough;
}

export class Tube {
  readonly geometry = new BufferGeometry();
  private readonly positions: Float32Array;
  private readonly normals: Float32Array;
  private readonly cosines: Float64Array;
  private readonly sines: Float64Array;
  private readonly arc = new Arc();
  private readonly pose = new_pose();

  constructor(private readonly rings: Ring[], private readonly around = sides[0]) {
    this.cosines = new Float64Array(around + 1);
    this.sines = new Float64Array(around + 1);
    const count = rings.length * (around + 1);
    this.positions = new Float32Array(3 * count);
    this.normals = new Float32Array(3 * count);
    const colors = new Float32Array(3 * count);
    for (let i = 0; i <= around; ++i) {
      this.cosines[i] = Math.cos((2 * Math.PI * i) / around);
      this.sines[i] = Math.sin((2 * Math.PI * i) / around);
    }
    rings.forEach(({ color }, r) => {
      for (let i = 0; i <= around; ++i) colors.set(color, 3 * (r * (around + 1) + i));
    });
    const position = new BufferAttribute(this.positions, 3).setUsage(DynamicDrawUsage);
    const normal = new BufferAttribute(this.normals, 3).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute('position', position);
    this.geometry.setAttribute('normal', normal);
    this.geometry.setAttribute('color', new BufferAttribute(colors, 3));
    this.geometry.setIndex(triangles(rings.length, around));
    // Otherwise three.js computes one from the first rings, which are all in one point, and no click would hit the arm.
    this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  }

  /** Places the rings along the arcs between the samples of a state. */
  lay(samples: ArrayLike<number>): void {
    const last = sample_count(samples) - 2;
    let interval = 0;
    this.arc.set(samples, 0);
    for (let r = 0; r < this.rings.length; ++r) {
      const s = this.rings[r].s;
      let moved = false;
      while (interval < last && s >= samples[(interval + 1) * sample_stride]) {
        ++interval;
        moved = true;
      }
      if (moved) this.arc.set(samples, interval);
      const from = samples[interval * sample_stride];
      const to = samples[(interval + 1) * sample_stride];
      const f = to > from ? Math.min(1, Math.max(0, (s - from) / (to - from))) : 0;
      this.ring(r, f);
    }
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.attributes.normal.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
  }

  private ring(r: number, f: number): void {
    const { around } = this;
    const { radius, offset, outward, along } = this.rings[r];
    const [px, py, pz, w, a, b, c] = this.arc.pose(f, this.pose);
    // The columns of the rotation: x, y and the tangent.
    const xx = 1 - 2 * (b * b + c * c), xy = 2 * (a * b + w * c), xz = 2 * (a * c - w * b);
    const yx = 2 * (a * b - w * c), yy = 1 - 2 * (a * a + c * c), yz = 2 * (b * c + w * a);
    const tx = 2 * (a * c + w * b), ty = 2 * (b * c - w * a), tz = 1 - 2 * (a * a + b * b);
    let at = 3 * r * (around + 1);
    for (let i = 0; i <= around; ++i, at += 3) {
      const nx = this.cosines[i] * xx + this.sines[i] * yx;
      const ny = this.cosines[i] * xy + this.sines[i] * yy;
      const nz = this.cosines[i] * xz + this.sines[i] * yz;
      this.positions[at] = px + offset * tx + radius * nx;
      this.positions[at + 1] = py + offset * ty + radius * ny;
      this.positions[at + 2] = pz + offset * tz + radius * nz;
      this.normals[at] = outward * nx + along * tx;
      this.normals[at + 1] = outward * ny + along * ty;
      this.normals[at + 2] = outward * nz + along * tz;
    }
  }
}

function triangles(rings: number, around: number): BufferAttribute {
  const index = new Uint32Array(6 * around * (rings - 1));
  let at = 0;
  for (let r = 0; r + 1 < rings; ++r) {
    for (let i = 0; i < around; ++i) {
      const a = r * (around + 1) + i;
      const b = a + around + 1;
      index.set([a, a + 1, b, b, a + 1, b + 1], at);
      at += 6;
    }
  }
  return new BufferAttribute(index, 1);
}
