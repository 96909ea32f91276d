// Five exercises on the planar arm. Each is checked by the state of the arm alone, so nothing can be solved by guessing
// an input.
import { planar_rows, type PlanarSection } from '../math/planar';

export interface Exercise {
  id: string;
  title: string;
  task: string;
  hint: string;
  /** Section lengths of the arm for this exercise. */
  lengths: number[];
  start: number[];
  /** A point to reach, drawn in the plane. */
  goal?: [number, number];
  /** Returns whether the exercise is done, and a line about what is missing. */
  check(sections: PlanarSection[]): { done: boolean; text: string };
}

const degree = 180 / Math.PI;

function tip(sections: PlanarSection[]): { x: number; y: number; tangent: number } {
  const rows = planar_rows(sections);
  const last = rows[rows.length - 1];
  return { x: last.end_x, y: last.end_y, tangent: last.tangent + 2 * last.arching };
}

function number(value: number, places = 2): string {
  return value.toFixed(places).replace('-', '−');
}

/** Tolerances suitable for a mouse: 1 % of the arm's length, and 1 degree. */
const close = 0.01;
const near = 1 / degree;

function total(sections: PlanarSection[]): number {
  return sections.reduce((sum, { length }) => sum + length, 0);
}

export const exercises: Exercise[] = [
  {
    id: 'half-turn',
    title: 'A half circle',
    task: 'Bend the one section until its end points straight down (tangent −90°). How large is its arching, and how long its cord?',
    hint: 'The tangent turns by twice the arching: from +90° down to −90° it turns by −180°.',
    lengths: [3],
    start: [0.2],
    check(sections) {
      const { tangent } = tip(sections);
      const off = Math.abs(Math.abs(tangent - Math.PI / 2) - Math.PI);
      const cord = planar_rows(sections)[0].cord;
      return {
        done: off < near,
        text: off < near
          ? `Arching ${number(sections[0].arching * degree, 1)}°, cord ${number(cord)} = 2/π of the length.`
          : `The tangent at the end is at ${number(tangent * degree, 1)}°.`,
      };
    },
  },
  {
    id: 'parallel',
    title: 'Aside, and upright again',
    task: 'Bend both sections so that the tip points straight up again but stands 1 m to the right of the base.',
    hint: 'Upright again means that the archings add up to zero. Which sign moves the tip to the right?',
    lengths: [2, 2],
    start: [0, 0],
    check(sections) {
      const { x, tangent } = tip(sections);
      const turned = tangent - Math.PI / 2;
      const done = Math.abs(turned) < near && Math.abs(x - 1) < close * total(sections);
      return { done, text: `x = ${number(x)} m, the tip leans by ${number(turned * degree, 1)}°.` };
    },
  },
  {
    id: 'reach',
    title: 'Reach a point',
    task: 'Bring the tip to the marked point (−2, 3), with three sections.',
    hint: 'Drag the tip, or start with the section nearest to the base: it moves the tip most.',
    lengths: [2, 2, 1.5],
    start: [0, 0, 0],
    goal: [-2, 3],
    check(sections) {
      const { x, y } = tip(sections);
      const off = Math.hypot(x + 2, y - 3);
      return { done: off < close * total(sections), text: `The tip is ${number(off)} m away.` };
    },
  },
  {
    id: 'cord',
    title: 'The second cord',
    task: 'The first section keeps its arching of 30°. Make the second cord horizontal, pointing left (180°).',
    hint: 'Equation 5: the second cord’s angle is 90° + 2 · 30° + its own arching.',
    lengths: [2, 2],
    start: [30 / degree, 0],
    check(sections) {
      const rows = planar_rows(sections);
      const kept = Math.abs(sections[0].arching - 30 / degree) < near;
      const off = Math.abs(rows[1].cord_angle - Math.PI);
      return {
        done: kept && off < near,
        text: kept ? `The second cord is at ${number(rows[1].cord_angle * degree, 1)}°.` : 'Set the first arching to 30° again.',
      };
    },
  },
  {
    id: 'paper',
    title: 'The paper’s arm',
    task: 'Eight sections. All but the fifth are as in the paper’s experiment; find the fifth arching for which the fifth cord makes 1.15 π (207°) with Ox, and see where the end effector ends.',
    hint: 'The tangent where section 5 starts is at 90° + 2 · (9° + 9° + 18° + 18°) = 198°.',
    lengths: [2, 3, 1, 2, 4, 2, 1, 1],
    start: [0.05, 0.05, 0.1, 0.1, 0, -0.3, 0.2, -0.35].map((a) => a * Math.PI),
    check(sections) {
      const rows = planar_rows(sections);
      const others = [0.05, 0.05, 0.1, 0.1, null, -0.3, 0.2, -0.35];
      const kept = sections.every(({ arching }, i) => others[i] === null || Math.abs(arching - others[i]! * Math.PI) < near);
      const off = Math.abs(rows[4].cord_angle - 1.15 * Math.PI);
      const { x, y } = tip(sections);
      const done = kept && off < near / 2;
      return { done, text: `E = (${number(x, 3)}, ${number(y, 3)})${done ? ': the paper has (−10.738, 5.201).' : ''}` };
    },
  },
];
