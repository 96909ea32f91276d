// Additional arms: target, estimated and true shapes. The sender of `ghost` messages chooses their ids and colours.
import { Color, Group, Mesh, MeshLambertMaterial } from 'three';
import { Arc } from '../../math/arc';
import type { GhostMessage, Pose, SceneArm, Vector3 } from '../../protocol/types';
import type { Part, PartContext } from '../part';
import { plan_rings } from '../rings';
import { Tube } from '../tube';

interface Shown {
  message: GhostMessage | null;
  tube: Tube;
  mesh: Mesh;
}

export function make_ghosts({ scene }: PartContext): Part[] {
  const group = new Group();
  const shown = new Map<string, Shown>();
  const remove = (id: string): void => {
    const old = shown.get(id);
    if (!old) return;
    group.remove(old.mesh);
    old.tube.dispose();
    (old.mesh.material as MeshLambertMaterial).dispose();
    shown.delete(id);
  };
  return [{
    id: 'ghosts',
    label: 'Ghosts',
    group,
    ghosts(messages) {
      for (const id of [...shown.keys()]) if (!has_shape(messages[id])) remove(id);
      for (const [id, message] of Object.entries(messages)) {
        if (!has_shape(message) || shown.get(id)?.message === message) continue;
        // A moving ghost keeps its skin, because its shape changes with each picture.
        const ghost = shown.get(id) ?? make_ghost(scene.arm);
        lay(ghost, message, scene.arm);
        if (!shown.has(id)) group.add(ghost.mesh);
        shown.set(id, ghost);
      }
    },
    dispose: () => [...shown.keys()].forEach(remove),
  }];
}

interface Shaped extends GhostMessage {
  poses: Pose[];
}

function has_shape(message: GhostMessage | undefined): message is Shaped {
  return (message?.poses?.length ?? 0) > 1;
}

function make_ghost(arm: SceneArm): Shown {
  const color: Vector3 = [1, 1, 1];
  const tube = new Tube(plan_rings({ ...arm, markers: [], disks: [] }, () => color));
  const mesh = new Mesh(tube.geometry, new MeshLambertMaterial({ transparent: true, opacity: 0.35, depthWrite: false }));
  mesh.frustumCulled = false;
  return { message: null, tube, mesh };
}

function lay(ghost: Shown, message: Shaped, arm: SceneArm): void {
  ghost.message = message;
  ghost.tube.lay(samples_of(message.poses, arm.sections.reduce((sum, { length }) => sum + length, 0)));
  (ghost.mesh.material as MeshLambertMaterial).color = new Color(message.color ?? '#4dabf7');
}

/** Computes sample rows from poses: s by the arcs' lengths, scaled to the unstretched arm. */
export function samples_of(poses: Pose[], total: number): Float32Array {
  const rows = new Float32Array(poses.length * 8);
  poses.forEach((pose, i) => rows.set(pose, 8 * i + 1));
  const arc = new Arc();
  let s = 0;
  for (let i = 1; i < poses.length; ++i) {
    s += arc.set(rows, i - 1).length;
    rows[8 * i] = s;
  }
  for (let i = 1; i < poses.length; ++i) rows[8 * i] *= total / s;
  return rows;
}
