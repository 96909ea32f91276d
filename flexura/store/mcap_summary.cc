#include "flexura/store/mcap_summary.h"

#include <algorithm>

namespace flexura {
namespace {

/// Consecutive records of one kind in the summary.
struct Group {
  McapOp op;
  std::uint64_t start, length;
};

void put_map(McapBytes& out, const auto& map) {
  out.measured<std::uint32_t>([&] {
    for (const auto& [key, value] : map) {
      out.put(key);
      out.put(value);
    }
  });
}

void put_chunk_index(McapBytes& out, const McapChunkIndex& chunk) {
  out.record(McapOp::chunk_index, [&] {
    out.put(chunk.time.start);
    out.put(chunk.time.end);
    out.put(chunk.start);
    out.put(chunk.length);
    put_map(out, chunk.message_index_offsets);
    out.put(chunk.message_index_length);
    out.put(chunk.compression);
    out.put(chunk.stored_size);
    out.put(chunk.records_size);
  });
}

void put_statistics(McapBytes& out, const McapSummary& summary) {
  std::uint64_t messages = 0;
  std::map<std::uint16_t, std::uint64_t> messages_of;
  for (std::uint16_t id = 1; const McapSummary::Channel& channel : summary.channels) {
    messages += channel.message_count;
    messages_of[id++] = channel.message_count;
  }
  McapTimeRange time;
  if (summary.chunks.empty()) time.add(0);
  for (const McapChunkIndex& chunk : summary.chunks) time.add(chunk.time);
  out.record(McapOp::statistics, [&] {
    out.put(messages);
    out.put(static_cast<std::uint16_t>(summary.schemas.size()));
    out.put(static_cast<std::uint32_t>(summary.channels.size()));
    out.put(std::uint32_t{0});  // Number of attachments.
    out.put(std::uint32_t{0});  // Number of metadata.
    out.put(static_cast<std::uint32_t>(summary.chunks.size()));
    out.put(time.start);
    out.put(time.end);
    put_map(out, messages_of);
  });
}

}  // namespace

void McapTimeRange::add(std::uint64_t time) {
  start = std::min(start, time);
  end = std::max(end, time);
}

void McapTimeRange::add(const McapTimeRange& other) {
  start = std::min(start, other.start);
  end = std::max(end, other.end);
}

void put_schema(McapBytes& out, std::uint16_t id, const McapSchema& schema) {
  out.record(McapOp::schema, [&] {
    out.put(id);
    out.put(schema.name);
    out.put(schema.encoding);
    out.put(schema.data);
  });
}

void put_channel(McapBytes& out, std::uint16_t id, const McapSummary::Channel& channel) {
  out.record(McapOp::channel, [&] {
    out.put(id);
    out.put(channel.schema_id);
    out.put(channel.description.topic);
    out.put(channel.description.encoding);
    put_map(out, channel.description.metadata);
  });
}

void put_summary(McapBytes& out, std::uint64_t at, const McapSummary& summary) {
  const std::size_t first = out.size();
  const auto offset = [&] { return at + (out.size() - first); };
  std::vector<Group> groups;
  const auto put_group = [&](McapOp op, const auto& list, auto put_one) {
    const std::uint64_t start = offset();
    for (std::uint16_t id = 1; const auto& element : list) put_one(id++, element);
    if (offset() > start) groups.push_back({op, start, offset() - start});
  };
  put_group(McapOp::schema, summary.schemas, [&](auto id, const auto& s) { put_schema(out, id, s); });
  put_group(McapOp::channel, summary.channels, [&](auto id, const auto& c) { put_channel(out, id, c); });
  put_group(McapOp::statistics, std::span(&summary, 1),
            [&](auto, const auto& all) { put_statistics(out, all); });
  put_group(McapOp::chunk_index, summary.chunks,
            [&](auto, const auto& chunk) { put_chunk_index(out, chunk); });

  const std::uint64_t offsets_start = offset();
  for (const Group& group : groups) {
    out.record(McapOp::summary_offset, [&] {
      out.put(static_cast<std::uint8_t>(group.op));
      out.put(group.start);
      out.put(group.length);
    });
  }
  // The footer's CRC covers its own first fields, so it cannot use record().
  out.put(static_cast<std::uint8_t>(McapOp::footer));
  out.put(std::uint64_t{mcap_footer_length});
  out.put(at);
  out.put(offsets_start);
  out.put(mcap_crc(0, std::span(out.bytes()).subspan(first)));
  out.put(std::as_bytes(std::span(mcap_magic)));
}

}  // namespace flexura
