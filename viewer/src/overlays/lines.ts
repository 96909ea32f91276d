import type { Overlay, Points } from './overlay';

/** Separate line segments: compared curves and the differences between them. */
export const lines: Overlay = {
  kind: 'lines',
  color: '#da77f2',
  draw(context, layer, scale) {
    context.lineWidth = 1.5 * scale;
    if (layer.dashed) context.setLineDash([4 * scale, 3 * scale]);
    context.beginPath();
    for (const line of (layer.lines ?? []) as Points[]) {
      line.forEach(([u, v], i) => (i === 0 ? context.moveTo(u, v) : context.lineTo(u, v)));
    }
    context.stroke();
  },
};
