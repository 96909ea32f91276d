#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "flexura/store/mcap_records.h"

namespace flexura {

/// The earliest and the latest of some times, ns.
struct McapTimeRange {
  std::uint64_t start = UINT64_MAX, end = 0;
  void add(std::uint64_t time);
  void add(const McapTimeRange& other);
};

/// Where a chunk and its message indexes lie.
struct McapChunkIndex {
  McapTimeRange time;
  std::uint64_t start = 0;                 ///< Of the chunk's record in the file.
  std::uint64_t length = 0;                ///< Of the whole record.
  std::uint64_t records_size = 0;          ///< Of the messages in it.
  std::uint64_t message_index_length = 0;  ///< Of all message indexes, which follow the chunk.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  ///< By channel; in the file.
};

/// What a log holds, as its end tells it.
struct McapSummary {
  struct Channel {
    McapChannel description;
    std::uint16_t schema_id = 0;  ///< 0: none.
    std::uint64_t message_count = 0;
  };
  std::vector<McapSchema> schemas;  ///< Schema i has the identifier i + 1, and so has channel i.
  std::vector<Channel> channels;
  std::vector<McapChunkIndex> chunks;
};

/// Chunks are not compressed. Another name here comes with compressing where chunks are put; a chunk's CRC
/// and uncompressed size stay those of the plain records.
inline constexpr std::string_view mcap_compression;

void put_schema(McapBytes& out, std::uint16_t id, const McapSchema& schema);
void put_channel(McapBytes& out, std::uint16_t id, const McapSummary::Channel& channel);

/// Puts all that follows the data section: summary, summary offsets, footer and magic. `at` is where in the
/// file they will lie.
void put_summary(McapBytes& out, std::uint64_t at, const McapSummary& summary);

}  // namespace flexura
