import type { Overlay } from './overlay';

/** Fitted circles and ellipses; the angle is from u towards v. Rejected ones are dashed. */
export const ellipse: Overlay = {
  kind: 'ellipse',
  color: '#4dabf7',
  draw(context, layer, scale) {
    const [u, v] = layer.center as [number, number];
    const [a, b] = layer.axes as [number, number];
    context.lineWidth = 2 * scale;
    if (layer.dashed || layer.verified === false) context.setLineDash([6 * scale, 5 * scale]);
    context.beginPath();
    context.ellipse(u, v, a, b, (layer.angle as number | undefined) ?? 0, 0, 2 * Math.PI);
    context.stroke();
  },
};
