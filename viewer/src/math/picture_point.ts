// Points of a picture under the pointer. (0, 0) is the middle of the top left pixel.

interface Size {
  width: number;
  height: number;
}

interface Rectangle extends Size {
  left: number;
  top: number;
}

/** Returns the point of a picture of this size, px, at a place of the screen; `shown` is where all of the picture is. */
export function picture_point(x: number, y: number, shown: Rectangle, { width, height }: Size): [number, number] {
  return [((x - shown.left) / shown.width) * width - 0.5, ((y - shown.top) / shown.height) * height - 0.5];
}

/** Returns the pixel of a picture that is nearest to a point. */
export function nearest_pixel([u, v]: [number, number], { width, height }: Size): [number, number] {
  const inside = (value: number, size: number): number => Math.min(size - 1, Math.max(0, Math.round(value)));
  return [inside(u, width), inside(v, height)];
}

/** An enlarged part of a picture: the factor, and the part's top left corner as shares of the picture. */
export interface Zoom {
  factor: number;
  x: number;
  y: number;
}

export const whole: Zoom = { factor: 1, x: 0, y: 0 };
const largest_factor = 16;

/** Enlarges by `by` so that what is at (x, y), as shares of the frame, stays there. */
export function zoomed(zoom: Zoom, x: number, y: number, by: number): Zoom {
  const factor = Math.min(largest_factor, Math.max(1, zoom.factor * by));
  const start = (from: number, at: number): number =>
    Math.min(1 - 1 / factor, Math.max(0, from + at / zoom.factor - at / factor));
  return { factor, x: start(zoom.x, x), y: start(zoom.y, y) };
}
