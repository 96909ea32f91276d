// Interactive marks: the tip's handle, its target while it is dragged, and the picked point.
import {
  Group, type Object3D, Mesh, MeshBasicMaterial, SphereGeometry, TorusGeometry,
} from 'three';
import { Arc, locate, new_pose } from '../../math/arc';
import { sample_stride, type State } from '../../protocol/state';
import type { Vector3 } from '../../protocol/types';
import { dispose_tree, type Part, type PartContext } from '../part';
import { radius_at, total_length } from '../rings';

export interface Handles extends Part {
  set_goal(goal: Vector3 | null, reached: boolean): void;
  set_picked(s: number | null): void;
}

export function make_handles({ scene, span }: PartContext): Handles {
  const { arm } = scene;
  const group = new Group();
  const size = Math.max(1.25 * radius_at(arm, total_length(arm), true), 0.014 * span);
  const tip = glow(new SphereGeometry(size, 18, 10), 0x36c5b4, 0.5);
  const goal = glow(new SphereGeometry(0.8 * size, 18, 10), 0xffffff, 0.75);
  const ring = glow(new TorusGeometry(1, 0.14, 6, 28), 0xff4fa3, 1);
  goal.visible = ring.visible = false;
  group.add(tip, goal, ring);
  const arc = new Arc();
  const pose = new_pose();
  let picked: number | null = null;
  const goal_color = (goal as Mesh).material as MeshBasicMaterial;
  return {
    id: 'handles',
    label: 'Handle of the tip',
    group,
    draw({ samples }: State) {
      const last = samples.length - sample_stride + 1;
      tip.position.set(samples[last], samples[last + 1], samples[last + 2]);
      if (picked === null) return;
      const { interval, fraction } = locate(samples, picked);
      arc.set(samples, interval).pose(fraction, pose);
      ring.position.set(pose[0], pose[1], pose[2]);
      ring.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
    },
    set_goal(at, reached) {
      goal.visible = at !== null;
      if (at) goal.position.set(...at);
      goal_color.color.set(reached ? 0x36c5b4 : 0xff6b6b);
    },
    set_picked(s) {
      picked = s;
      ring.visible = s !== null;
      if (s !== null) ring.scale.setScalar(Math.max(1.25 * radius_at(arm, s), 0.012 * span));
    },
    dispose: () => dispose_tree(group),
  };
}

/** Creates an unlit object that is visible through the arm. */
function glow(geometry: SphereGeometry | TorusGeometry, color: number, opacity: number): Object3D {
  const material = new MeshBasicMaterial({ color, opacity, transparent: true, depthTest: false, depthWrite: false });
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = 10;
  mesh.frustumCulled = false;
  return mesh;
}
