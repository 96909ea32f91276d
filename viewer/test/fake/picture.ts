// Picture of a camera of the fake rig: the arm as a thick dark line on a bright screen, as a PNG.
import { deflateSync } from 'node:zlib';

const table = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let i = 0; i < 8; ++i) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});

function crc(bytes: Buffer): number {
  let c = 0xffffffff;
  for (const byte of bytes) c = table[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** Returns a chunk of a PNG file. */
export function chunk(type: string, data: Buffer): Buffer {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crc(body), body.length + 4);
  return out;
}

/** Encodes a PNG: grey, or with three channels in colour. */
export function encode_png(width: number, height: number, pixels: Uint8Array, channels: 1 | 3 = 1): Buffer {
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, channels === 1 ? 0 : 2, 0, 0, 0], 8);
  const line = width * channels;
  const rows = Buffer.alloc((line + 1) * height);
  for (let v = 0; v < height; ++v) rows.set(pixels.subarray(v * line, (v + 1) * line), v * (line + 1) + 1);
  return Buffer.concat([
    Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]),
    chunk('IHDR', head),
    chunk('IDAT', deflateSync(rows, { level: 1 })),
    chunk('IEND', Buffer.alloc(0)),
  ]);
}

export interface PointInPicture {
  u: number;
  v: number;
  /** Half the arm's width at this point, px. */
  radius: number;
}

/** Draws discs along the points; `back` is the screen's grey. */
export function draw_arm(width: number, height: number, points: PointInPicture[], back = 225, dark = 52): Uint8Array {
  const pixels = new Uint8Array(width * height).fill(back);
  for (const { u, v, radius } of points) {
    const r = Math.max(1, radius);
    for (let y = Math.max(0, Math.floor(v - r)); y <= Math.min(height - 1, Math.ceil(v + r)); ++y) {
      for (let x = Math.max(0, Math.floor(u - r)); x <= Math.min(width - 1, Math.ceil(u + r)); ++x) {
        const d = Math.hypot(x - u, y - v);
        if (d <= r) pixels[y * width + x] = Math.round(dark + 60 * (1 - d / r));
      }
    }
  }
  return pixels;
}
