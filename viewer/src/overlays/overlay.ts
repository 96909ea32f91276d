import type { Layer } from '../protocol/types';

/** A kind of layer on a camera's picture. */
export interface Overlay {
  /** The message's `kind`. */
  kind: string;
  color: string;
  /**
   * Draws in the picture's pixel coordinates: (0, 0) is the centre of the top-left pixel, and the context is set
   * accordingly. `scale` is the number of picture pixels per screen pixel.
   */
  draw(context: CanvasRenderingContext2D, layer: Layer, scale: number): void;
}

export type Points = [number, number][];
