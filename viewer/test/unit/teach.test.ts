import { expect, test } from 'vitest';
import { planar_rows, type PlanarSection } from '../../src/math/planar';
import { pull } from '../../src/teach/drag';
import { exercises } from '../../src/teach/exercises';

const degree = Math.PI / 180;

/** Archings that solve each exercise. */
const answers: Record<string, number[]> = {
  'half-turn': [-90 * degree],
  parallel: [-Math.asin(1 / 4) * 1.024, Math.asin(1 / 4) * 1.024],
  cord: [30 * degree, 30 * degree],
  paper: [0.05, 0.05, 0.1, 0.1, 0.05, -0.3, 0.2, -0.35].map((a) => a * Math.PI),
};

function arm(lengths: number[], archings: number[]): PlanarSection[] {
  return lengths.map((length, i) => ({ length, arching: archings[i] }));
}

test('there are five, and none is done at its start', () => {
  expect(exercises).toHaveLength(5);
  for (const { lengths, start, check } of exercises) expect(check(arm(lengths, start)).done).toBe(false);
});

test.each(exercises.filter(({ id }) => answers[id]).map((exercise) => [exercise.id, exercise] as const))(
  'the exercise %s knows its answer', (id, { lengths, check }) => {
    if (id === 'parallel') {
      // One metre aside, solved by bisection because the exercise has no closed-form solution.
      let [low, high] = [0, 1];
      for (let i = 0; i < 50; ++i) {
        const b = (low + high) / 2;
        if (planar_rows(arm(lengths, [-b, b]))[1].end_x < 1) low = b;
        else high = b;
      }
      answers.parallel = [-low, low];
    }
    expect(check(arm(lengths, answers[id])).done).toBe(true);
  },
);

test('an answer a little off is not taken', () => {
  for (const [id, archings] of Object.entries(answers)) {
    const { lengths, check } = exercises.find((exercise) => exercise.id === id)!;
    const off = archings.map((b, i) => (i === archings.length - 1 || id === 'half-turn' ? b + 4 * degree : b));
    expect(check(arm(lengths, off)).done, id).toBe(false);
  }
});

test('the paper’s exercise shows the paper’s end effector', () => {
  const paper = exercises.find(({ id }) => id === 'paper')!;
  expect(paper.check(arm(paper.lengths, answers.paper)).text).toContain('(−10.738, 5.201)');
});

test('dragging the tip solves the exercise of reaching', () => {
  const { lengths, start, goal, check } = exercises.find(({ id }) => id === 'reach')!;
  let sections = arm(lengths, start);
  for (let i = 0; i < 10; ++i) sections = pull(sections, 2, ...goal!, Math.PI);
  expect(check(sections).done).toBe(true);
});

test('dragging an inner joint leaves the sections beyond it bent as they were', () => {
  const before = arm([2, 2, 1], [0.1, -0.2, 0.3]);
  const after = pull(before, 1, 1, 3, Math.PI);
  const end = planar_rows(after)[1];
  expect(Math.hypot(end.end_x - 1, end.end_y - 3)).toBeLessThan(0.01);
  expect(after[2]).toEqual(before[2]);
});

test('a goal out of reach is gone towards, and no arching beyond its limit', () => {
  const after = pull(arm([1, 1], [0.1, 0.1]), 1, 30, -40, 1);
  for (const { arching } of after) expect(Math.abs(arching)).toBeLessThanOrEqual(1);
});
