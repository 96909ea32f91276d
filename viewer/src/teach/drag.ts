// Dragging the planar arm by a joint: the archings before it follow (least squares, with enough damping that every step
// reduces the distance).
import { planar_rows, type PlanarSection } from '../math/planar';

const turns = 30;

/** Returns the archings that bring the end of section `joint` as near to (x, y) as possible within the limit. */
export function pull(sections: PlanarSection[], joint: number, x: number, y: number, limit: number): PlanarSection[] {
  const reach = sections.reduce((sum, { length }) => sum + length, 0);
  let now = sections;
  let off = distance(now, joint, x, y);
  let damping = 1e-3 * reach * reach;
  for (let turn = 0; turn < turns && off > 1e-6 * reach; ++turn) {
    const next = step(now, joint, x, y, damping, limit);
    const after = distance(next, joint, x, y);
    if (after < off) {
      now = next;
      off = after;
      damping /= 3;
    } else {
      damping *= 5;
    }
  }
  return now;
}

function distance(sections: PlanarSection[], joint: number, x: number, y: number): number {
  const { end_x, end_y } = planar_rows(sections)[joint];
  return Math.hypot(x - end_x, y - end_y);
}

function step(
  sections: PlanarSection[], joint: number, x: number, y: number, damping: number, limit: number,
): PlanarSection[] {
  const { end_x, end_y } = planar_rows(sections)[joint];
  const columns = slopes(sections, joint);
  const [a, b, d] = columns.reduce(
    ([xx, xy, yy], [cx, cy]) => [xx + cx * cx, xy + cx * cy, yy + cy * cy], [damping, 0, damping]);
  const det = a * d - b * b;
  const gx = (d * (x - end_x) - b * (y - end_y)) / det;
  const gy = (a * (y - end_y) - b * (x - end_x)) / det;
  return sections.map((section, i) => {
    if (i > joint) return section;
    const arching = section.arching + columns[i][0] * gx + columns[i][1] * gy;
    return { ...section, arching: Math.min(limit, Math.max(-limit, arching)) };
  });
}

/** Returns the derivatives of the joint's end by each arching, by finite differences. */
function slopes(sections: PlanarSection[], joint: number): [number, number][] {
  const h = 1e-5;
  return sections.slice(0, joint + 1).map((_, i) => {
    const at = (arching: number): [number, number] => {
      const row = planar_rows(sections.map((section, j) => (j === i ? { ...section, arching } : section)))[joint];
      return [row.end_x, row.end_y];
    };
    const [x1, y1] = at(sections[i].arching + h);
    const [x0, y0] = at(sections[i].arching - h);
    return [(x1 - x0) / (2 * h), (y1 - y0) / (2 * h)];
  });
}
