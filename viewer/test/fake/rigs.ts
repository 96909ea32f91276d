// Two rigs: the paper's planar arm and a spatial arm with tendons.
import { archings_of, paper_cord_angles, paper_lengths } from '../../src/math/planar';
import type { Controls, Pose, Scene } from '../../src/protocol/types';
import { upright } from './forward';

export interface RigDescription {
  title: string;
  scene: Scene;
  controls: Controls;
  /** Final bends of the tasks, rad. */
  goal: [number, number][];
  camera_poses: Pose[];
  focal: number;
}

const degrees = Math.PI / 180;
const picture = { width: 640, height: 480 };

function cameras(): Scene['cameras'] {
  return [
    { name: 'front', ...picture, channels: 1 },
    { name: 'side', ...picture, channels: 1 },
  ];
}

/** On +Z and on -X, image y downwards: docs/conventions.md. */
function camera_poses(distance: number, height: number): Pose[] {
  return [
    [0, height, distance, 0, 1, 0, 0],
    [-distance, height, 0, 0, Math.SQRT1_2, 0, Math.SQRT1_2],
  ];
}

function screens(distance: number, height: number, size: number): Scene['screens'] {
  return [
    { pose: [0, height, -distance, 1, 0, 0, 0], size: [size, size], brightness: 0.85 },
    { pose: [distance, height, 0, Math.SQRT1_2, 0, -Math.SQRT1_2, 0], size: [size, size], brightness: 0.85 },
  ];
}

function heads(): Pick<Controls, 'heads' | 'stages'> {
  const axes = { pan: [-135 * degrees, 135 * degrees], tilt: [-45 * degrees, 90 * degrees], zoom: [1, 10] };
  const stage = { x: [-0.2, 0.2], y: [-0.2, 0.2], z: [-0.2, 0.2] };
  return {
    heads: ['front', 'side'].map((camera) => ({ camera, ...axes }) as Controls['heads'][0]),
    stages: [{ camera: 'front', ...stage } as Controls['stages'][0]],
  };
}

export function planar_rig(): RigDescription {
  const archings = archings_of(paper_cord_angles);
  const limit = 170 * degrees;
  let s = 0;
  return {
    title: 'The paper’s experiment',
    scene: {
      arm: {
        kind: 'planar',
        sections: paper_lengths.map((length) => ({ length, radius: [0.3, 0.3], max_bend: limit, stretch: [1, 1] })),
        color: [0.1, 0.12, 0.14],
        tip: 'round',
        markers: paper_lengths.map((length) => ({ from: (s += length) - 0.12, to: s, color: [0.75, 0.05, 0.04] })),
        disks: [],
        disk_color: [0.3, 0.3, 0.3],
        base: upright,
        visible: true,
      },
      screens: screens(18, 8, 36),
      etalon: null,
      obstacles: [{ name: 'post', kind: 'capsule', from: [8, 0, 0], to: [8, 6, 0], radius: 0.6 }],
      cameras: cameras(),
      light: { towards: [0.4, 0.8, 0.45], ambient: 0.45, directional: 0.55 },
      background: 0.02,
    },
    controls: {
      sections: paper_lengths.map(() => ({ bend: limit, stretch: [1, 1], bend_rate: 1 })),
      tendons: null,
      ...heads(),
      tasks: [{ name: 'reach', kind: 'move' }, { name: 'look', kind: 'hold' }],
    },
    goal: archings.map((arching) => [-2 * arching, 0]),
    camera_poses: camera_poses(46, 8),
    focal: 800,
  };
}

export function spatial_rig(): RigDescription {
  const lengths = [0.3, 0.25, 0.2];
  const radii = [0.025, 0.022, 0.019, 0.016];
  const limit = 120 * degrees;
  const disks = Array.from({ length: 14 }, (_, i) => ({ at: 0.05 * (i + 1), radius: 0.03 - 0.0007 * i, thickness: 0.004 }));
  return {
    title: 'The laboratory arm',
    scene: {
      arm: {
        kind: 'spatial',
        sections: lengths.map((length, i) => ({ length, radius: [radii[i], radii[i + 1]], max_bend: limit, stretch: [0.9, 1.1] })),
        color: [0.09, 0.1, 0.12],
        tip: 'round',
        markers: [0.29, 0.54, 0.72].map((from) => ({ from, to: from + 0.012, color: [0.8, 0.25, 0.02] })),
        disks,
        disk_color: [0.35, 0.38, 0.4],
        base: upright,
        visible: true,
      },
      screens: screens(1, 0.4, 1.7),
      etalon: {
        pose: [0.5, 0.15, -0.3, 1, 0, 0, 0], radius: 0.06, height: 0.3, line_width: 0.006,
        color: [0.05, 0.05, 0.05], line_color: [0.7, 0.02, 0.02],
      },
      obstacles: [
        { name: 'ball', kind: 'sphere', center: [-0.35, 0.1, 0.3], radius: 0.09 },
        { name: 'crate', kind: 'box', center: [0.1, 0.06, -0.45], half_sizes: [0.1, 0.06, 0.06], rotation: [0.966, 0, 0.259, 0] },
        { name: 'ground', kind: 'plane', point: [0, 0, 0], normal: [0, 1, 0] },
      ],
      cameras: cameras(),
      light: { towards: [0.4, 0.8, 0.45], ambient: 0.45, directional: 0.55 },
      background: 0.02,
    },
    controls: {
      sections: lengths.map(() => ({ bend: limit, stretch: [0.9, 1.1], bend_rate: 90 * degrees })),
      tendons: [0, 120, 240, 40, 160, 280, 80, 200, 320].map((angle, i) => {
        const section = Math.floor(i / 3);
        const most = 0.014 * limit * (section + 1);
        return { section, displacement: [-most, most], radius: 0.014, angle: angle * degrees };
      }),
      ...heads(),
      tasks: [{ name: 'bow', kind: 'move' }, { name: 'curl', kind: 'move' }, { name: 'look', kind: 'hold' }],
    },
    goal: [[1.05, 0], [0, 1.57], [-1.05, 1.05]],
    camera_poses: camera_poses(2.2, 0.4),
    focal: 760,
  };
}
