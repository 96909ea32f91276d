// Objects around the arm: screens, the calibration cylinder, obstacles.
import {
  BoxGeometry, CapsuleGeometry, Color, CylinderGeometry, Group, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, type Object3D, PlaneGeometry, Quaternion, SphereGeometry, Vector3,
} from 'three';
import type { Pose, SceneEtalon, SceneObstacle, SceneScreen } from '../../protocol/types';
import { dispose_tree, type Part, type PartContext } from '../part';
import { plain } from '../plain';
import { lines } from './floor';

export function make_stand(context: PartContext): Part[] {
  const { scene } = context;
  const parts: Part[] = scene.screens.map((screen, i) =>
    part(`screen ${i + 1}`, scene.screens.length > 1 ? `Screen ${i + 1}` : 'Screen', screen_of(screen, context)),
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

/**
 * A screen: bright on its front; only its edges are visible from behind, so that it never hides the arm. It is opaque,
 * because blending a large area is slow in software renderers.
 */
function screen_of({ pose, size, brightness }: SceneScreen, { theme }: PartContext): Object3D {
  const group = new Group();
  const [w, h] = [size[0] / 2, size[1] / 2];
  const level = Math.min(1, Math.max(0.2, brightness));
  const sheen = theme === 'dark' ? 0.02 * level : 0.75 + 0.25 * level;
  const sheet = new Mesh(
    new PlaneGeometry(size[0], size[1]),
    // Offset in depth, so that the edges lie on it.
    plain(new MeshBasicMaterial({
      color: new Color(sheen, sheen, 1.08 * sheen), polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2,
    })),
  );
  const edge = lines(
    [-w, -h, 0, w, -h, 0, w, -h, 0, w, h, 0, w, h, 0, -w, h, 0, -w, h, 0, -w, -h, 0],
    theme === 'dark' ? 0x8da0b0 : 0x8793a0,
  );
  group.add(sheet, edge);
  stand_at(group, pose);
  return group;
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
