import { expect, test } from 'vitest';
import { point_at } from '../../src/math/arc';
import {
  archings_of, cord_angles_of, paper_cord_angles, paper_lengths, planar_point, planar_rows,
} from '../../src/math/planar';
import { sample_arm, upright } from '../fake/forward';

function paper(f: number) {
  // Cord angles between those of the straight arm and the paper's, linearly.
  const cords = paper_cord_angles.map((angle) => Math.PI / 2 + f * (angle - Math.PI / 2));
  return planar_rows(archings_of(cords).map((arching, i) => ({ length: paper_lengths[i], arching })));
}

test.each([
  [0, 0, 16],
  [0.25, -4.34367, 15.116249],
  [0.5, -7.924923, 12.648849],
  [0.75, -10.152819, 9.106058],
  [1, -10.737859, 5.201359],
])('the paper’s arm at %f of its way ends in (%f, %f)', (f, x, y) => {
  const end = paper(f)[7];
  expect(end.end_x).toBeCloseTo(x, 6);
  expect(end.end_y).toBeCloseTo(y, 6);
});

test('the paper’s archings are its cord angles read backwards', () => {
  const archings = archings_of(paper_cord_angles).map((b) => b / Math.PI);
  [0.05, 0.05, 0.1, 0.1, 0.05, -0.3, 0.2, -0.35].forEach((b, i) => expect(archings[i]).toBeCloseTo(b, 12));
  cord_angles_of(archings_of(paper_cord_angles)).forEach((a, i) => expect(a).toBeCloseTo(paper_cord_angles[i], 12));
});

test('a straight section’s cord is as long as the section', () => {
  expect(planar_rows([{ length: 2, arching: 0 }])[0].cord).toBe(2);
  expect(planar_rows([{ length: 2, arching: 1e-9 }])[0].cord).toBeCloseTo(2, 12);
});

test('the plane and space agree: arching b is the bend (-2b, 0)', () => {
  const archings = archings_of(paper_cord_angles);
  const rows = planar_rows(archings.map((arching, i) => ({ length: paper_lengths[i], arching })));
  const samples = sample_arm(upright, archings.map((b, i) => ({ length: paper_lengths[i], bend_x: -2 * b, bend_y: 0, stretch: 1 })), 3);
  const [x, y] = planar_point(rows[4], 4, 0.37);
  const there = point_at(samples, 8 + 0.37 * 4).position;
  expect(there[0]).toBeCloseTo(x, 5);
  expect(there[1]).toBeCloseTo(y, 5);
});
