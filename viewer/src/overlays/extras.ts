// Extras drawn by the program: target and observed shapes, in the 3D view and on the pictures. One eye toggles both.
import type { ExtraOverlay, Extras, GhostMessage, Layer } from '../protocol/types';

/** Returns the id of an extra in the list of hidden things. */
export function eye_of(id: string): string {
  return `extra ${id}`;
}

/** Returns the ghosts of the extras, with ids that cannot collide with those of ghost messages. */
export function extra_ghosts(extras: Extras | null, hidden: string[]): Record<string, GhostMessage> {
  const shown = (extras?.ghosts ?? []).filter(({ id }) => !hidden.includes(eye_of(id)));
  return Object.fromEntries(shown.map(({ id, color, poses }) => [eye_of(id), { type: 'ghost', id: eye_of(id), color, poses }]));
}

/** Returns the overlay for the camera's picture of this number. */
export function extra_overlay(extras: Extras | null, camera: string, number: number | undefined): ExtraOverlay | undefined {
  return extras?.overlays.find((overlay) => overlay.camera === camera && (overlay.number === undefined || overlay.number === number));
}

/** Returns the layers whose own eye and parent's eye are open. */
export function extra_layers(overlay: ExtraOverlay | undefined, hidden: string[]): Layer[] {
  const is_shown = (id: unknown): boolean => typeof id !== 'string' || !hidden.includes(eye_of(id));
  return (overlay?.layers ?? []).filter(({ id, of }) => is_shown(id) && is_shown(of));
}

/**
 * Returns all things with an eye: ghosts, and layers that exist on pictures only, in the colour of their first layer.
 */
export function eyes_of(extras: Extras): { id: string; label: string; color: string }[] {
  const eyes = extras.ghosts.map(({ id, label, color }) => ({ id, label, color }));
  for (const { id, label, color } of extras.overlays.flatMap(({ layers }) => layers)) {
    if (label && !eyes.some((eye) => eye.id === id)) eyes.push({ id, label, color: color ?? '' });
  }
  return eyes;
}

/** Of a camera: on a slow machine a picture comes seconds after that. */
const remembered = 500;

/** What was drawn upon the last pictures, by their numbers: a picture may come after what was measured in it, and in the next. */
export class OverlayMemory {
  private readonly cameras = new Map<string, Map<number, ExtraOverlay>>();

  take(extras: Extras | null): void {
    const drawn = extras?.overlays ?? [];
    for (const camera of [...this.cameras.keys()]) if (!drawn.some((overlay) => overlay.camera === camera)) this.cameras.delete(camera);
    for (const overlay of drawn) {
      if (overlay.number === undefined) continue;
      const of_camera = this.cameras.get(overlay.camera) ?? new Map<number, ExtraOverlay>();
      this.cameras.set(overlay.camera, of_camera);
      of_camera.delete(overlay.number);
      of_camera.set(overlay.number, overlay);
      if (of_camera.size > remembered) of_camera.delete(of_camera.keys().next().value!);
    }
  }

  of(camera: string, number: number | undefined): ExtraOverlay | undefined {
    return number === undefined ? undefined : this.cameras.get(camera)?.get(number);
  }
}
