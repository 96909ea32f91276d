// Small PNG files: few colours, chosen by median cut.
import { deflateSync } from 'node:zlib';
import type { Page } from 'playwright-core';
import { chunk } from '../test/fake/picture';

interface Box {
  /** Colours, as 0xrrggbb, and how many pixels have each. */
  colors: [number, number][];
  count: number;
}

const channel = (color: number, i: number): number => (color >> (16 - 8 * i)) & 255;

/** Returns at most `most` colours for these, each the mean of a box of similar ones; the map says which. */
function palette_of(counts: Map<number, number>, most: number): { palette: number[]; index: Map<number, number> } {
  const boxes: Box[] = [{ colors: [...counts], count: Infinity }];
  const widest = ({ colors }: Box): { i: number; width: number } => {
    const widths = [0, 1, 2].map((i) => {
      const values = colors.map(([color]) => channel(color, i));
      return values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
    });
    const width = Math.max(...widths);
    return { i: widths.indexOf(width), width };
  };
  while (boxes.length < most) {
    // The box whose split gains most: many pixels that differ much.
    const gains = boxes.map((box) => (box.colors.length > 1 ? widest(box).width ** 2 * Math.min(box.count, 1e9) ** 0.5 : 0));
    const best = gains.indexOf(Math.max(...gains));
    if (gains[best] === 0) break;
    const [box] = boxes.splice(best, 1);
    const { i } = widest(box);
    const sorted = box.colors.sort((a, b) => channel(a[0], i) - channel(b[0], i));
    const [low, high] = [channel(sorted[0][0], i), channel(sorted[sorted.length - 1][0], i)];
    const at = Math.max(1, sorted.findIndex(([color]) => 2 * channel(color, i) > low + high));
    for (const colors of [sorted.slice(0, at), sorted.slice(at)]) boxes.push({ colors, count: colors.reduce((sum, [, n]) => sum + n, 0) });
  }
  const index = new Map<number, number>();
  const palette = boxes.map(({ colors }, b) => {
    const total = colors.reduce((sum, [, n]) => sum + n, 0);
    const mean = [0, 1, 2].map((i) => Math.round(colors.reduce((sum, [color, n]) => sum + n * channel(color, i), 0) / total));
    for (const [color] of colors) index.set(color, b);
    return (mean[0] << 16) | (mean[1] << 8) | mean[2];
  });
  return { palette, index };
}

/** Encodes opaque RGBA pixels as a PNG with a palette of at most `most` colours. */
export function palette_png(pixels: Uint8Array, width: number, height: number, most = 96): Buffer {
  const color_at = (i: number): number => (pixels[4 * i] << 16) | (pixels[4 * i + 1] << 8) | pixels[4 * i + 2];
  const counts = new Map<number, number>();
  for (let i = 0; i < width * height; ++i) counts.set(color_at(i), (counts.get(color_at(i)) ?? 0) + 1);
  const { palette, index } = palette_of(counts, most);
  const rows = Buffer.alloc((width + 1) * height);
  for (let y = 0, i = 0; y < height; ++y) for (let x = 0; x < width; ++x, ++i) rows[y * (width + 1) + 1 + x] = index.get(color_at(i))!;
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 3, 0, 0, 0], 8);
  const colors = Buffer.from(palette.flatMap((color) => [0, 1, 2].map((i) => channel(color, i))));
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk('IHDR', head), chunk('PLTE', colors), chunk('IDAT', deflateSync(rows, { level: 9 })), chunk('IEND', Buffer.alloc(0)),
  ]);
}

/** Returns the pixels of a PNG file, RGBA. */
export async function pixels_of(page: Page, png: Buffer): Promise<Uint8Array> {
  const text = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let out = '';
    for (let i = 0; i < data.length; i += 8192) out += String.fromCharCode(...data.subarray(i, i + 8192));
    return btoa(out);
  }, png.toString('base64'));
  return Buffer.from(text, 'base64');
}
