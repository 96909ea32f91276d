// Objects around the arm: screens, the calibration cylinder, obstacles.
import {
  BoxGeometry, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry, Group, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, type Object3D, Quaternion, SphereGeometry, Vector3,
} from 'three';
import type { Pose, SceneEtalon, SceneObstacle, SceneScreen } from '../../protocol/types';
import { dispose_tree, type Part, type PartContext } from '../part';
import { plain } from '../plain';
import { lines } from './floor';

export function make_stand(context: PartContext): Part[] {
  const { scene } = context;
  const parts: Part[] = scene.screens.map((screen, i) =>
    make_screen(`screen ${i + 1}`, scene.screens.length > 1 ? `Screen ${i + 1}` : 'Screen', screen, context),
  );
  if (scene.etalon) parts.push(part('etalon', 'Calibration cylinder', etalon_of(scene.etalon)));
  for (const obstacle of scene.obstacles) {
    parts.push(part(`obstacle ${obstacle.name}`, `Obstacle “${obstacle.name}”`, obstacle_of(obstacle, context)));
  }
  return parts;
}

function part(id: string, label: string, group: Object3D): Part {
  return { id, label, group, dispose: () => dispose_tree(group) };
}

function stand_at(object: Object3D, [x, y, z, qw, qx, qy, qz]: Pose): void {
  object.position.set(x, y, z);
  object.quaternion.set(qx, qy, qz, qw);
}

/** Light of a screen's front in the dark theme, where a truly bright one would dazzle: enough for the arm to stand out. */
const dimmed = new Color(0x71808d);

/**
 * A screen: bright on its front; only its edges are visible from behind, so that it never hides the arm. It is opaque,
 * because blending a large area is slow in software renderers. What is below the floor is left out, except for the
 * cameras, which see no floor.
 */
function make_screen(id: string, label: string, { pose, size, brightness }: SceneScreen, { theme, floor }: PartContext): Part {
  const group = new Group();
  stand_at(group, pose);
  group.updateMatrixWorld();
  const level = Math.min(1, Math.max(0.2, brightness));
  const color = theme === 'dark' ? dimmed.clone().multiplyScalar(0.4 + 0.6 * level) : new Color(1, 1, 1.03).multiplyScalar(0.75 + 0.25 * level);
  // Offset in depth, so that the edges lie on it.
  const front = plain(new MeshBasicMaterial({ color, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
  const [w, h] = [size[0] / 2, size[1] / 2];
  const corners = [[-w, -h], [w, -h], [w, h], [-w, h]].map(([x, y]) => new Vector3(x, y, 0));
  const shape = (outline: Vector3[]): Object3D => {
    const sheet = new Group();
    if (outline.length < 3) return sheet;
    const geometry = new BufferGeometry().setFromPoints(outline);
    geometry.setIndex(outline.slice(2).flatMap((_, i) => [0, i + 1, i + 2]));
    const border = outline.flatMap(({ x, y }, i) => {
      const next = outline[(i + 1) % outline.length];
      return [x, y, 0, next.x, next.y, 0];
    });
    return sheet.add(new Mesh(geometry, front), lines(border, theme === 'dark' ? 0x8da0b0 : 0x8793a0));
  };
  const [whole, above] = [shape(corners), shape(cut(corners, (point) => group.localToWorld(point.clone()).y - floor))];
  whole.visible = false;
  group.add(whole, above);
  return {
    id,
    label,
    group,
    inside(camera) {
      whole.visible = camera !== null;
      above.visible = camera === null;
    },
    dispose: () => dispose_tree(group),
  };
}

/** Returns the part of a convex outline in which `height` is not negative. */
export function cut(outline: Vector3[], height: (point: Vector3) => number): Vector3[] {
  return outline.flatMap((point, i) => {
    const next = outline[(i + 1) % outline.length];
    const [here, there] = [height(point), height(next)];
    const crossing = here * there < 0 ? [point.clone().lerp(next, here / (here - there))] : [];
    return here >= 0 ? [point, ...crossing] : crossing;
  });
}

/** A cylinder along its own y with four lines, a quarter turn apart, the first towards its z. */
function etalon_of({ pose, radius, height, line_width, color, line_color }: SceneEtalon): Object3D {
  const group = new Group();
  group.add(new Mesh(
    new CylinderGeometry(radius, radius, height, 36),
    new MeshLambertMaterial({ color: new Color(...color) }),
  ));
  const angle = line_width / radius;
  const material = new MeshLambertMaterial({ color: new Color(...line_color) });
  for (let i = 0; i < 4; ++i) {
    const start = (i * Math.PI) / 2 - angle / 2;
    // Slightly larger than the cylinder, because the lines are painted on it.
    const strip = new CylinderGeometry(radius * 1.002, radius * 1.002, height, 4, 1, true, start, angle);
    group.add(new Mesh(strip, material));
  }
  stand_at(group, pose);
  return group;
}

function obstacle_of(obstacle: SceneObstacle, { span, theme }: PartContext): Object3D {
  const color = theme === 'dark' ? 0xd08a3e : 0xc77a22;
  const solid = new MeshLambertMaterial({ color });
  switch (obstacle.kind) {
    case 'sphere': {
      const mesh = new Mesh(new SphereGeometry(obstacle.radius, 28, 16), solid);
      mesh.position.set(...obstacle.center);
      return mesh;
    }
    case 'box': {
      const [x, y, z] = obstacle.half_sizes;
      const mesh = new Mesh(new BoxGeometry(2 * x, 2 * y, 2 * z), solid);
      mesh.position.set(...obstacle.center);
      const [qw, qx, qy, qz] = obstacle.rotation ?? [1, 0, 0, 0];
      mesh.quaternion.set(qx, qy, qz, qw).normalize();
      return mesh;
    }
    case 'capsule': {
      const from = new Vector3(...obstacle.from);
      const axis = new Vector3(...obstacle.to).sub(from);
      const mesh = new Mesh(new CapsuleGeometry(obstacle.radius, axis.length(), 6, 20), solid);
      mesh.position.copy(from).addScaledVector(axis, 0.5);
      mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
      return mesh;
    }
    case 'plane': {
      const mesh = net_of(1.6 * span, color);
      mesh.position.set(...obstacle.point);
      const normal = new Vector3(...obstacle.normal).normalize();
      mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal));
      return mesh;
    }
  }
}

/** Squares that mark an infinite plane. */
function net_of(half: number, color: number): Object3D {
  const points: number[] = [];
  for (let i = -4; i <= 4; ++i) {
    const at = (i / 4) * half;
    points.push(at, -half, 0, at, half, 0, -half, at, 0, half, at, 0);
  }
  return lines(points, color, 0.45);
}
