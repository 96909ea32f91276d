import type { Layer } from '../protocol/types';

/** A kind of layer upon a camera's picture. */
export interface Overlay {
  /** As in the message's `kind`. */
  kind: string;
  color: string;
  /**
   * Draws in the picture's pixels: (0, 0) is the middle of the top-left one, and the context is set so. `scale` is how
   * many of them make one pixel of the screen.
   */
  draw(context: CanvasRenderingContext2D, layer: Layer, scale: number): void;
}

export type Points = [number, number][];
