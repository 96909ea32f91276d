// The paper's planar recurrence (section 3.1) with one sign convention for all angles: counter-clockwise is positive,
// and an arching is half the bend. See docs/kinematic-model.md for the derivation.
import { sinc } from './arc';

export interface PlanarSection {
  length: number;
  /** Half the bend, rad. */
  arching: number;
}

export interface PlanarRow {
  /** Angle of the tangent at the section's start, from +X, rad. */
  tangent: number;
  arching: number;
  /** Angle of the cord from +X, rad. */
  cord_angle: number;
  cord: number;
  /** Base point of the section. */
  x: number;
  y: number;
  /** End point of the section, the next one's base point. */
  end_x: number;
  end_y: number;
}

/** Computes the recurrence for all sections from the base point (0, 0) and the tangent angle `start`. */
export function planar_rows(sections: PlanarSection[], start = Math.PI / 2): PlanarRow[] {
  let tangent = start;
  let x = 0;
  let y = 0;
  return sections.map(({ length, arching }) => {
    const cord_angle = tangent + arching;
    const cord = length * sinc(arching);
    const row: PlanarRow = {
      tangent, arching, cord_angle, cord, x, y,
      end_x: x + cord * Math.cos(cord_angle),
      end_y: y + cord * Math.sin(cord_angle),
    };
    tangent += 2 * arching;
    x = row.end_x;
    y = row.end_y;
    return row;
  });
}

/** Returns the archings for given cord angles: equation 5 solved for the archings. */
export function archings_of(cord_angles: number[], start = Math.PI / 2): number[] {
  let tangent = start;
  return cord_angles.map((cord) => {
    const arching = cord - tangent;
    tangent += 2 * arching;
    return arching;
  });
}

/** Returns the cord angles for given archings: equation 5. */
export function cord_angles_of(archings: number[], start = Math.PI / 2): number[] {
  let tangent = start;
  return archings.map((arching) => {
    const cord = tangent + arching;
    tangent += 2 * arching;
    return cord;
  });
}

/** The paper's experiment: section lengths, and the final cord angles (section 3.2). */
export const paper_lengths = [2, 3, 1, 2, 4, 2, 1, 1];
export const paper_cord_angles = [0.55, 0.65, 0.8, 1, 1.15, 0.9, 0.8, 0.65].map((a) => a * Math.PI);

/** Returns the point at the fraction f along a section of the recurrence. */
export function planar_point(row: PlanarRow, length: number, f: number): [number, number] {
  const cord = f * length * sinc(f * row.arching);
  const angle = row.tangent + f * row.arching;
  return [row.x + cord * Math.cos(angle), row.y + cord * Math.sin(angle)];
}
