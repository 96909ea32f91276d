// Drawing a region in a picture: a rectangle by a drag or two clicks, a polygon by clicks.
import type { Corner } from '../protocol/types';
import { most_corners } from './seeing';

export type RegionKind = 'rectangle' | 'polygon';

/** A region needs at least this many rows and columns, px. */
export const least_side = 8;

/** A region that is being drawn. Each method returns the region when it is complete, otherwise null. */
export class RegionTool {
  /** The corners so far. */
  corners: Corner[] = [];
  /** Where the pointer is; null before it is over the picture. */
  pointer: Corner | null = null;
  /** Why the last action had no effect; "" if it had one. */
  problem = '';
  private is_dragging = false;

  constructor(readonly kind: RegionKind) {}

  /** `near`: points closer than this count as the same, px. */
  press(at: Corner, near: number): Corner[] | null {
    this.pointer = at;
    this.problem = '';
    if (this.kind === 'polygon') return this.add(at, near);
    if (this.corners.length) return this.rectangle(at);
    this.corners = [at];
    this.is_dragging = true;
    return null;
  }

  move(at: Corner): void {
    this.pointer = at;
  }

  release(at: Corner, near: number): Corner[] | null {
    if (this.kind !== 'rectangle' || !this.is_dragging) return null;
    this.is_dragging = false;
    // A click: the next one is the opposite corner.
    return distance(this.corners[0], at) > near ? this.rectangle(at) : null;
  }

  /** Closes a polygon: Enter, or a double click. */
  close(): Corner[] | null {
    if (this.kind !== 'polygon') return null;
    if (this.corners.length < 3) {
      this.problem = 'A polygon needs at least three corners.';
      return null;
    }
    return is_large(this.corners) ? this.corners : this.refuse();
  }

  undo(): void {
    this.corners = this.corners.slice(0, -1);
    this.problem = '';
  }

  /** Returns what to draw: the corners, and the pointer as the next one. */
  outline(): Corner[] {
    if (!this.corners.length || !this.pointer) return this.corners;
    const [[left, top]] = this.corners;
    const [right, bottom] = this.pointer;
    if (this.kind === 'polygon') return [...this.corners, this.pointer];
    return [[left, top], [right, top], [right, bottom], [left, bottom]];
  }

  private add(at: Corner, near: number): Corner[] | null {
    if (this.corners.length > 2 && distance(this.corners[0], at) <= near) return this.close();
    // The second click of a double click adds nothing.
    if (this.corners.length && distance(this.corners.at(-1)!, at) <= near / 2) return null;
    if (this.corners.length >= most_corners) this.problem = `A region has at most ${most_corners} corners.`;
    else this.corners = [...this.corners, at];
    return null;
  }

  private rectangle([right, bottom]: Corner): Corner[] | null {
    const [[left, top]] = this.corners;
    const corners: Corner[] = [[Math.min(left, right), Math.min(top, bottom)], [Math.max(left, right), Math.max(top, bottom)]];
    return is_large(corners) ? corners : this.refuse();
  }

  private refuse(): null {
    if (this.kind === 'rectangle') this.corners = [];
    this.problem = `A region needs at least ${least_side} rows and columns.`;
    return null;
  }
}

function distance([a, b]: Corner, [c, d]: Corner): number {
  return Math.hypot(a - c, b - d);
}

function is_large(corners: Corner[]): boolean {
  const side = (axis: 0 | 1): number => {
    const values = corners.map((corner) => corner[axis]);
    return Math.max(...values) - Math.min(...values) + 1;
  };
  return side(0) >= least_side && side(1) >= least_side;
}
