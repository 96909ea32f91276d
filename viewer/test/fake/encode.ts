// Encoder of the binary messages, written independently from docs/viewer-protocol.md to test the page's decoder.
export interface StateRows {
  flags: number;
  leaps?: number;
  sequence: number;
  time: number;
  bends: ArrayLike<number>;
  stretches: ArrayLike<number>;
  samples: ArrayLike<number>;
  cameras: ArrayLike<number>;
  displacements: ArrayLike<number>;
  /** Three numbers per row. */
  actuators?: ArrayLike<number>;
  /** energy: three numbers; push: seven; pace: one; contacts: ten per row. */
  energy?: ArrayLike<number>;
  push?: ArrayLike<number>;
  pace?: number;
  contacts?: ArrayLike<number>;
}

export function encode_state(state: StateRows): Buffer {
  const parts = [state.bends, state.stretches, state.samples, state.cameras, state.displacements, state.actuators ?? [],
    state.energy ?? [], state.push ?? [], state.pace === undefined ? [] : [state.pace], state.contacts ?? []];
  const flags = state.flags | (state.energy ? 32 : 0) | (state.push ? 64 : 0) | (state.pace === undefined ? 0 : 128);
  const bytes = Buffer.alloc(28 + 4 * parts.reduce((sum, { length }) => sum + length, 0));
  bytes.writeUInt8(1, 0);
  bytes.writeUInt8(flags, 1);
  bytes.writeUInt16LE(state.stretches.length, 2);
  bytes.writeUInt16LE(state.samples.length / 8, 4);
  bytes.writeUInt16LE(state.cameras.length / 23, 6);
  bytes.writeUInt16LE(state.displacements.length, 8);
  bytes.writeUInt16LE(state.leaps ?? 0, 10);
  bytes.writeUInt32LE(state.sequence, 12);
  bytes.writeDoubleLE(state.time, 16);
  bytes.writeUInt16LE((state.actuators?.length ?? 0) / 3, 24);
  bytes.writeUInt16LE((state.contacts?.length ?? 0) / 10, 26);
  let at = 28;
  for (const part of parts) for (let i = 0; i < part.length; ++i) at = bytes.writeFloatLE(part[i], at);
  return bytes;
}

export function encode_image(camera: number, number: number, time: number, png: Buffer): Buffer {
  const head = Buffer.alloc(16);
  head.writeUInt8(2, 0);
  head.writeUInt8(camera, 1);
  head.writeUInt16LE(1, 2);
  head.writeUInt32LE(number, 4);
  head.writeDoubleLE(time, 8);
  return Buffer.concat([head, png]);
}

export function encode_extras(extras: object): Buffer {
  return Buffer.concat([Buffer.from([3]), Buffer.from(JSON.stringify(extras))]);
}
