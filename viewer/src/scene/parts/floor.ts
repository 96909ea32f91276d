import {
  BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry,
  Quaternion, Vector3,
} from 'three';
import type { Label, Part, PartContext } from '../part';
import { dispose_tree } from '../part';
import { plain } from '../plain';

const colors = {
  dark: { plate: 0x2a363f, line: 0x3d4c58, bar: 0xdbe5ec, x: 0xff6b6b, y: 0x69db7c, z: 0x74a9ff },
  light: { plate: 0xe4e9ee, line: 0xc3ccd4, bar: 0x33424f, x: 0xc92a2a, y: 0x1f6b2e, z: 0x1c5fd0 },
};

/** Edge length of the axes, as a share of the arm's length, and where their letters are. */
const [axis_share, letter_share] = [0.18, 0.205];
/** Distance of the scale from the base, as a share of the arm's length. */
const scale_share = 0.62;
/** From how far away of the world's origin the base has axes of its own, in lengths of the arm. */
const apart = 0.05;

/** Half the floor's width, in lengths of the arm: at least, and at most if screens stand farther away. */
const [least_half, most_half] = [1.6, 3];

function half_floor({ arm: { base }, screens }: PartContext['scene'], span: number): number {
  const feet = screens.map(({ pose }) => Math.max(Math.abs(pose[0] - base[0]), Math.abs(pose[2] - base[2])));
  return Math.min(most_half * span, Math.max(least_half * span, ...feet));
}

/** Returns a round number of metres that gives about ten squares along the arm. */
export function grid_step(span: number): number {
  const rough = span / 8;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= rough) ?? rough;
}

/**
 * The floor with its grid and the scale of its squares, and the axes of the world: X red, Y green, Z blue. A base that
 * stands elsewhere has axes of its own: x and y across the arm, z along it.
 */
export function make_floor({ span, floor, theme, scene }: PartContext): Part[] {
  const { base } = scene.arm;
  const step = grid_step(span);
  const half = Math.ceil(half_floor(scene, span) / step);
  const middle_x = Math.round(base[0] / step) * step;
  const middle_z = Math.round(base[2] / step) * step;
  const points: number[] = [];
  for (let i = -half; i <= half; ++i) {
    points.push(i * step, 0, -half * step, i * step, 0, half * step);
    points.push(-half * step, 0, i * step, half * step, 0, i * step);
  }
  const grid = lines(points, colors[theme].line);
  grid.position.y = floor - 2e-4 * span;
  // Seen from above only: from below it would hide the arm. It lies below the grid and the shadow.
  const plate = new Mesh(
    new PlaneGeometry(2 * half * step, 2 * half * step).rotateX(-Math.PI / 2),
    plain(new MeshBasicMaterial({ color: colors[theme].plate, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 })),
  );
  plate.position.y = floor - 5e-4 * span;
  // After what stands on it: what is hidden costs nothing.
  plate.renderOrder = 50;
  const ground = new Group().add(plate, grid);
  ground.position.set(middle_x, 0, middle_z);

  const size = (at: number): number => at * span;
  const ends = new BufferAttribute(new Float32Array(3 * 4 * 3), 3).setUsage(DynamicDrawUsage);
  const geometry = new BufferGeometry().setAttribute('position', ends);
  geometry.setIndex([0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7, 8, 9, 10, 10, 9, 11]);
  const bar = new Mesh(geometry, plain(new MeshBasicMaterial({ color: colors[theme].bar, side: DoubleSide })));
  bar.frustumCulled = false;
  bar.raycast = () => {};
  const label: Label = { kind: 'scale', text: format_step(step), at: new Vector3() };
  let side = -1;
  const lay_scale = (nearest: number): void => {
    side = nearest;
    const away = Math.round(size(scale_share) / step) * step;
    // The bar is the edge of the square nearest to the eye, in the middle of that side.
    const [x, z] = [[0, away], [away, 0], [0, -away], [-away, 0]][side];
    const across = side % 2 === 0;
    const [ax, az] = [middle_x + x, middle_z + z];
    const put = (at: number, from: number, to: number, width: number): void => {
      for (const [i, [along, beside]] of [[from, -width], [to, -width], [from, width], [to, width]].entries()) {
        ends.setXYZ(at + i, ax + (across ? along : beside), floor + 1e-4 * span, az + (across ? beside : along));
      }
    };
    put(0, 0, step, 0.035 * step);
    put(4, -0.03 * step, 0.03 * step, 0.15 * step);
    put(8, 0.97 * step, 1.03 * step, 0.15 * step);
    ends.needsUpdate = true;
    label.at.set(ax + (across ? step / 2 : 0), floor, az + (across ? 0 : step / 2));
  };
  lay_scale(0);

  const { axes, letters } = axes_of(span, theme, 'XYZ');
  const parts: Part[] = [
    {
      id: 'grid',
      label: `Floor, squares of ${format_step(step)}`,
      group: ground,
      // A camera sees through the floor: its picture has none.
      inside: (camera) => (plate.visible = camera === null),
      dispose: () => dispose_tree(ground),
    },
    {
      id: 'scale',
      label: 'Scale on the floor',
      group: bar,
      labels: [label],
      seen_from(eye) {
        const [x, z] = [eye.x - middle_x, eye.z - middle_z];
        const is_along_z = Math.abs(z) >= Math.abs(x);
        const nearest = (is_along_z ? 0 : 1) + ((is_along_z ? z : x) >= 0 ? 0 : 2);
        if (nearest !== side) lay_scale(nearest);
      },
      dispose: () => dispose_tree(bar),
    },
    { id: 'axes', label: 'World axes', group: axes, labels: letters, dispose: () => dispose_tree(axes) },
  ];
  if (Math.hypot(base[0], base[1], base[2]) > apart * span) {
    const own = axes_of(0.8 * span, theme, 'xyz');
    own.axes.position.set(base[0], base[1], base[2]);
    own.axes.quaternion.set(base[4], base[5], base[6], base[3]);
    for (const { at } of own.letters) at.applyQuaternion(new Quaternion(base[4], base[5], base[6], base[3])).add(own.axes.position);
    parts.push({ id: 'base axes', label: 'Axes of the base', group: own.axes, labels: own.letters, dispose: () => dispose_tree(own.axes) });
  }
  return parts;
}

/** Three coloured lines from the origin, and the places of their letters. */
function axes_of(span: number, theme: PartContext['theme'], names: string): { axes: Group; letters: Label[] } {
  const { x, y, z } = colors[theme];
  const axes = new Group();
  const letters = [x, y, z].map((color, i): Label => {
    const along = [0, 0, 0];
    along[i] = 1;
    axes.add(lines([0, 0, 0, ...along.map((each) => each * axis_share * span)], color));
    return { kind: 'xyz'[i], text: names[i], at: new Vector3(...along).multiplyScalar(letter_share * span) };
  });
  return { axes, letters };
}

/** Formats the edge of a square: "10 cm", "2 m". */
export function format_step(step: number): string {
  if (step >= 0.1) return `${+step.toPrecision(2)} m`;
  return step >= 0.01 ? `${+(step * 100).toPrecision(2)} cm` : `${+(step * 1000).toPrecision(2)} mm`;
}

export function lines(points: number[], color: number, opacity = 1): LineSegments {
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  return new LineSegments(geometry, plain(new LineBasicMaterial({ color, opacity, transparent: opacity < 1 })));
}
