import {
  Color, CylinderGeometry, Group, InstancedMesh, Matrix4, Mesh, MeshLambertMaterial, MeshPhongMaterial, Quaternion, Sphere, Vector3,
} from 'three';
import { Arc, locate, new_pose } from '../../math/arc';
import { sample_stride, type State } from '../../protocol/state';
import type { Part, PartContext } from '../part';
import { medium, painter, plan_rings, radius_at } from '../rings';
import { fineness_of, sides, Tube } from '../tube';

/** The arm: skin, disks and base. Its shadow is in shadow.ts. */
export function make_arm(context: PartContext): Part[] {
  const { arm } = context.scene;
  if (!arm.visible) return [];
  const rings = plan_rings(arm);
  const few_rings = plan_rings(arm, painter(arm), medium);
  const thickest = rings.reduce((most, { radius }) => Math.max(most, radius), 0);
  // Close views need more rings and sides. Each tube is created on first use, and only the visible one is updated.
  const tubes: Tube[] = [];
  const tube_of = (level: number): Tube => (tubes[level] ??= new Tube(level > 0 ? rings : few_rings, sides[level]));
  let tube = tube_of(0);
  let samples: ArrayLike<number> | null = null;
  // Arms are dark, for the cameras. Their own colours are drawn in both themes: it is their gloss that shows the form.
  const skin = new Mesh(tube.geometry, new MeshPhongMaterial({ vertexColors: true, shininess: 28, specular: 0x24282c }));
  skin.frustumCulled = false;
  const group = new Group();
  group.add(skin);
  const disks = make_disks(arm.disks, arm.disk_color);
  if (disks) group.add(disks.mesh);
  return [
    {
      id: 'arm',
      label: 'Arm',
      group,
      draw(state: State) {
        samples = state.samples;
        tube.lay(samples);
        disks?.draw(state);
      },
      seen_from(eye, pixels) {
        if (!samples) return;
        const next = tube_of(fineness_of((pixels * thickest) / Math.max(thickest, distance_to(samples, eye))));
        if (next === tube) return;
        tube = next;
        tube.lay(samples);
        skin.geometry = tube.geometry;
      },
      dispose() {
        tubes.forEach((each) => each.dispose());
        (skin.material as MeshPhongMaterial).dispose();
        disks?.mesh.dispose();
      },
    },
    ...make_base(context),
  ];
}

/** Returns the distance to the nearest sample of the backbone. */
function distance_to(samples: ArrayLike<number>, { x, y, z }: Vector3): number {
  let square = Infinity;
  for (let i = 1; i + 2 < samples.length; i += sample_stride) {
    const dx = samples[i] - x;
    const dy = samples[i + 1] - y;
    const dz = samples[i + 2] - z;
    square = Math.min(square, dx * dx + dy * dy + dz * dz);
  }
  return Math.sqrt(square);
}

function make_disks(
  disks: { at: number; radius: number; thickness: number }[],
  color: [number, number, number],
): { mesh: InstancedMesh; draw(state: State): void } | null {
  if (!disks.length) return null;
  const geometry = new CylinderGeometry(1, 1, 1, 18).rotateX(Math.PI / 2);
  const mesh = new InstancedMesh(geometry, new MeshLambertMaterial({ color: new Color(...color) }), disks.length);
  mesh.frustumCulled = false;
  // As for the skin (tube.ts): a bounding sphere of the disks' former places would block clicks.
  mesh.boundingSphere = new Sphere(new Vector3(), Infinity);
  const arc = new Arc();
  const pose = new_pose();
  const matrix = new Matrix4();
  const place = new Vector3();
  const turn = new Quaternion();
  const size = new Vector3();
  return {
    mesh,
    draw({ samples }) {
      disks.forEach(({ at, radius, thickness }, i) => {
        const { interval, fraction } = locate(samples, at);
        arc.set(samples, interval).pose(fraction, pose);
        place.set(pose[0], pose[1], pose[2]);
        turn.set(pose[4], pose[5], pose[6], pose[3]);
        mesh.setMatrixAt(i, matrix.compose(place, turn, size.set(radius, radius, thickness)));
      });
      mesh.instanceMatrix.needsUpdate = true;
    },
  };
}

/** The socket of the arm. */
function make_base({ scene, span, theme }: PartContext): Part[] {
  const [x, y, z, qw, qx, qy, qz] = scene.arm.base;
  const radius = Math.max(radius_at(scene.arm, 0) * 1.9, 0.012 * span);
  const height = radius * 0.8;
  const geometry = new CylinderGeometry(radius * 0.82, radius, height, 28).rotateX(Math.PI / 2).translate(0, 0, -height / 2);
  const material = new MeshLambertMaterial({ color: theme === 'dark' ? 0x5b6b7a : 0x7c8a97 });
  const mesh = new Mesh(geometry, material);
  mesh.position.set(x, y, z);
  mesh.quaternion.set(qx, qy, qz, qw);
  return [{ id: 'base', label: 'Base', group: mesh, dispose: () => (geometry.dispose(), material.dispose()) }];
}
