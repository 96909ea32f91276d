// The rig's cameras as frusta with their pictures.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
  DoubleSide, LinearFilter, Matrix4, Vector3,
} from 'three';
import { camera_cx, camera_cy, camera_fx, camera_fy, camera_stride, sample_stride, type State } from '../../protocol/state';
import type { Part, PartContext } from '../part';
import { plain } from '../plain';

/** Distance of the picture in front of the camera, as a share of the distance to the arm's base. */
const depth_share = 0.35;
/** The pictures of long lenses are placed farther away to have at least this width, in lengths of the arm. */
const least_width = 0.3;
/** Opacity of a picture; it fades where it would hide the arm. */
const opacity = 0.92;
/** A picture is fully visible if its edge is at least this far from the arm, in picture widths. */
const clear = 0.12;
/** Texture width of pictures in the 3D view, px; more is not needed. */
const texture_width = 320;

export function make_cameras({ scene, span, theme }: PartContext): Part[] {
  const { base } = scene.arm;
  return scene.cameras.map(({ name, width, height }, index) => {
    const size = { width, height };
    const group = new Group();
    group.matrixAutoUpdate = false;
    const corners = new Float32Array(24 * 3);
    const edge_geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(corners, 3));
    const edges = new LineSegments(edge_geometry, plain(new LineBasicMaterial({ color: theme === 'dark' ? 0x6fb7ff : 0x1f6fc4 })));
    const plane = new Float32Array(4 * 3);
    const plane_geometry = new BufferGeometry()
      .setAttribute('position', new BufferAttribute(plane, 3))
      .setAttribute('uv', new BufferAttribute(new Float32Array([0, 1, 1, 1, 1, 0, 0, 0]), 2));
    plane_geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const canvas = document.createElement('canvas');
    canvas.width = Math.min(width, texture_width);
    canvas.height = Math.max(1, Math.round((canvas.width * height) / width));
    const texture = new CanvasTexture(canvas);
    texture.generateMipmaps = false;
    texture.minFilter = LinearFilter;
    const film = plain(new MeshBasicMaterial({ map: texture, side: DoubleSide, transparent: true, opacity }));
    const picture = new Mesh(plane_geometry, film);
    picture.visible = false;
    let has_picture = false;
    let is_inside = false;
    const seen: Hanging = { left: 0, right: 0, top: 0, bottom: 0, depth: 1 };
    const into_camera = new Matrix4();
    const from = new Vector3();
    const to = new Vector3();
    let samples: ArrayLike<number> = [];
    for (const object of [edges, picture]) object.frustumCulled = false;
    group.add(edges, picture);
    return {
      id: `camera ${name}`,
      label: `Camera “${name}”`,
      group,
      draw(state: State) {
        const at = index * camera_stride;
        const row = state.cameras;
        if (row.length < at + camera_stride) return;
        set_matrix(group, row, at);
        hang(row, at, size, base, span, seen);
        fill_frustum(corners, plane, seen.left, seen.right, seen.top, seen.bottom, seen.depth);
        edge_geometry.attributes.position.needsUpdate = true;
        plane_geometry.attributes.position.needsUpdate = true;
        into_camera.copy(group.matrix).invert();
        samples = state.samples;
      },
      picture(camera, shown) {
        if (camera !== name) return;
        has_picture = shown !== null;
        if (!shown) return;
        canvas.getContext('2d')?.drawImage(shown.bitmap, 0, 0, canvas.width, canvas.height);
        texture.needsUpdate = true;
      },
      inside: (camera) => {
        is_inside = camera === name;
        edges.visible = !is_inside;
      },
      seen_from(eye) {
        from.copy(eye).applyMatrix4(into_camera);
        let gap = Infinity;
        for (let i = 1; i + 2 < samples.length; i += sample_stride) {
          to.set(samples[i], samples[i + 1], samples[i + 2]).applyMatrix4(into_camera);
          gap = Math.min(gap, gap_between(seen, from, to));
        }
        film.opacity = opacity * Math.min(1, gap / clear);
        picture.visible = has_picture && !is_inside && film.opacity > 0;
      },
      dispose() {
        edge_geometry.dispose();
        plane_geometry.dispose();
        edges.material.dispose();
        film.dispose();
        texture.dispose();
      },
    } satisfies Part;
  });
}

/** Placement of a picture in its camera's frame, m. */
export interface Hanging {
  left: number;
  right: number;
  top: number;
  bottom: number;
  depth: number;
}

/**
 * Computes where the picture of the camera in a state's row is placed, given its size in pixels; fills and returns
 * `out`.
 */
export function hang(
  row: Float32Array, at: number, { width, height }: { width: number; height: number }, base: ArrayLike<number>, span: number, out: Hanging,
): Hanging {
  const left = (-0.5 - row[at + camera_cx]) / row[at + camera_fx];
  const right = (width - 0.5 - row[at + camera_cx]) / row[at + camera_fx];
  const far = Math.hypot(row[at] - base[0], row[at + 1] - base[1], row[at + 2] - base[2]);
  out.depth = Math.min(0.7 * far, Math.max(depth_share * far, (least_width * span) / (right - left)));
  out.left = left * out.depth;
  out.right = right * out.depth;
  out.top = ((-0.5 - row[at + camera_cy]) / row[at + camera_fy]) * out.depth;
  out.bottom = ((height - 0.5 - row[at + camera_cy]) / row[at + camera_fy]) * out.depth;
  return out;
}

/**
 * Returns how far beside a picture a point appears, in picture widths; eye and point are in the camera's frame. 0 if
 * the picture covers the point, Infinity if it is not between eye and point.
 */
export function gap_between({ left, right, top, bottom, depth }: Hanging, eye: Vector3, point: Vector3): number {
  const before = depth - eye.z;
  const behind = point.z - depth;
  if (!(before * behind > 0)) return Infinity;
  const f = before / (before + behind);
  const x = eye.x + f * (point.x - eye.x);
  const y = eye.y + f * (point.y - eye.y);
  return Math.hypot(Math.max(0, left - x, x - right), Math.max(0, top - y, y - bottom)) / (right - left);
}

function set_matrix(group: Group, row: Float32Array, at: number): void {
  group.position.set(row[at], row[at + 1], row[at + 2]);
  group.quaternion.set(row[at + 4], row[at + 5], row[at + 6], row[at + 3]);
  group.updateMatrix();
  group.matrixWorldNeedsUpdate = true;
}

/**
 * Fills in the lines of a frustum: four edges from the pupil, the picture's border, and a small roof at the upper side.
 */
function fill_frustum(
  lines: Float32Array, plane: Float32Array, l: number, r: number, t: number, b: number, d: number,
): void {
  let at = 0;
  const edge = (x0: number, y0: number, z0: number, x1: number, y1: number, z1: number): void => {
    lines[at++] = x0; lines[at++] = y0; lines[at++] = z0;
    lines[at++] = x1; lines[at++] = y1; lines[at++] = z1;
  };
  edge(0, 0, 0, l, t, d);
  edge(0, 0, 0, r, t, d);
  edge(0, 0, 0, r, b, d);
  edge(0, 0, 0, l, b, d);
  edge(l, t, d, r, t, d);
  edge(r, t, d, r, b, d);
  edge(r, b, d, l, b, d);
  edge(l, b, d, l, t, d);
  const roof = t - 0.16 * (b - t);
  const middle = (l + r) / 2;
  const w = (r - l) * 0.1;
  edge(middle - w, t, d, middle, roof, d);
  edge(middle, roof, d, middle + w, t, d);
  plane.set([l, t, d, r, t, d, r, b, d, l, b, d]);
}
