// Other arms beside the one that is there: desired, estimated, true shapes. Whoever sends `ghost` messages names and
// colours them.
import { Color, Group, Mesh, MeshLambertMaterial } from 'three';
import { Arc } from '../../math/arc';
import type { GhostMessage, Pose, SceneArm, Vector3 } from '../../protocol/types';
import type { Part, PartContext } from '../part';
import { plan_rings } from '../rings';
import { Tube } from '../tube';

interface Shown {
  message: GhostMessage;
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
      for (const id of [...shown.keys()]) if (shown.get(id)?.message !== messages[id]) remove(id);
      for (const [id, message] of Object.entries(messages)) {
        if (shown.has(id) || !message.poses || message.poses.length < 2) continue;
        const ghost = make_ghost(message, message.poses, scene.arm);
        shown.set(id, ghost);
        group.add(ghost.mesh);
      }
    },
    dispose: () => [...shown.keys()].forEach(remove),
  }];
}

function make_ghost(message: GhostMessage, poses: Pose[], arm: SceneArm): Shown {
  const color: Vector3 = [1, 1, 1];
  const tube = new Tube(plan_rings({ ...arm, markers: [], disks: [] }, () => color));
  tube.lay(samples_of(poses, arm.sections.reduce((sum, { length }) => sum + length, 0)));
  const mesh = new Mesh(tube.geometry, new MeshLambertMaterial({
    color: new Color(message.color ?? '#4dabf7'), transparent: true, opacity: 0.35, depthWrite: false,
  }));
  mesh.frustumCulled = false;
  return { message, tube, mesh };
}

/** Rows as in a state from poses alone: s by the arcs' lengths, scaled to the unstretched arm. */
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
