import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments } from 'three';
import type { Part, PartContext } from '../part';
import { dispose_tree } from '../part';
import { plain } from '../plain';

/** Returns a round number of metres that gives about ten squares along the arm. */
export function grid_step(span: number): number {
  const rough = span / 8;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= rough) ?? rough;
}

/** The floor's grid, and the axes of the world: X red, Y green, Z blue. */
export function make_floor({ span, floor, theme, scene }: PartContext): Part[] {
  const step = grid_step(span);
  const half = Math.ceil((1.6 * span) / step);
  const middle_x = Math.round(scene.arm.base[0] / step) * step;
  const middle_z = Math.round(scene.arm.base[2] / step) * step;
  const points: number[] = [];
  for (let i = -half; i <= half; ++i) {
    points.push(i * step, 0, -half * step, i * step, 0, half * step);
    points.push(-half * step, 0, i * step, half * step, 0, i * step);
  }
  const grid = lines(points, theme === 'dark' ? 0x2b3946 : 0xc2ccd5);
  grid.position.set(middle_x, floor - 1e-3 * span, middle_z);
  const axes = new Group();
  const length = 0.18 * span;
  axes.add(lines([0, 0, 0, length, 0, 0], theme === 'dark' ? 0xff6b6b : 0xc92a2a));
  axes.add(lines([0, 0, 0, 0, length, 0], theme === 'dark' ? 0x69db7c : 0x2b8a3e));
  axes.add(lines([0, 0, 0, 0, 0, length], theme === 'dark' ? 0x74a9ff : 0x1c5fd0));
  return [
    { id: 'grid', label: `Floor, squares of ${format_step(step)}`, group: grid, dispose: () => dispose_tree(grid) },
    { id: 'axes', label: 'World axes', group: axes, dispose: () => dispose_tree(axes) },
  ];
}

function format_step(step: number): string {
  if (step >= 1) return `${+step.toPrecision(2)} m`;
  return step >= 0.01 ? `${+(step * 100).toPrecision(2)} cm` : `${+(step * 1000).toPrecision(2)} mm`;
}

export function lines(points: number[], color: number, opacity = 1): LineSegments {
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  return new LineSegments(geometry, plain(new LineBasicMaterial({ color, opacity, transparent: opacity < 1 })));
}
