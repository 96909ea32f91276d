import { expect, test } from 'vitest';
import { Arc, locate, new_pose, point_at, sinc } from '../../src/math/arc';
import { sample_arm, upright } from '../fake/forward';

const bent = [
  { length: 0.3, bend_x: 1.1, bend_y: -0.4, stretch: 1 },
  { length: 0.25, bend_x: 0, bend_y: 0, stretch: 1.1 },
  { length: 0.2, bend_x: -0.7, bend_y: 2.0, stretch: 0.9 },
];

test('what lies between two samples is the arc that finer samples show', () => {
  const coarse = sample_arm(upright, bent, 2);
  const fine = sample_arm(upright, bent, 64);
  const arc = new Arc();
  const pose = new_pose();
  for (let row = 0; row < fine.length; row += 8) {
    const { interval, fraction } = locate(coarse, fine[row]);
    arc.set(coarse, interval).pose(fraction, pose);
    for (let j = 0; j < 3; ++j) expect(pose[j]).toBeCloseTo(fine[row + 1 + j], 6);
    const same = [0, 1, 2, 3].reduce((sum, j) => sum + pose[3 + j] * fine[row + 4 + j], 0);
    expect(Math.abs(same)).toBeCloseTo(1, 6);
  }
});

test('an arc ends in its ends exactly', () => {
  const samples = sample_arm(upright, bent, 3);
  const arc = new Arc();
  const pose = new_pose();
  for (let i = 0; i + 1 < samples.length / 8; ++i) {
    arc.set(samples, i);
    for (const [f, row] of [[0, i], [1, i + 1]]) {
      arc.pose(f, pose);
      for (let j = 0; j < 3; ++j) expect(pose[j]).toBeCloseTo(samples[8 * row + 1 + j], 7);
    }
  }
});

test('curvature, bending plane and tangent are the section’s', () => {
  const samples = sample_arm(upright, bent, 4);
  const first = point_at(samples, 0.1);
  expect(first.curvature).toBeCloseTo(Math.hypot(1.1, 0.4) / 0.3, 4);
  expect(first.plane).toBeCloseTo(Math.atan2(-0.4, 1.1), 4);
  const last = point_at(samples, 0.7);
  expect(last.curvature).toBeCloseTo(Math.hypot(0.7, 2) / (0.2 * 0.9), 4);
  expect(last.plane).toBeCloseTo(Math.atan2(2.0, -0.7), 4);
  expect(point_at(samples, 0.4).curvature).toBeCloseTo(0, 3);
  expect(Math.hypot(...last.tangent)).toBeCloseTo(1, 6);
});

test('s before the base and beyond the tip is drawn to the ends', () => {
  const samples = sample_arm(upright, bent, 4);
  expect(point_at(samples, -1).position).toEqual([0, 0, 0]);
  const end = samples.length - 8;
  expect(point_at(samples, 9).position[1]).toBeCloseTo(samples[end + 2], 6);
});

test('sinc is smooth where its series takes over', () => {
  expect(sinc(0)).toBe(1);
  expect(Math.abs(sinc(1e-4) - sinc(0.999999e-4))).toBeLessThan(1e-13);
});
