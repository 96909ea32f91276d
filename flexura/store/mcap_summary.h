#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "flexura/store/mcap_records.h"

namespace flexura {

/// Earliest and latest time of a set of times, ns.
struct McapTimeRange {
  std::uint64_t start = UINT64_MAX, end = 0;
  void add(std::uint64_t time);
  void add(const McapTimeRange& other);
};

/// Position of a chunk and its message indexes.
struct McapChunkIndex {
  McapTimeRange time;
  std::uint64_t start = 0;                 ///< Start of the chunk's record in the file.
  std::uint64_t length = 0;                ///< Length of the whole record.
  std::uint64_t records_size = 0;          ///< Size of the chunk's messages without compression.
  std::string_view compression;            ///< mcap_zstd, or empty.
  std::uint64_t stored_size = 0;           ///< Size of the chunk's messages as stored in the file.
  std::uint64_t message_index_length = 0;  ///< Length of all message indexes, which follow the chunk.
  /// Positions of the message indexes in the file, by channel.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
};

/// Content of a log, as listed in the summary at its end.
struct McapSummary {
  struct Channel {
    McapChannel description;
    std::uint16_t schema_id = 0;  ///< 0: no schema.
    std::uint64_t message_count = 0;
  };
  std::vector<McapSchema> schemas;  ///< Schemas. Schema i and channel i have the identifier i + 1.
  std::vector<Channel> channels;
  std::vector<McapChunkIndex> chunks;
};

void put_schema(McapBytes& out, std::uint16_t id, const McapSchema& schema);
void put_channel(McapBytes& out, std::uint16_t id, const McapSummary::Channel& channel);

/// Appends everything after the data section: summary, summary offsets, footer and magic bytes. `at`:
/// position of this part in the file.
void put_summary(McapBytes& out, std::uint64_t at, const McapSummary& summary);

}  // namespace flexura
