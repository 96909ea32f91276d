import type { Overlay, Points } from './overlay';

/** Polylines: centerlines, outlines. */
export const polyline: Overlay = {
  kind: 'polyline',
  color: '#ffd43b',
  draw(context, layer, scale) {
    context.lineWidth = 2 * scale;
    context.lineJoin = 'round';
    if (layer.dashed) context.setLineDash([6 * scale, 5 * scale]);
    context.beginPath();
    for (const [u, v] of (layer.points ?? []) as Points) context.lineTo(u, v);
    if (layer.closed) context.closePath();
    context.stroke();
  },
};
