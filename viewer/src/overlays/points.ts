import type { Overlay, Points } from './overlay';

/** Markers and features, drawn as crosses. */
export const points: Overlay = {
  kind: 'points',
  color: '#ff6b6b',
  draw(context, layer, scale) {
    context.lineWidth = 1.5 * scale;
    const arm = 5 * scale;
    context.beginPath();
    for (const [u, v] of (layer.points ?? []) as Points) {
      context.moveTo(u - arm, v);
      context.lineTo(u + arm, v);
      context.moveTo(u, v - arm);
      context.lineTo(u, v + arm);
    }
    context.stroke();
  },
};
