import { describe, expect, test } from 'vitest';
import { actuators_of, force_scale, force_text, moved } from '../../src/panels/actuators';
import { modes_of } from '../../src/panels/arm_model';
import { live_sources } from '../../src/plots/sources';
import { decode_state } from '../../src/protocol/state';
import type { ActuatorControl, Controls, Hello } from '../../src/protocol/types';
import { encode_state } from '../fake/encode';
import { spatial_rig } from '../fake/rigs';

/** Three tendons around a section. */
const three: ActuatorControl[] = [0, 1, 2].map((i) => ({
  name: `Tendon ${i + 1}`, section: 0, range: [-0.02, 0.02], motor: false, together: [0, 1, 2].map((j) => (i === j ? 1 : -0.5)),
}));

function state(actuators: number[]) {
  const bytes = encode_state({ flags: 16, sequence: 1, time: 1, bends: [0, 0], stretches: [1], samples: new Float32Array(16), cameras: [], displacements: [], actuators });
  return decode_state(new Uint8Array(bytes).buffer);
}

describe('tendons that are pulled one by one', () => {
  test('are slack where they do not pull', () => {
    const [first, second] = actuators_of(state([0.5, 2, 0, -0.25, 0, 60]));
    expect(first).toEqual({ value: 0.5, force: 2, slack: false, lost: 0 });
    expect(second).toEqual({ value: -0.25, force: 0, slack: true, lost: 60 });
    expect(actuators_of(state([]))).toEqual([]);
  });

  test('move alone, or with the others', () => {
    expect(moved(three, [0, 0, 0], 1, 0.01, false)).toEqual([0, 0.01, 0]);
    expect(moved(three, [0, 0, 0], 1, 0.01, true)).toEqual([-0.005, 0.01, -0.005]);
    expect(moved(three, [0, 0, 0], 1, 1, false)).toEqual([0, 0.02, 0]);
  });

  test('stop together where the first of them is at its end', () => {
    const [a, b, c] = moved(three, [-0.018, 0, 0.01], 1, 0.02, true);
    expect(a).toBeCloseTo(-0.02, 12);
    expect(b).toBeCloseTo(0.004, 12);
    expect(c).toBeCloseTo(0.008, 12);
    // A tendon that is already beyond its limit does not jump back.
    expect(moved(three, [-0.02, 0, 0], 1, 0.01, true)).toEqual([-0.02, 0, 0]);
  });

  test('have a scale of round numbers', () => {
    expect([[], [0.2], [1.2], [2], [4.9], [7], [730]].map(force_scale)).toEqual([1, 1, 2, 2, 5, 10, 1000]);
    expect([0.1234, 9.87, 12.34, 678.9].map(force_text)).toEqual(['0.12 N', '9.87 N', '12.3 N', '679 N']);
  });

  test('are a way to move the arm, and two plots', () => {
    const { scene } = spatial_rig();
    const controls: Controls = { ...spatial_rig().controls, tendons: null, actuators: three };
    expect(modes_of('spatial', controls)).toEqual(['bends', 'tendons']);
    const sources = live_sources({ controls } as Hello, scene);
    const tensions = sources.find(({ id }) => id === 'tensions')!;
    expect(tensions.names).toEqual(['tendon 1', 'tendon 2', 'tendon 3']);
    expect(tensions.value(state([0, 2, 0, 0, 3, 0, 0, 4, 0]), 2)).toBe(4);
    expect(sources.find(({ id }) => id === 'tendons')!.value(state([0, 2, 0, 0.25, 3, 0]), 1)).toBe(250);
    expect(sources.find(({ id }) => id === 'bends')!.label).toBe('Bends, commanded');
  });
});
