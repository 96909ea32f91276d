import type { Overlay } from './overlay';

/** A mask as runs of pixels in rows; both ends are included. */
export const runs: Overlay = {
  kind: 'runs',
  color: '#36c5b4',
  draw(context, layer) {
    context.globalAlpha = 0.4;
    for (const [v, from, to] of (layer.rows ?? []) as [number, number, number][]) {
      context.fillRect(from - 0.5, v - 0.5, to - from + 1, 1);
    }
  },
};
