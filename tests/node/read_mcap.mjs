// Reads a log with @mcap/core, as other programs would, and prints its content as JSON:
//
//   node read_mcap.mjs FILE
//
//   { library, indexed: SUMMARY, streamed: SUMMARY }
//   SUMMARY = { channels: [{ topic, encoding, schema, schemaEncoding, count }], start, end, first, last }
//
// "indexed" is read through the summary and the indexes, in time order; "streamed" is read from start to end, in file
// order. Times are nanoseconds as text; messages are text. A wrong CRC gives exit status 1.
import { open, readFile } from "node:fs/promises";

import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const decoder = new TextDecoder("utf-8", { fatal: true });

class Summary {
  #schemas = new Map();
  #channels = new Map();
  #messages = [];

  take(record) {
    if (record.type === "Schema") this.#schemas.set(record.id, record);
    if (record.type === "Channel" && !this.#channels.has(record.id)) {
      this.#channels.set(record.id, { ...record, count: 0 });
    }
    if (record.type === "Message") {
      this.#channels.get(record.channelId).count += 1;
      this.#messages.push(record);
    }
  }

  told() {
    const times = this.#messages.map((message) => message.logTime);
    const earliest = times.reduce((a, b) => (a < b ? a : b), times[0]);
    const latest = times.reduce((a, b) => (a > b ? a : b), times[0]);
    const tell = (message) => message && {
      topic: this.#channels.get(message.channelId).topic,
      time: String(message.logTime),
      data: decoder.decode(message.data),
    };
    return {
      channels: [...this.#channels.values()].map((channel) => ({
        topic: channel.topic,
        encoding: channel.messageEncoding,
        schema: this.#schemas.get(channel.schemaId)?.name ?? null,
        schemaEncoding: this.#schemas.get(channel.schemaId)?.encoding ?? null,
        count: channel.count,
      })),
      start: times.length > 0 ? String(earliest) : null,
      end: times.length > 0 ? String(latest) : null,
      first: tell(this.#messages.at(0)) ?? null,
      last: tell(this.#messages.at(-1)) ?? null,
    };
  }
}

async function readIndexed(file) {
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, length) => {
      const buffer = new Uint8Array(Number(length));
      const { bytesRead } = await file.read(buffer, 0, buffer.length, Number(offset));
      if (bytesRead !== buffer.length) throw new Error(`read ${bytesRead} of ${length} bytes at ${offset}`);
      return buffer;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });  // Checks the summary's CRC.
  const summary = new Summary();
  for (const schema of reader.schemasById.values()) summary.take(schema);
  for (const channel of reader.channelsById.values()) summary.take(channel);
  for await (const message of reader.readMessages({ validateCrcs: true })) summary.take(message);
  const told = summary.told();
  checkStatistics(reader, told);
  return { library: reader.header.library, summary: told };
}

// Checks the log's statistics against its content.
function checkStatistics({ statistics, chunkIndexes, channelsById, schemasById }, told) {
  const expected = {
    messageCount: BigInt(told.channels.reduce((sum, channel) => sum + channel.count, 0)),
    schemaCount: schemasById.size,
    channelCount: channelsById.size,
    chunkCount: chunkIndexes.length,
    messageStartTime: BigInt(told.start ?? 0),
    messageEndTime: BigInt(told.end ?? 0),
  };
  for (const [name, value] of Object.entries(expected)) {
    if (statistics[name] !== value) throw new Error(`statistics.${name} is ${statistics[name]}, not ${value}`);
  }
  let id = 0;
  for (const channel of told.channels) {
    id += 1;
    const counted = Number(statistics.channelMessageCounts.get(id) ?? 0n);
    if (counted !== channel.count) throw new Error(`channel ${id} counts ${counted}, not ${channel.count}`);
  }
}

function readStreamed(bytes) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  const summary = new Summary();
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    summary.take(record);
    if (record.type === "DataEnd") checkDataSection(bytes, record.dataSectionCrc);
  }
  if (!reader.done()) throw new Error("the log has no end");
  return summary.told();
}

// @mcap/core does not check this CRC: it covers everything before the DataEnd record.
function checkDataSection(bytes, expected) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const footer = bytes.length - 8 - 29;
  const dataEnd = Number(view.getBigUint64(footer + 9, true)) - 13;
  const found = crc32(bytes.subarray(0, dataEnd));
  if (expected === 0 || found !== expected) throw new Error(`data section's CRC ${found}, not ${expected}`);
}

const path = process.argv[2];
const file = await open(path);
try {
  const { library, summary } = await readIndexed(file);
  console.log(JSON.stringify({ library, indexed: summary, streamed: readStreamed(await readFile(path)) }));
} finally {
  await file.close();
}
