// The floor, what passes through it, and the shadow on it.
import { Vector3 } from 'three';
import { expect, test } from 'vitest';
import type { Pose, Scene } from '../../src/protocol/types';
import { depth_below, depth_text, floor_of } from '../../src/scene/floor_level';
import { frame_of, distance_for, nearest_look, screen_points, type Look } from '../../src/scene/framing';
import { format_step, make_floor } from '../../src/scene/parts/floor';
import { make_ghosts } from '../../src/scene/parts/ghosts';
import { coarse, painter, plan_rings } from '../../src/scene/rings';
import { Shade, shade_size } from '../../src/scene/shade';
import type { State } from '../../src/protocol/state';
import type { Group, Mesh } from 'three';
import { FakeSession } from '../fake/session';
import { frustum_points } from '../../src/scene/framing';
import { sample_arm } from '../fake/forward';
import { planar_rig, spatial_rig } from '../fake/rigs';

const { scene } = spatial_rig();
const { arm } = scene;
const span = 0.75;
const down: Pose = [0, 0.9, 0, 0, 0, Math.SQRT1_2, -Math.SQRT1_2];
const shape = (bends: number[], base = arm.base): Float32Array =>
  sample_arm(base, arm.sections.map(({ length }, i) => ({ length, bend_x: bends[i], bend_y: 0, stretch: 1 })), 4);

test('the floor is the horizontal plane among the obstacles, else below the arm', () => {
  const bare: Scene = { ...scene, obstacles: [] };
  expect(floor_of(scene)).toEqual({ height: 0, obstacle: 'ground' });
  expect(floor_of(bare)).toEqual({ height: 0, obstacle: null });
  const hung: Scene = { ...bare, arm: { ...arm, base: down } };
  // Where the world's ground is near, it is that.
  expect(floor_of(hung)).toEqual({ height: 0, obstacle: null });
  const high: Pose = [0, 5, 0, 0, 0, Math.SQRT1_2, -Math.SQRT1_2];
  expect(floor_of({ ...bare, arm: { ...arm, base: high } }).height).toBeCloseTo(5 - 1.05 * span, 9);
  expect(floor_of({ ...hung, obstacles: scene.obstacles })).toEqual({ height: 0, obstacle: 'ground' });
  const wall: Scene = { ...bare, obstacles: [{ name: 'wall', kind: 'plane', point: [0, 0, 0], normal: [1, 0, 0] }] };
  expect(floor_of(wall).obstacle).toBe(null);
});

test('the depth below the floor is that of the skin', () => {
  expect(depth_below(shape([0, 0, 0]), arm, 0)).toBe(0);
  expect(depth_below(shape([1, 0.5, 0]), arm, 0)).toBe(0);
  // Half a circle and more: the tip points down beside the base.
  const bent = shape([2.2, 1, 0.4]);
  const tip = bent[bent.length - 6];
  expect(depth_below(bent, arm, 0)).toBeGreaterThan(-tip - 1e-6);
  // A straight arm from above: exactly as far as it reaches through.
  expect(depth_below(shape([0, 0, 0], down), arm, 0.9 - span + 0.05)).toBeCloseTo(0.05, 4);
  expect([0.0034, 0.012, 0.25, 3].map(depth_text)).toEqual(['3.4 mm', '12 mm', '25.0 cm', '3.00 m']);
});

test('the shadow is dark where the arm touches the floor, and wide and faint where it is high', () => {
  const rings = plan_rings({ ...arm, markers: [], tip: 'flat' }, painter(arm), coarse);
  const shade = new Shade(rings, span, 0);
  const at = (x: number, z: number): number => {
    const i = Math.floor(((x - shade.left) / (shade.right - shade.left)) * shade_size);
    const j = Math.floor(((z - shade.near) / (shade.far - shade.near)) * shade_size);
    return shade.texels[j * shade_size + i];
  };
  shade.lay(shape([Math.PI / 2, 0, 0]));
  expect(shade.right).toBeGreaterThan(0.6);
  expect(at(0, 0)).toBeGreaterThan(200);
  const far = at(0.5, 0);
  expect(far).toBeGreaterThan(30);
  expect(far).toBeLessThan(at(0, 0));
  // Blurred: it fades away from its middle, and ends before the border.
  expect(at(0.5, 0.04)).toBeLessThan(far);
  for (let i = 0; i < shade_size; ++i) expect(shade.texels[i * shade_size]).toBeLessThan(40);
  // What is below the floor casts none.
  const deep = new Shade(rings, span, 2);
  deep.lay(shape([0, 0, 0]));
  expect(Math.max(...deep.texels)).toBe(0);
});

test('the scale names the edge of a square, at the side of the eye', () => {
  expect([0.001, 0.05, 0.1, 0.2, 2].map(format_step)).toEqual(['1 mm', '5 cm', '0.1 m', '0.2 m', '2 m']);
  const parts = make_floor({ scene, span, floor: 0, theme: 'dark' });
  const scale = parts.find(({ id }) => id === 'scale')!;
  const [{ text, at }] = scale.labels!;
  expect(text).toBe('0.1 m');
  for (const [x, z] of [[0, 3], [3, 0], [0, -3], [-3, 0]]) {
    scale.seen_from!(new Vector3(x, 1, z), 1000);
    expect(at.x * x + at.z * z).toBeGreaterThan(0);
  }
  const letters = (of: string) => parts.find(({ id }) => id === of)?.labels?.map((label) => label.text).join('');
  expect(letters('axes')).toBe('XYZ');
  expect(letters('base axes')).toBe(undefined);
  const hung = make_floor({ scene: { ...scene, arm: { ...arm, base: down } }, span, floor: 0, theme: 'dark' });
  const own = hung.find(({ id }) => id === 'base axes')!.labels!;
  expect(own.map((label) => label.text).join('')).toBe('xyz');
  // z is along the arm, which hangs.
  expect(own[2].at.y).toBeLessThan(0.9 - 0.1 * span);
});

test('the opening view holds cameras and screens, as near as possible', () => {
  for (const rig of [spatial_rig(), planar_rig()]) {
    const length = rig.scene.arm.sections.reduce((sum, each) => sum + each.length, 0);
    const target = new Vector3(0, 0.42 * length, 0);
    const look: Look = { target, azimuth: 0.6, elevation: 0.34, fov: 38, aspect: 1.3 };
    const points = [
      ...frustum_points(rig.scene, Float32Array.from(new FakeSession(rig).camera_rows())), ...screen_points(rig.scene, target, 0, length),
    ];
    expect(points).toHaveLength(5 * 2 + 4 * 2);
    const { right, up, distance } = frame_of(points, look, length);
    expect(distance).toBeGreaterThanOrEqual(nearest_look * length);
    const [sa, ca, se, ce] = [Math.sin(0.6), Math.cos(0.6), Math.sin(0.34), Math.cos(0.34)];
    const moved = target.clone().add(new Vector3(ca, 0, -sa).multiplyScalar(right)).add(new Vector3(-se * sa, ce, -se * ca).multiplyScalar(up));
    const needed = points.map((point) => distance_for(point, { ...look, target: moved }));
    expect(Math.max(...needed)).toBeCloseTo(distance, 6);
  }
});

test('a true ghost knows how far it is beside the drawn arm', () => {
  const [part] = make_ghosts({ scene, span, floor: 0, theme: 'dark' });
  const samples = shape([0.5, 0.3, 0]);
  const poses = (rows: Float32Array): Pose[] => Array.from({ length: rows.length / 8 }, (_, i) => [...rows.subarray(8 * i + 1, 8 * i + 8)] as unknown as Pose);
  const show = (rows: Float32Array, id = 'extra truth'): Float32Array => {
    part.ghosts!({ [id]: { type: 'ghost', id, color: '#ffffff', poses: poses(rows) } });
    return ((part.group as Group).children[0] as Mesh).geometry.getAttribute('away').array as Float32Array;
  };
  part.draw!({ samples } as State);
  expect(Math.max(...show(samples))).toBeLessThan(1e-6);
  // Only the last section differs, so only there is something to be seen.
  const away = show(shape([0.5, 0.3, 0.4]));
  expect(away[0]).toBeLessThan(1e-6);
  expect(away.at(-1)).toBeGreaterThan(0.02);
  part.draw!({ samples: shape([0.5, 0.3, 0.4]) } as State);
  expect(Math.max(...away)).toBeLessThan(1e-6);
  // A target is always seen.
  expect(Math.min(...show(samples, 'extra target'))).toBeGreaterThan(1);
});
