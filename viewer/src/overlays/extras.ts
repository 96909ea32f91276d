// What the program draws of its own: wanted and seen shapes, in the 3D view and upon the pictures. One eye for both.
import type { ExtraOverlay, Extras, GhostMessage, Layer } from '../protocol/types';

/** What the list of hidden things calls one. */
export function eye_of(id: string): string {
  return `extra ${id}`;
}

/** By a name of their own, so that none takes the place of a ghost that somebody else sent. */
export function extra_ghosts(extras: Extras | null, hidden: string[]): Record<string, GhostMessage> {
  const shown = (extras?.ghosts ?? []).filter(({ id }) => !hidden.includes(eye_of(id)));
  return Object.fromEntries(shown.map(({ id, color, poses }) => [eye_of(id), { type: 'ghost', id: eye_of(id), color, poses }]));
}

/** What lies upon the camera's picture of this number. */
export function extra_overlay(extras: Extras | null, camera: string, number: number | undefined): ExtraOverlay | undefined {
  return extras?.overlays.find((overlay) => overlay.camera === camera && (overlay.number === undefined || overlay.number === number));
}

/** Without those whose own eye, or that of what they belong to, is shut. */
export function extra_layers(overlay: ExtraOverlay | undefined, hidden: string[]): Layer[] {
  const is_shown = (id: unknown): boolean => typeof id !== 'string' || !hidden.includes(eye_of(id));
  return (overlay?.layers ?? []).filter(({ id, of }) => is_shown(id) && is_shown(of));
}

/** What has an eye: ghosts, and what lies upon pictures alone, in the colour of its first layer. */
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
