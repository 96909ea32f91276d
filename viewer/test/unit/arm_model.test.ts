import { expect, test } from 'vitest';
import { archings_of, paper_cord_angles } from '../../src/math/planar';
import { changed, command_of, modes_of, reach_of, slots_of, span_of, start_tangent, values_of } from '../../src/panels/arm_model';
import { pull, tendon_reach } from '../../src/panels/tendons';
import type { State } from '../../src/protocol/state';
import { FakeArm } from '../fake/arm';
import { upright } from '../fake/forward';
import { planar_rig, spatial_rig } from '../fake/rigs';

const planar = planar_rig();
const spatial = spatial_rig();

function state(bends: [number, number][], displacements: number[] = []): State {
  return {
    flags: 0, leaps: 0, sequence: 0, time: 0, bends: Float32Array.from(bends.flat()), stretches: new Float32Array(bends.length).fill(1),
    samples: new Float32Array(0), cameras: new Float32Array(0), displacements: Float32Array.from(displacements), actuators: new Float32Array(0),
  };
}

test('an arm that stands upright starts at a right angle', () => {
  expect(start_tangent(upright)).toBeCloseTo(Math.PI / 2, 6);
});

test('the paper’s arm reads in cord angles and archings as the paper says', () => {
  const paper = state(planar.goal);
  values_of('cord_angles', 'planar', paper).forEach((a, i) => expect(a).toBeCloseTo(paper_cord_angles[i], 5));
  values_of('archings', 'planar', paper).forEach((b, i) => expect(b).toBeCloseTo(archings_of(paper_cord_angles)[i], 5));
});

test.each(['archings', 'cord_angles', 'bends'] as const)('in %s the sliders’ request makes the arm that they show', (mode) => {
  const values = values_of(mode, 'planar', state(planar.goal));
  const command = command_of(mode, 'planar', values, null);
  const bends = (command.bends as [number, number][] | undefined)
    ?? (command.archings as number[] | undefined ?? archings_of(command.cord_angles as number[])).map((b) => [-2 * b, 0]);
  bends.forEach(([x], i) => expect(x).toBeCloseTo(planar.goal[i][0], 5));
});

test('tendons are asked for as they are shown', () => {
  const arm = new FakeArm(spatial);
  arm.bends = spatial.goal;
  const values = values_of('tendons', 'spatial', state(arm.bends, arm.displacements()));
  const command = command_of('tendons', 'spatial', values, [1, 1, 1]);
  const bends = arm.from_tendons(command.tendons as number[]);
  bends.flat().forEach((b, i) => expect(b).toBeCloseTo(spatial.goal.flat()[i], 4));
  expect(command.stretches).toBeUndefined();
  expect(command_of('bends', 'spatial', spatial.goal.flat(), [1, 1, 1]).stretches).toEqual([1, 1, 1]);
});

test('a spatial section’s bend stays in a disc: what x can be depends on y', () => {
  const limit = spatial.controls.sections[0].bend!;
  const values = [0, 0.8 * limit, 0, 0, 0, 0];
  expect(reach_of('bends', 'spatial', spatial.controls, values, 0)[1]).toBeCloseTo(0.6 * limit, 9);
  const next = changed('bends', 'spatial', spatial.controls, values, 0, limit);
  expect(Math.hypot(next[0], next[1])).toBeCloseTo(limit, 9);
});

test('a cord reaches half the bend to both sides of the tangent at its start, and takes the later ones with it', () => {
  const { controls } = planar;
  const limit = controls.sections[0].bend!;
  const straight = controls.sections.map(() => Math.PI / 2);
  expect(reach_of('cord_angles', 'planar', controls, straight, 3)).toEqual([Math.PI / 2 - limit / 2, Math.PI / 2 + limit / 2]);
  const next = changed('cord_angles', 'planar', controls, straight, 0, Math.PI / 2 + 0.5 * limit);
  archings_of(next).forEach((arching) => expect(Math.abs(arching)).toBeLessThanOrEqual(limit / 2 + 1e-12));
  expect(next[0]).toBeCloseTo(Math.PI / 2 + limit / 2, 9);
  expect(next[1]).not.toBeCloseTo(Math.PI / 2, 3);
});

test('a slider is a bit wider than its limits, and holds a value beyond them', () => {
  const limit = planar.controls.sections[0].bend!;
  const [low, high] = span_of('bends', 'planar', planar.controls, 0, 0);
  expect(high).toBeGreaterThan(limit);
  expect(low).toBe(-high);
  expect(span_of('bends', 'planar', planar.controls, 0, 9)[1]).toBe(9);
});

test('each arm offers what it can be said in', () => {
  expect(modes_of('planar', planar.controls)).toEqual(['archings', 'cord_angles', 'bends']);
  expect(modes_of('spatial', spatial.controls)).toEqual(['bends', 'tendons']);
  expect(slots_of('bends', 'spatial', spatial.controls)).toHaveLength(6);
  expect(slots_of('tendons', 'spatial', spatial.controls)).toHaveLength(9);
});

function bent(bends: [number, number][]): { arm: FakeArm; pulled: { displacements: number[]; bends: number[] } } {
  const arm = new FakeArm(spatial);
  arm.bends = bends;
  return { arm, pulled: { displacements: arm.displacements(), bends: bends.flat() } };
}

test.each([0, 4, 8])('tendon %i takes the others along: what is asked for is one shape', (i) => {
  const { arm, pulled } = bent([[0.5, -0.2], [0.1, 0.6], [-0.4, 0.3]]);
  const next = pull('spatial', spatial.controls, pulled, i, pulled.displacements[i] + 0.004);
  expect(next.displacements[i]).toBeCloseTo(pulled.displacements[i] + 0.004, 12);
  arm.bends = arm.from_tendons(next.displacements);
  arm.displacements().forEach((length, j) => expect(length).toBeCloseTo(next.displacements[j], 12));
  arm.bends.flat().forEach((bend, j) => expect(bend).toBeCloseTo(next.bends[j], 12));
  // Only its own section bends.
  const own = Math.floor(i / 3);
  pulled.bends.forEach((bend, j) => j >> 1 !== own && expect(next.bends[j]).toBe(bend));
});

test('a tendon goes as far as its section may bend', () => {
  const limit = spatial.controls.sections[1].bend!;
  const { pulled } = bent([[0.5, -0.2], [0.1, 0.6], [-0.4, 0.3]]);
  for (const target of [-1, 1]) {
    const next = pull('spatial', spatial.controls, pulled, 4, target);
    expect(Math.hypot(next.bends[2], next.bends[3])).toBeCloseTo(limit, 9);
    expect(tendon_reach('spatial', spatial.controls, pulled, 4)[target < 0 ? 0 : 1]).toBeCloseTo(next.displacements[4], 12);
  }
});

test('in a plane a tendon pulls by what of its place lies there, and one beside it not at all', () => {
  const controls = {
    ...planar.controls,
    tendons: [0.3, Math.PI / 2].map((angle) => ({ section: 0, displacement: [-1, 1] as [number, number], radius: 0.3, angle })),
  };
  const pulled = { displacements: [0, 0], bends: planar.goal.map(() => [0, 0]).flat() };
  const next = pull('planar', controls, pulled, 0, 0.1);
  expect(next.bends.slice(0, 2)).toEqual([0.1 / (0.3 * Math.cos(0.3)), 0]);
  expect(tendon_reach('planar', controls, pulled, 1)).toEqual([0, 0]);
});

test('a cord angle’s slider is as wide as the limits of its section and of those before let it lean, and no wider', () => {
  const { controls } = planar;
  const degrees = Math.PI / 180;
  const limited = (...bends: (number | null)[]) => ({
    ...controls, sections: bends.map((bend) => ({ ...controls.sections[0], bend: bend === null ? null : bend * degrees })),
  });
  const narrow = limited(20, 40, 10);
  const span = (of: typeof controls, i: number, value = Math.PI / 2): number[] =>
    span_of('cord_angles', 'planar', of, i, value).map((end) => end / degrees - 90);
  [10, 40, 65].forEach((most, i) => {
    const [low, high] = span(narrow, i);
    expect(high).toBeGreaterThan(most);
    expect(high).toBeLessThan(1.1 * most);
    expect(low).toBeCloseTo(-high, 9);
    // All bent as far as can be, to one side: the slider holds that.
    const archings = narrow.sections.map(({ bend }) => bend! / 2);
    const cords = values_of('cord_angles', 'planar', state(archings.map((b) => [-2 * b, 0])));
    expect(cords[i] / degrees - 90).toBeCloseTo(most, 4);
  });
  expect(span(limited(null, 20), 1)[1]).toBeCloseTo(225, 9);
  expect(span(controls, 7)[1]).toBeCloseTo(225, 9);
  expect(span(narrow, 0, Math.PI)[1]).toBeCloseTo(90, 9);
});
