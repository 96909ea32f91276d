// Forces on the arm: the push by spring or force, and contact forces.
import { ConeGeometry, CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, Quaternion, SphereGeometry, Vector3 } from 'three';
import { Arc, locate, new_pose } from '../../math/arc';
import { contact_force, contact_point, contact_stride, push_force, push_to, type State } from '../../protocol/state';
import type { Part, PartContext } from '../part';
import { plain } from '../plain';

const colors = { dark: { push: 0xff8ad1, contact: 0xb9a2ff }, light: { push: 0xb8196f, contact: 0x5f3dc4 } };

/** Maximum number of drawn contacts. */
const most_contacts = 256;
/**
 * Sizes as shares of the arm's length: lines, marks, arrows without a spring, and the arrow of the largest contact
 * force.
 */
const line = 0.0045;
const mark = 0.011;
const arrow = 0.18;
const longest = 0.3;

/** Returns the end of a force scale: 1, 2 or 5 times a power of ten. */
export function scale_end(force: number): number {
  if (!(force > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(force));
  return [1, 2, 5, 10].map((step) => step * power).find((end) => end >= force * (1 - 1e-6)) ?? 10 * power;
}

/** The forces are visible through the arm, as the tendons are. */
export function make_forces({ scene, span, theme }: PartContext): Part[] {
  if (!scene.arm.elastic) return [];
  const along = new Vector3(0, 1, 0);
  const [from, way, middle, size] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
  const turn = new Quaternion();
  const matrix = new Matrix4();
  const shaft = new CylinderGeometry(1, 1, 1, 8, 1, true);
  const head = new ConeGeometry(1, 1, 12);
  const ball = new SphereGeometry(1, 14, 10);
  const colored = (color: number): MeshBasicMaterial => plain(new MeshBasicMaterial({ color, depthTest: false, transparent: true }));
  const push_color = colored(colors[theme].push);
  const contact_color = colored(colors[theme].contact);
  const drawn = <M extends Mesh>(mesh: M): M => {
    mesh.frustumCulled = false;
    mesh.renderOrder = 8;
    // Clicks belong to the arm.
    mesh.raycast = () => {};
    return mesh;
  };
  const rod = drawn(new Mesh(shaft, push_color));
  const tip = drawn(new Mesh(head, push_color));
  const point = drawn(new Mesh(ball, push_color));
  const push = new Group().add(rod, tip, point);
  const many = (geometry: ConstructorParameters<typeof InstancedMesh>[0]): InstancedMesh => {
    const mesh = drawn(new InstancedMesh(geometry, contact_color, most_contacts));
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.count = 0;
    return mesh;
  };
  const [shafts, heads, marks] = [many(shaft), many(head), many(ball)];
  const group = new Group().add(push, shafts, heads, marks);
  const arc = new Arc();
  const pose = new_pose();
  // The scale is kept as long as possible, so that arrows can be compared over time.
  let scale = 0;

  const draw_push = (state: State): void => {
    push.visible = Boolean(state.push);
    if (!state.push) return;
    const { interval, fraction } = locate(state.samples, state.push[0]);
    arc.set(state.samples, interval).pose(fraction, pose);
    from.set(pose[0], pose[1], pose[2]);
    way.set(state.push[push_to], state.push[push_to + 1], state.push[push_to + 2]).sub(from);
    if (way.length() < 1e-6) {
      way.set(state.push[push_force], state.push[push_force + 1], state.push[push_force + 2]);
      if (way.length() > 0) way.setLength(arrow * span);
    }
    point.position.copy(from);
    point.scale.setScalar(1.3 * mark * span);
    const length = way.length();
    rod.visible = tip.visible = length > 1e-6;
    if (!rod.visible) return;
    const end = Math.min(0.045 * span, 0.5 * length);
    way.divideScalar(length);
    turn.setFromUnitVectors(along, way);
    rod.quaternion.copy(turn);
    tip.quaternion.copy(turn);
    rod.scale.set(line * span, length - end, line * span);
    rod.position.copy(from).addScaledVector(way, (length - end) / 2);
    tip.scale.set(0.4 * end, end, 0.4 * end);
    tip.position.copy(from).addScaledVector(way, length - end / 2);
  };

  const draw_contacts = (contacts: Float32Array | undefined): void => {
    const count = Math.min(most_contacts, (contacts?.length ?? 0) / contact_stride);
    shafts.count = heads.count = marks.count = count;
    if (!contacts || !count) return;
    let most = 0;
    for (let i = 0; i < count; ++i) {
      const at = contact_stride * i + contact_force;
      most = Math.max(most, Math.hypot(contacts[at], contacts[at + 1], contacts[at + 2]));
    }
    if (most > scale || most < scale / 5) scale = scale_end(most);
    for (let i = 0; i < count; ++i) {
      const at = contact_stride * i;
      from.set(contacts[at + contact_point], contacts[at + contact_point + 1], contacts[at + contact_point + 2]);
      way.set(contacts[at + contact_force], contacts[at + contact_force + 1], contacts[at + contact_force + 2]);
      const length = (longest * span * way.length()) / scale;
      if (way.length() > 0) way.normalize();
      else way.copy(along);
      turn.setFromUnitVectors(along, way);
      // The direction must be visible for small forces too.
      const end = Math.min(0.04 * span, 0.6 * length);
      size.set(line * span, Math.max(1e-9, length - end), line * span);
      shafts.setMatrixAt(i, matrix.compose(middle.copy(from).addScaledVector(way, (length - end) / 2), turn, size));
      size.set(0.4 * end, Math.max(1e-9, end), 0.4 * end);
      heads.setMatrixAt(i, matrix.compose(middle.copy(from).addScaledVector(way, length - end / 2), turn, size));
      size.setScalar(mark * span);
      marks.setMatrixAt(i, matrix.compose(from, turn, size));
    }
    shafts.instanceMatrix.needsUpdate = heads.instanceMatrix.needsUpdate = marks.instanceMatrix.needsUpdate = true;
  };

  push.visible = false;
  return [{
    id: 'forces',
    label: 'Pushes and contact forces',
    group,
    draw(state: State) {
      draw_push(state);
      draw_contacts(state.contacts);
    },
    dispose() {
      for (const mesh of [shafts, heads, marks]) mesh.dispose();
      for (const geometry of [shaft, head, ball]) geometry.dispose();
      push_color.dispose();
      contact_color.dispose();
    },
  }];
}
