// Tendons along the arm, coloured by tension.
import { Color, CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from 'three';
import { Arc, new_pose, rotate } from '../../math/arc';
import { actuator_force, actuator_stride, sample_stride, type State } from '../../protocol/state';
import type { Vector3 as Point } from '../../protocol/types';
import type { Part, PartContext } from '../part';
import { plain } from '../plain';

/** Colours from low to high tension, and of slack tendons. */
const colors = {
  dark: { slack: shown(0x8796a5), low: shown(0xffe08a), high: shown(0xff4136) },
  light: { slack: shown(0x9aa8b5), low: shown(0xf5c518), high: shown(0xe8281d) },
};

/** Converts a colour for plain materials. */
function shown(color: number): Color {
  return new Color(color).convertLinearToSRGB();
}

/** Share of the arm's length; thicker than in reality, to be visible. */
const thickness = 0.0045;

/** The tendons are visible through the arm, in which most of them run. Not drawn if tensions are unknown. */
export function make_tendons({ scene, span, theme }: PartContext): Part[] {
  const routes = scene.arm.tendons ?? [];
  if (!routes.length) return [];
  const pieces = routes.reduce((sum, route) => sum + route.length - 1, 0);
  const material = plain(new MeshBasicMaterial({ depthTest: false, transparent: true }));
  const rods = new InstancedMesh(new CylinderGeometry(1, 1, 1, 5, 1, true), material, pieces);
  rods.instanceMatrix.setUsage(DynamicDrawUsage);
  rods.frustumCulled = false;
  rods.renderOrder = 5;
  rods.visible = false;
  // Clicks belong to the arm.
  rods.raycast = () => {};
  const group = new Group().add(rods);
  const { slack, low, high } = colors[theme];
  const arc = new Arc();
  const pose = new_pose();
  const offset = new Float64Array(3);
  const mixed = new Color();
  const [before, here, way, middle, size] = [new Vector3(), new Vector3(), new Vector3(), new Vector3(), new Vector3()];
  const along = new Vector3(0, 1, 0);
  const turn = new Quaternion();
  const matrix = new Matrix4();

  // Draws a rod from each point to the next; returns the index of the next tendon's first rod.
  const lay = (samples: Float32Array, route: Point[], from: number): number => {
    const last = samples.length / sample_stride - 2;
    let at = from;
    for (let i = 0, interval = 0; i < route.length; ++i) {
      const s = route[i][0];
      while (interval < last && samples[sample_stride * (interval + 1)] <= s) ++interval;
      const start = samples[sample_stride * interval];
      arc.set(samples, interval).pose(Math.min(1, (s - start) / (samples[sample_stride * (interval + 1)] - start)), pose);
      rotate(pose, route[i][1], route[i][2], 0, offset);
      here.set(pose[0] + offset[0], pose[1] + offset[1], pose[2] + offset[2]);
      if (i > 0) {
        way.subVectors(here, before);
        size.set(thickness * span, way.length(), thickness * span);
        turn.setFromUnitVectors(along, way.normalize());
        rods.setMatrixAt(at, matrix.compose(middle.addVectors(before, here).multiplyScalar(0.5), turn, size));
        rods.setColorAt(at++, mixed);
      }
      before.copy(here);
    }
    return at;
  };

  return [{
    id: 'tendons',
    label: 'Tendons, by their tension',
    group,
    draw({ samples, actuators }: State) {
      rods.visible = actuators.length === actuator_stride * routes.length;
      if (!rods.visible) return;
      let most = 1;
      for (let i = 0; i < routes.length; ++i) most = Math.max(most, actuators[actuator_stride * i + actuator_force]);
      // Tendons under tension are drawn over slack ones.
      let at = 0;
      mixed.copy(slack);
      for (let i = 0; i < routes.length; ++i) {
        if (!(actuators[actuator_stride * i + actuator_force] > 0)) at = lay(samples, routes[i], at);
      }
      for (let i = 0; i < routes.length; ++i) {
        const force = actuators[actuator_stride * i + actuator_force];
        if (force > 0) {
          mixed.copy(low).lerp(high, force / most);
          at = lay(samples, routes[i], at);
        }
      }
      rods.instanceMatrix.needsUpdate = true;
      if (rods.instanceColor) rods.instanceColor.needsUpdate = true;
    },
    dispose() {
      rods.geometry.dispose();
      rods.dispose();
      material.dispose();
    },
  }];
}
