// The paper's planar recurrence (section 3.1), with one sign for all angles: counter-clockwise is positive, and an
// arching is half the bend. docs/kinematic-model.md derives it.
import { sinc } from './arc';

export interface PlanarSection {
  length: number;
  /** Half the bend, rad. */
  arching: number;
}

export interface PlanarRow {
  /** The tangent's angle where the section starts, from +X. */
  tangent: number;
  arching: number;
  /** The cord's angle, from +X. */
  cord_angle: number;
  cord: number;
  /** The section's base point. */
  x: number;
  y: number;
  /** Its end: the next one's base point. */
  end_x: number;
  end_y: number;
}

/** The recurrence, section by section, from the base point (0, 0) and the tangent `start`. */
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

/** The archings behind cord angles: equation 5 read backwards. */
export function archings_of(cord_angles: number[], start = Math.PI / 2): number[] {
  let tangent = start;
  return cord_angles.map((cord) => {
    const arching = cord - tangent;
    tangent += 2 * arching;
    return arching;
  });
}

/** Cord angles of archings: equation 5. */
export function cord_angles_of(archings: number[], start = Math.PI / 2): number[] {
  let tangent = start;
  return archings.map((arching) => {
    const cord = tangent + arching;
    tangent += 2 * arching;
    return cord;
  });
}

/** The paper's experiment: eight sections and the cord angles in which it ends (section 3.2). */
export const paper_lengths = [2, 3, 1, 2, 4, 2, 1, 1];
export const paper_cord_angles = [0.55, 0.65, 0.8, 1, 1.15, 0.9, 0.8, 0.65].map((a) => a * Math.PI);

/** A point of an arc: the fraction f along a section of the recurrence. */
export function planar_point(row: PlanarRow, length: number, f: number): [number, number] {
  const cord = f * length * sinc(f * row.arching);
  const angle = row.tangent + f * row.arching;
  return [row.x + cord * Math.cos(angle), row.y + cord * Math.sin(angle)];
}
