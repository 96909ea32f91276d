// All kinds of layers on camera pictures. A new kind needs one file and one line here.
import type { Layer } from '../protocol/types';
import { ellipse } from './ellipse';
import { lines } from './lines';
import type { Overlay } from './overlay';
import { points } from './points';
import { polyline } from './polyline';
import { runs } from './runs';

export const overlays: Overlay[] = [runs, polyline, lines, ellipse, points];

const by_kind = new Map(overlays.map((overlay) => [overlay.kind, overlay]));

/** Draws layers in order; unknown kinds are ignored. */
export function draw_layers(context: CanvasRenderingContext2D, layers: Layer[], scale: number): void {
  for (const layer of layers) {
    const overlay = by_kind.get(layer.kind);
    if (!overlay) continue;
    context.save();
    // Pixel centres are integers in the protocol, and half-integers on a canvas.
    context.translate(0.5, 0.5);
    context.strokeStyle = context.fillStyle = layer.color ?? overlay.color;
    overlay.draw(context, layer, scale);
    context.restore();
  }
}
