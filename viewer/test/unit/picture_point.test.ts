import { expect, test } from 'vitest';
import { nearest_pixel, picture_point, whole, zoomed } from '../../src/math/picture_point';

const camera = { width: 640, height: 480 };

test('the middle of the top left pixel is (0, 0), at every size', () => {
  for (const factor of [0.5, 1, 2.37]) {
    const shown = { left: 100, top: 50, width: 640 * factor, height: 480 * factor };
    const [u, v] = picture_point(100 + 0.5 * factor, 50 + 0.5 * factor, shown, camera);
    expect(u).toBeCloseTo(0, 9);
    expect(v).toBeCloseTo(0, 9);
    expect(picture_point(100 + 320 * factor, 50 + 240 * factor, shown, camera)).toEqual([319.5, 239.5]);
  }
});

test('a picture that is enlarged and moved has the point under the pointer', () => {
  // The frame is 320 x 240 at (10, 20); a quarter of the picture fills it.
  const shown = { left: 10 - 0.25 * 1280, top: 20 - 0.5 * 960, width: 1280, height: 960 };
  expect(picture_point(10, 20, shown, camera)).toEqual([0.25 * 640 - 0.5, 0.5 * 480 - 0.5]);
});

test('points outside belong to the nearest pixel', () => {
  expect(nearest_pixel([-7, 500], camera)).toEqual([0, 479]);
  expect(nearest_pixel([12.4, 12.6], camera)).toEqual([12, 13]);
});

test('zooming keeps the point under the pointer, and never shows more than the picture', () => {
  let zoom = whole;
  const under = (x: number): number => zoom.x + x / zoom.factor;
  for (const by of [1.25, 1.25, 1.25, 0.8]) {
    const before = under(0.3);
    zoom = zoomed(zoom, 0.3, 0.9, by);
    expect(under(0.3)).toBeCloseTo(before, 9);
  }
  expect(zoom.factor).toBeCloseTo(1.25 ** 2, 9);
  expect(zoomed(zoom, 0.9, 0.1, 1e-3)).toEqual(whole);
  expect(zoomed(zoom, 0.5, 0.5, 1e9).factor).toBe(16);
  const corner = zoomed(zoom, 1, 1, 4);
  expect(corner.x + 1 / corner.factor).toBeLessThanOrEqual(1 + 1e-9);
});
