import type { Group, Object3D, Vector3 } from 'three';
import type { Picture } from '../connection/images';
import type { State } from '../protocol/state';
import type { GhostMessage, Scene } from '../protocol/types';

export type Theme = 'dark' | 'light';

export interface PartContext {
  scene: Scene;
  /** The arm's length: what sizes in the view are taken from. */
  span: number;
  /** The height of the floor. */
  floor: number;
  theme: Theme;
}

/**
 * A thing in the 3D view. `id` is what the list of things hides it by; `draw` gets every state that is shown and must
 * not allocate; what a part does not need it leaves out.
 */
export interface Part {
  id: string;
  label: string;
  group: Group | Object3D;
  draw?(state: State): void;
  picture?(camera: string, picture: Picture | null): void;
  ghosts?(ghosts: Record<string, GhostMessage>): void;
  /** True while the view stands in this camera: its own frustum would hide everything. */
  inside?(camera: string | null): void;
  /** Before each picture: where the eye is, and how many pixels a metre has one metre away. Must not allocate either. */
  seen_from?(eye: Vector3, pixels: number): void;
  dispose(): void;
}

export type PartMaker = (context: PartContext) => Part[];

/** Releases what an object and its children hold on the graphics card. */
export function dispose_tree(root: Object3D): void {
  root.traverse((object) => {
    const mesh = object as Object3D & {
      geometry?: { dispose(): void };
      material?: { dispose(): void; map?: { dispose(): void } | null };
      dispose?: () => void;
    };
    mesh.geometry?.dispose();
    mesh.material?.map?.dispose();
    mesh.material?.dispose();
  });
}
