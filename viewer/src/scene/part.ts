import type { Group, Object3D, Vector3 } from 'three';
import type { Picture } from '../connection/images';
import type { State } from '../protocol/state';
import type { GhostMessage, Scene } from '../protocol/types';

export type Theme = 'dark' | 'light';

/** A word in the 3D view, written by the page over the canvas. `at` may move before each frame. */
export interface Label {
  /** Chooses its colour: an axis, or the floor's scale. */
  kind: string;
  text: string;
  at: Vector3;
}

export interface PartContext {
  scene: Scene;
  /** Length of the arm, the reference for sizes in the view. */
  span: number;
  /** Height of the floor. */
  floor: number;
  theme: Theme;
}

/**
 * A thing in the 3D view. `id` identifies it in the list of hidden things. `draw` is called with every shown state and
 * must not allocate. Optional methods may be omitted.
 */
export interface Part {
  id: string;
  label: string;
  group: Group | Object3D;
  /** Words at the thing, shown and hidden with it. */
  labels?: Label[];
  draw?(state: State): void;
  picture?(camera: string, picture: Picture | null): void;
  ghosts?(ghosts: Record<string, GhostMessage>): void;
  /** True while the view is inside this camera; its own frustum would hide everything. */
  inside?(camera: string | null): void;
  /**
   * Called before each frame with the eye position and the pixels of one metre at a distance of one metre. Must not
   * allocate.
   */
  seen_from?(eye: Vector3, pixels: number): void;
  dispose(): void;
}

export type PartMaker = (context: PartContext) => Part[];

/** Releases the GPU resources of an object and its children. */
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
