import { type Group, type InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, PerspectiveCamera, Raycaster, Vector3 } from 'three';
import { expect, test, vi } from 'vitest';
import { point_at } from '../../src/math/arc';
import type { State } from '../../src/protocol/state';
import type { Pose } from '../../src/protocol/types';
import { see_through } from '../../src/scene/camera_view';
import { Orbit } from '../../src/scene/orbit';
import { make_arm } from '../../src/scene/parts/arm';
import { gap_between, make_cameras } from '../../src/scene/parts/cameras';
import { grid_step } from '../../src/scene/parts/floor';
import { make_ghosts, samples_of } from '../../src/scene/parts/ghosts';
import { nearest_point } from '../../src/scene/pick';
import { medium, painter, plan_rings, radius_at, total_length } from '../../src/scene/rings';
import { Tube } from '../../src/scene/tube';
import { FakeArm } from '../fake/arm';
import { sample_arm } from '../fake/forward';
import { planar_rig, spatial_rig } from '../fake/rigs';

const rig = spatial_rig();
const { arm } = rig.scene;

function bent(): Float32Array {
  const fake = new FakeArm(rig);
  fake.bends = rig.goal;
  return fake.samples();
}

test('the skin lies at the arm’s radius around the arcs, to a thousandth of it', () => {
  const rings = plan_rings(arm);
  const tube = new Tube(rings);
  const samples = bent();
  tube.lay(samples);
  const positions = tube.geometry.getAttribute('position');
  const around = positions.count / rings.length;
  rings.forEach(({ s, radius, offset }, r) => {
    if (offset !== 0) return;
    const { position, tangent } = point_at(samples, s);
    for (let i = 0; i < around; ++i) {
      const v = r * around + i;
      const d = [positions.getX(v) - position[0], positions.getY(v) - position[1], positions.getZ(v) - position[2]];
      expect(Math.abs(Math.hypot(...d) - radius)).toBeLessThan(1e-3 * 0.02);
      expect(Math.abs(d[0] * tangent[0] + d[1] * tangent[1] + d[2] * tangent[2])).toBeLessThan(1e-3 * 0.02);
    }
  });
});

test('between two corners the skin is round to a quarter of a pixel, however near one looks', () => {
  const span = total_length(arm);
  const [part] = make_arm({ scene: rig.scene, span, floor: 0, theme: 'dark' });
  const skin = (part.group as Group).children[0] as Mesh;
  const samples = bent();
  const tip = point_at(samples, span).position;
  const radius = radius_at(arm, 0);
  const sides: number[] = [];
  part.draw!({ samples } as State);
  for (const away of [30, 5, 2, 1.2, 0.5].map((f) => f * span)) {
    part.seen_from!(new Vector3(tip[0] + away, tip[1], tip[2]), 1000);
    const positions = skin.geometry.getAttribute('position');
    const [few, all] = [plan_rings(arm, painter(arm), medium), plan_rings(arm)];
    const rings = positions.count === 17 * few.length ? few : all;
    const around = positions.count / rings.length;
    sides.push(around - 1);
    // Distance of each facet's middle from the true radius, compared with the distance of the nearest point of the arm.
    let nearest = Infinity;
    for (let i = 0; i < samples.length; i += 8) {
      nearest = Math.min(nearest, Math.hypot(samples[i + 1] - tip[0] - away, samples[i + 2] - tip[1], samples[i + 3] - tip[2]));
    }
    const corner = (r: number, i: number) => new Vector3().fromBufferAttribute(positions, r * around + i);
    let worst = 0;
    rings.forEach(({ s, radius: own, offset }, r) => {
      if (offset !== 0 || own === 0) return;
      const middle = new Vector3(...point_at(samples, s).position);
      for (let i = 0; i + 1 < around; ++i) {
        const facet = corner(r, i).add(corner(r, i + 1)).multiplyScalar(0.5);
        worst = Math.max(worst, own - facet.distanceTo(middle));
      }
    });
    expect((1000 * worst) / nearest).toBeLessThan(0.25);
    expect(worst).toBeLessThan(0.02 * radius);
  }
  expect(sides[0]).toBe(16);
  expect(sides.at(-1)).toBeGreaterThan(32);
  expect(sides).toEqual([...sides].sort((a, b) => a - b));
  // Motion updates the visible skin.
  const straight = new FakeArm(rig).samples();
  part.draw!({ samples: straight } as State);
  const end = new Vector3().fromBufferAttribute(skin.geometry.getAttribute('position'), skin.geometry.getAttribute('position').count - 1);
  expect(end.distanceTo(new Vector3(...point_at(straight, span).position))).toBeLessThan(2 * radius);
  // After moving away, the other skin is updated.
  part.seen_from!(new Vector3(30 * span, 0, 0), 1000);
  const again = new Vector3().fromBufferAttribute(skin.geometry.getAttribute('position'), skin.geometry.getAttribute('position').count - 1);
  expect(again.distanceTo(end)).toBeLessThan(1e-6);
});

test('the skin’s normals have length one and point outwards', () => {
  const tube = new Tube(plan_rings(arm));
  tube.lay(bent());
  const normals = tube.geometry.getAttribute('normal');
  for (let i = 0; i < normals.count; ++i) {
    expect(Math.hypot(normals.getX(i), normals.getY(i), normals.getZ(i))).toBeCloseTo(1, 5);
  }
});

test('each guide disk stands across the backbone at its own place', () => {
  const [length, bend] = [0.6, 1.2];
  const disks = [{ at: 0, radius: 0.05, thickness: 0.01 }, { at: 0.25, radius: 0.04, thickness: 0.02 }, { at: 0.6, radius: 0.03, thickness: 0.006 }];
  const scene = { ...rig.scene, arm: { ...arm, sections: [{ ...arm.sections[0], length }], markers: [], disks } };
  const [part] = make_arm({ scene, span: length, floor: 0, theme: 'dark' });
  // Starting straight: the disks move with the arm.
  for (const bend_x of [0, bend]) part.draw!({ samples: sample_arm(arm.base, [{ length, bend_x, bend_y: 0, stretch: 1 }], 4) } as State);
  const mesh = (part.group as Group).children[1] as InstancedMesh;
  const corners = mesh.geometry.getAttribute('position');
  expect(mesh.count).toBe(disks.length);
  disks.forEach(({ at, radius, thickness }, i) => {
    // An arc from the origin, upright, bent towards +x.
    const [bow, turned] = [length / bend, (bend * at) / length];
    const middle = new Vector3(bow * (1 - Math.cos(turned)), bow * Math.sin(turned), 0);
    const along = new Vector3(Math.sin(turned), Math.cos(turned), 0);
    const matrix = new Matrix4();
    mesh.getMatrixAt(i, matrix);
    const off = Array.from({ length: corners.count }, (_, corner) => {
      const from_middle = new Vector3().fromBufferAttribute(corners, corner).applyMatrix4(matrix).sub(middle);
      const height = from_middle.dot(along);
      return { height, width: from_middle.addScaledVector(along, -height).length() };
    });
    for (const { height } of off) expect(Math.abs(height)).toBeCloseTo(thickness / 2, 5);
    // Corners on the rim, and the centres of both faces.
    for (const { width } of off) expect(Math.min(width, Math.abs(width - radius))).toBeLessThan(1e-5);
    expect(Math.max(...off.map(({ width }) => width))).toBeCloseTo(radius, 5);
    expect(new Set(off.map(({ height }) => Math.sign(height)))).toEqual(new Set([-1, 1]));
  });
});

test('seen thin, the arm’s outline is a quarter of a pixel beside its arcs at most, at all bends', () => {
  for (const { scene } of [rig, planar_rig()]) {
    const pixels = 600 / total_length(scene.arm);
    // Largest distance between two rings at the maximum bend of a section.
    let start = 0;
    for (const { length, max_bend } of scene.arm.sections) {
      const own = plan_rings(scene.arm, painter(scene.arm), medium).map(({ s }) => s)
        .filter((s) => s >= start - 1e-9 && s <= start + length + 1e-9);
      const widest = Math.max(...own.slice(1).map((s, i) => s - own[i]));
      expect(((widest * widest * max_bend!) / length / 8) * pixels).toBeLessThan(0.25);
      start += length;
    }
  }
});

test('markers begin and end where the scene says', () => {
  const rings = plan_rings(arm);
  for (const { from, to, color } of arm.markers) {
    const own = rings.filter((ring) => ring.color === color).map(({ s }) => s);
    expect(Math.min(...own)).toBeCloseTo(from, 9);
    expect(Math.max(...own)).toBeCloseTo(to, 9);
  }
});

test('radii taper within a section and jump where the next is thinner', () => {
  const stepped = { ...arm, sections: [{ ...arm.sections[0], radius: [0.03, 0.03] as [number, number] }, arm.sections[1]] };
  expect(radius_at(stepped, 0.3, true)).toBe(0.03);
  expect(radius_at(stepped, 0.3)).toBe(arm.sections[1].radius[0]);
  expect(radius_at(arm, 0.15)).toBeCloseTo(0.0235, 9);
  const radii = plan_rings(stepped).filter(({ s }) => Math.abs(s - 0.3) < 1e-9).map(({ radius }) => radius);
  expect(new Set(radii).size).toBe(2);
});

test('a round tip ends one radius beyond the arm, a flat one with it', () => {
  const last = (kind: 'round' | 'flat') => plan_rings({ ...arm, tip: kind }).at(-1)!;
  expect(last('round').offset).toBeCloseTo(arm.sections[2].radius[1], 9);
  expect(last('round').radius).toBeCloseTo(0, 9);
  expect(last('flat').offset).toBe(0);
});

test('the point under the pointer is found to a thousandth of the arm', () => {
  const samples = bent();
  const camera = new PerspectiveCamera(40, 1.5, 0.01, 10);
  camera.position.set(0.8, 0.9, 1.4);
  camera.lookAt(0, 0.3, 0);
  camera.updateMatrixWorld();
  for (const s of [0.05, 0.31, 0.6, 0.75]) {
    const { position } = point_at(samples, s);
    const p = new (camera.position.constructor as new (...xyz: number[]) => typeof camera.position)(...position).project(camera);
    const hit = nearest_point(samples, camera, 600, 400, ((p.x + 1) / 2) * 600 + 3, ((1 - p.y) / 2) * 400);
    expect(Math.abs(hit.s - s)).toBeLessThan(0.02);
    expect(hit.distance).toBeLessThan(3.1);
  }
});

test('a ghost’s poses become samples over the whole unstretched arm', () => {
  const rows = sample_arm(arm.base, arm.sections.map(({ length }) => ({ length, bend_x: 0.4, bend_y: 0.2, stretch: 1.08 })), 4);
  const poses = Array.from({ length: rows.length / 8 }, (_, i) => [...rows.subarray(8 * i + 1, 8 * i + 8)] as unknown as Pose);
  const again = samples_of(poses, total_length(arm));
  for (let i = 0; i < rows.length; i += 8) expect(again[i]).toBeCloseTo(rows[i], 5);
});

test('the floor has some ten round squares along any arm', () => {
  for (const span of [0.003, 0.4, 0.75, 16, 120]) {
    const count = span / grid_step(span);
    expect(count).toBeGreaterThan(3);
    expect(count).toBeLessThanOrEqual(8.000001);
  }
  expect(total_length(planar_rig().scene.arm)).toBe(16);
});

test('the free view goes neither into a point nor out of sight', () => {
  const orbit = new Orbit();
  orbit.span = 2;
  for (let i = 0; i < 200; ++i) orbit.zoom(0.5);
  expect(orbit.distance).toBeCloseTo(0.04, 12);
  for (let i = 0; i < 200; ++i) orbit.zoom(2);
  expect(orbit.distance).toBeCloseTo(60, 12);
});

/** The default scene without configured cameras: they look at the base from 3.48 arm lengths away. */
function default_stand(): { scene: typeof rig.scene; state: State; span: number } {
  const span = total_length(arm);
  const far = (span * Math.hypot(760, 228)) / 228;
  const seen = [0, 0, 1, 0, 0, 0, 760, 760, 319.5, 239.5, 0, 0, 1, 0, 0, 0];
  const cameras = Float32Array.from([
    0, 0, far, 0, 1, 0, 0, ...seen,
    -far, 0, 0, 0, Math.SQRT1_2, 0, Math.SQRT1_2, ...seen,
  ]);
  const state = {
    flags: 0, leaps: 0, sequence: 0, time: 0, bends: new Float32Array(), stretches: new Float32Array(), samples: new FakeArm(rig).samples(),
    cameras, displacements: new Float32Array(), actuators: new Float32Array(),
  };
  return { scene: rig.scene, state, span };
}

test('no camera’s picture hangs before the arm from where one looks by the keys 1, 3, 7 and 0', () => {
  vi.stubGlobal('document', { createElement: () => ({ getContext: () => null }) });
  const { scene, state, span } = default_stand();
  const parts = make_cameras({ scene, span, floor: 0, theme: 'dark' });
  const orbit = new Orbit();
  const camera = new PerspectiveCamera(38, 1.2);
  const shown = (azimuth: number, elevation: number): number[] => {
    orbit.target.set(0, 0.42 * span, 0);
    orbit.distance = 2.9 * span;
    orbit.look(azimuth, elevation);
    orbit.place(camera);
    return parts.map((part) => {
      part.seen_from!(camera.position, 1000);
      const picture = part.group.children[1] as Mesh;
      return picture.visible ? (picture.material as MeshBasicMaterial).opacity : 0;
    });
  };
  for (const part of parts) part.draw!(state);
  expect(shown(0.85, 0.34)).toEqual([0, 0]);
  for (const { name } of scene.cameras) {
    for (const part of parts) part.picture!(name, { number: 1, time: 0, bitmap: {} as ImageBitmap });
  }
  // In the default view both pictures are visible; from behind one camera only that of the other.
  for (const opacity of shown(0.85, 0.34)) expect(opacity).toBeGreaterThan(0.9);
  expect(shown(0, 0)[0]).toBe(0);
  expect(shown(0, 0)[1]).toBeGreaterThan(0.9);
  expect(shown(-Math.PI / 2, 0)[1]).toBe(0);
  expect(shown(-Math.PI / 2, 0)[0]).toBeGreaterThan(0.9);
  for (const opacity of shown(0, Math.PI / 2)) expect(opacity).toBeGreaterThan(0.9);
  vi.unstubAllGlobals();
});

test('a picture between the eye and a point covers it, and one beside or behind does not', () => {
  const hanging = { left: -1, right: 1, top: -0.5, bottom: 0.5, depth: 2 };
  const gap = (eye: [number, number, number], point: [number, number, number]) =>
    gap_between(hanging, new Vector3(...eye), new Vector3(...point));
  expect(gap([0, 0, 0], [0, 0, 4])).toBe(0);
  expect(gap([0, 0, 0], [1.9, 0, 4])).toBe(0);
  expect(gap([0, 0, 0], [3, 0, 4])).toBeCloseTo(0.25, 12);
  expect(gap([0, 0, 0], [0, -2, 4])).toBeCloseTo(0.25, 12);
  expect(gap([0, 0, 0], [0, 0, 1])).toBe(Infinity);
  expect(gap([0, 0, 3], [0, 0, 4])).toBe(Infinity);
  expect(gap([0, 0, 4], [0, 0, 1])).toBe(0);
});

test('through a camera one sees as near and as far wherever the world’s origin is', () => {
  const near_of = (shift: number): number => {
    const camera = new PerspectiveCamera();
    const moved = { ...rig.scene, arm: { ...arm, base: arm.base.map((x, i) => (i === 0 ? x + shift : x)) as Pose } };
    const cameras = Float32Array.from([shift, 0.4, 2.2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 760, 760, 319.5, 239.5, 0, 0, 1, 0, 0, 0]);
    const state = {
      flags: 0, leaps: 0, sequence: 0, time: 0, bends: new Float32Array(), stretches: new Float32Array(), samples: new Float32Array(),
      cameras, displacements: new Float32Array(), actuators: new Float32Array(),
    };
    expect(see_through(camera, moved, state, 'front', 4 / 3)).toBe(true);
    return camera.near;
  };
  expect(near_of(100)).toBeCloseTo(near_of(0), 5);
});

test('through a camera beside the base one sees everything that stands around', () => {
  const camera = new PerspectiveCamera();
  const cameras = Float32Array.from([0.03, 0.01, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 760, 760, 319.5, 239.5, 0, 0, 1, 0, 0, 0]);
  const state = { samples: new Float32Array(), cameras } as State;
  expect(see_through(camera, rig.scene, state, 'front', 4 / 3)).toBe(true);
  expect(camera.near).toBeLessThan(0.01 - radius_at(arm, 0) / 10);
  for (const { pose, size } of rig.scene.screens) {
    expect(camera.far).toBeGreaterThan(Math.hypot(pose[0] - 0.03, pose[1] - 0.01, pose[2]) + Math.hypot(...size) / 2 - 0.04);
  }
  const far_off = { ...rig.scene, obstacles: [{ name: 'moon', kind: 'sphere' as const, center: [0, 0, -50] as [number, number, number], radius: 2 }] };
  see_through(camera, far_off, state, 'front', 4 / 3);
  expect(camera.far).toBeGreaterThan(52);
});

test('the arm is hit where it is now, also when it was looked at before it lay anywhere', () => {
  const tube = new Tube(plan_rings(arm));
  const skin = new Mesh(tube.geometry, new MeshBasicMaterial());
  const ray = new Raycaster(new Vector3(0, 0.5, 3), new Vector3(0, 0, -1));
  expect(ray.intersectObject(skin)).toHaveLength(0);
  tube.lay(new FakeArm(rig).samples());
  expect(ray.intersectObject(skin)[0].point.z).toBeCloseTo(radius_at(arm, 0.5), 2);
});

test('a ghost that moves keeps its skin, and goes when it has no poses', () => {
  const [part] = make_ghosts({ scene: rig.scene, span: 1, floor: 0, theme: 'dark' });
  const group = part.group as Group;
  const poses_of = (samples: Float32Array): Pose[] =>
    Array.from({ length: samples.length / 8 }, (_, i) => [...samples.subarray(8 * i + 1, 8 * i + 8)] as unknown as Pose);
  const show = (samples: Float32Array | null): void =>
    part.ghosts!({ shape: { type: 'ghost', id: 'shape', color: '#b197fc', poses: samples ? poses_of(samples) : [] } });
  const tip = () => {
    const positions = ((group.children[0] as Mesh).geometry).getAttribute('position');
    return new Vector3().fromBufferAttribute(positions as never, positions.count - 1);
  };
  show(new FakeArm(rig).samples() as unknown as Float32Array);
  const [first, straight] = [group.children[0], tip()];
  show(bent());
  expect(group.children).toHaveLength(1);
  expect(group.children[0]).toBe(first);
  expect(tip().distanceTo(straight)).toBeGreaterThan(0.05);
  const { position } = point_at(bent(), total_length(arm));
  expect(tip().distanceTo(new Vector3(...position))).toBeLessThan(0.03);
  show(null);
  expect(group.children).toHaveLength(0);
});
