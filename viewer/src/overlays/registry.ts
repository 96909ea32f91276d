// Every kind of layer that can lie upon a camera's picture: a new one is one file and one line here.
import type { Layer } from '../protocol/types';
import { ellipse } from './ellipse';
import { lines } from './lines';
import type { Overlay } from './overlay';
import { points } from './points';
import { polyline } from './polyline';
import { runs } from './runs';

export const overlays: Overlay[] = [runs, polyline, lines, ellipse, points];

const by_kind = new Map(overlays.map((overlay) => [overlay.kind, overlay]));

/** Draws layers in their order; kinds that this page does not know are passed over. */
export function draw_layers(context: CanvasRenderingContext2D, layers: Layer[], scale: number): void {
  for (const layer of layers) {
    const overlay = by_kind.get(layer.kind);
    if (!overlay) continue;
    context.save();
    // A pixel's middle is a whole number in the protocol, and half of one on a canvas.
    context.translate(0.5, 0.5);
    context.strokeStyle = context.fillStyle = layer.color ?? overlay.color;
    overlay.draw(context, layer, scale);
    context.restore();
  }
}
