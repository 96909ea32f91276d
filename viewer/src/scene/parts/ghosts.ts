// Additional arms: target, estimated and true shapes. The sender of `ghost` messages chooses their ids and colours. They
// are outlines: bright where the skin turns away from the eye, nearly clear elsewhere, so that the arm is seen in them.
import { BufferAttribute, Color, DynamicDrawUsage, Group, Mesh, ShaderMaterial } from 'three';
import { Arc, new_pose, sample_count } from '../../math/arc';
import { sample_stride, type State } from '../../protocol/state';
import type { GhostMessage, Pose, SceneArm, Vector3 } from '../../protocol/types';
import type { Part, PartContext } from '../part';
import { eye_of } from '../../overlays/extras';
import { medium, plan_rings, total_length, type Ring } from '../rings';
import { sides, Tube } from '../tube';

/** The ids of the ghosts that show where the arm truly is. They are clear where the drawn arm is there too. */
const true_ids = ['truth', eye_of('truth')];
/** Opacity of a ghost's middle, and of its outline. */
const [clear, solid] = [0.1, 0.85];

interface Shown {
  message: GhostMessage | null;
  tube: Tube;
  mesh: Mesh;
  rings: Ring[];
  samples: Float32Array;
  /** Distance of each corner's ring from the drawn arm, m. */
  away: BufferAttribute;
  is_true: boolean;
}

export function make_ghosts({ scene }: PartContext): Part[] {
  const group = new Group();
  const shown = new Map<string, Shown>();
  let arm_samples: ArrayLike<number> | null = null;
  const remove = (id: string): void => {
    const old = shown.get(id);
    if (!old) return;
    group.remove(old.mesh);
    old.tube.dispose();
    (old.mesh.material as ShaderMaterial).dispose();
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
        const ghost = shown.get(id) ?? make_ghost(scene.arm, true_ids.includes(id));
        lay(ghost, message, scene.arm);
        if (ghost.is_true && arm_samples) measure(ghost, arm_samples);
        if (!shown.has(id)) group.add(ghost.mesh);
        shown.set(id, ghost);
      }
    },
    draw({ samples }: State) {
      arm_samples = samples;
      for (const ghost of shown.values()) if (ghost.is_true) measure(ghost, samples);
    },
    seen_from(_, pixels) {
      for (const { mesh } of shown.values()) (mesh.material as ShaderMaterial).uniforms.pixels.value = pixels;
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

const vertex_shader = `
attribute float away;
uniform float pixels;
varying vec3 n;
varying vec3 ray;
varying float off;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  n = normalMatrix * normal;
  ray = at.xyz;
  off = away * pixels / max(1e-9, -at.z);
  gl_Position = projectionMatrix * at;
}`;

const fragment_shader = `
uniform vec3 color;
uniform float clear;
uniform float solid;
varying vec3 n;
varying vec3 ray;
varying float off;
void main() {
  if (off < 1.0) discard;
  float facing = abs(dot(normalize(n), normalize(ray)));
  gl_FragColor = vec4(color, mix(solid, clear, smoothstep(0.35, 0.75, facing)));
}`;

function make_ghost(arm: SceneArm, is_true: boolean): Shown {
  const color: Vector3 = [1, 1, 1];
  const rings = plan_rings({ ...arm, markers: [], disks: [] }, () => color, medium);
  const tube = new Tube(rings, ghost_sides);
  const away = new BufferAttribute(new Float32Array(rings.length * (ghost_sides + 1)).fill(1e9), 1).setUsage(DynamicDrawUsage);
  tube.geometry.setAttribute('away', away);
  const material = new ShaderMaterial({
    uniforms: { color: { value: new Color() }, pixels: { value: 1 }, clear: { value: clear }, solid: { value: solid } },
    vertexShader: vertex_shader,
    fragmentShader: fragment_shader,
    transparent: true,
    depthWrite: false,
  });
  const mesh = new Mesh(tube.geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = 4;
  return { message: null, tube, mesh, rings, samples: new Float32Array(0), away, is_true };
}

const ghost_sides = sides[1];

function lay(ghost: Shown, message: Shaped, arm: SceneArm): void {
  ghost.message = message;
  ghost.samples = samples_of(message.poses, total_length(arm));
  ghost.tube.lay(ghost.samples);
  (ghost.mesh.material as ShaderMaterial).uniforms.color.value.set(message.color ?? '#4dabf7').convertLinearToSRGB();
}

const [ghost_arc, arm_arc] = [new Arc(), new Arc()];
const [ghost_pose, arm_pose] = [new_pose(), new_pose()];

/**
 * Computes how far each ring of the ghost is beside the drawn arm, and its tip from the arm's. Along the arm, places of
 * equal s may differ where both are stretched otherwise.
 */
function measure({ rings, samples, away }: Shown, arm: ArrayLike<number>): void {
  const around = away.count / rings.length;
  const values = away.array as Float32Array;
  const last = rings[rings.length - 1].s;
  for (let r = 0, i = 0, j = 0; r < rings.length; ++r) {
    const { s } = rings[r];
    i = to_pose(samples, s, i, ghost_arc, ghost_pose);
    j = to_pose(arm, s, j, arm_arc, arm_pose);
    const [x, y, z] = [ghost_pose[0] - arm_pose[0], ghost_pose[1] - arm_pose[1], ghost_pose[2] - arm_pose[2]];
    const [, , , w, a, b, c] = arm_pose;
    const along = s < last ? x * 2 * (a * c + w * b) + y * 2 * (b * c - w * a) + z * (1 - 2 * (a * a + b * b)) : 0;
    values.fill(Math.sqrt(Math.max(0, x * x + y * y + z * z - along * along)), r * around, (r + 1) * around);
  }
  away.needsUpdate = true;
}

/** Computes the pose at s, whose interval is not before `from`; returns its interval. */
function to_pose(samples: ArrayLike<number>, s: number, from: number, arc: Arc, pose: Float64Array): number {
  let at = from;
  while (at < sample_count(samples) - 2 && s > samples[(at + 1) * sample_stride]) ++at;
  const [start, end] = [samples[at * sample_stride], samples[(at + 1) * sample_stride]];
  arc.set(samples, at).pose(end > start ? Math.min(1, Math.max(0, (s - start) / (end - start))) : 0, pose);
  return at;
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
