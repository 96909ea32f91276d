import { expect, test } from 'vitest';
import { decode_image, decode_state, kind_of } from '../../src/protocol/state';
import { encode_image, encode_state } from '../fake/encode';

const rows = {
  flags: 9, leaps: 65_535, sequence: 4_000_000_000, time: 12.5, bends: [0.5, -1, 2, 3], stretches: [1, 1.25],
  samples: Array.from({ length: 24 }, (_, i) => i / 4), cameras: Array.from({ length: 23 }, (_, i) => i - 4),
  displacements: [0.125, 0.25, 0.375], actuators: [0.5, 2, 0, 0.25, 0, 60],
};

function buffer(bytes: Buffer): ArrayBuffer {
  return new Uint8Array(bytes).buffer;
}

test('a state is read as it was written', () => {
  const state = decode_state(buffer(encode_state(rows)));
  expect(state.flags).toBe(9);
  expect(state.leaps).toBe(65_535);
  expect(state.sequence).toBe(4_000_000_000);
  expect(state.time).toBe(12.5);
  for (const key of ['bends', 'stretches', 'samples', 'cameras', 'displacements', 'actuators'] as const) {
    expect(Array.from(state[key])).toEqual(rows[key].map((x) => x + 0));
  }
});

test('forces are read as they were written', () => {
  const forces = {
    energy: [0.5, 0.25, -2], push: [0.5, 1, 2, 3, -1, 0.5, 0], pace: 0.5,
    contacts: Array.from({ length: 20 }, (_, i) => i / 8),
  };
  const state = decode_state(buffer(encode_state({ ...rows, ...forces })));
  expect(state.flags).toBe(9 + 32 + 64 + 128);
  for (const key of ['energy', 'push', 'contacts'] as const) expect(Array.from(state[key]!)).toEqual(forces[key]);
  expect(state.pace).toBe(0.5);
  const without = decode_state(buffer(encode_state(rows)));
  expect([without.energy, without.push, without.pace, without.contacts!.length]).toEqual([null, null, null, 0]);
});

test('a state of another length than its counts say is refused', () => {
  const bytes = encode_state(rows);
  expect(() => decode_state(buffer(bytes.subarray(0, bytes.length - 4)))).toThrow(/expected/);
  expect(() => decode_state(buffer(Buffer.concat([bytes, Buffer.alloc(4)])))).toThrow(/expected/);
  expect(() => decode_state(buffer(bytes.subarray(0, 10)))).toThrow(/header/);
  expect(() => decode_state(new ArrayBuffer(0))).toThrow(/header/);
});

test('an image is read as it was written', () => {
  const bytes = buffer(encode_image(1, 77, 0.25, Buffer.from([1, 2, 3])));
  expect(kind_of(bytes)).toBe(2);
  const image = decode_image(bytes);
  expect([image.camera, image.number, image.time, image.type]).toEqual([1, 77, 0.25, 'image/png']);
  expect(Array.from(image.file)).toEqual([1, 2, 3]);
});

test('an image of an unknown format is one that nothing decodes, and keeps its number', () => {
  const bytes = encode_image(0, 1, 0, Buffer.alloc(0));
  bytes.writeUInt16LE(7, 2);
  expect(decode_image(buffer(bytes))).toMatchObject({ number: 1, type: 'application/octet-stream' });
  expect(() => decode_image(new ArrayBuffer(3))).toThrow(/header/);
});

test('a message without a byte has no kind', () => {
  expect(kind_of(new ArrayBuffer(0))).toBe(0);
});
