#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "flexura/store/mcap_records.h"

namespace flexura {

/// The earliest and the latest of a set of times, ns.
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
  std::uint64_t records_size = 0;          ///< Size of its messages.
  std::string_view compression;            ///< mcap_zstd, or empty.
  std::uint64_t stored_size = 0;           ///< Size of its messages as stored.
  std::uint64_t message_index_length = 0;  ///< Length of all message indexes, which follow the chunk.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  ///< By channel; in the file.
};

/// Content of a log, as listed in the summary at its end.
struct McapSummary {
  struct Channel {
    McapChannel description;
    std::uint16_t schema_id = 0;  ///< 0: no schema.
    std::uint64_t message_count = 0;
  };
  std::vector<McapSchema> schemas;  ///< Schema i has the identifier i + 1, like channel i.
  std::vector<Channel> channels;
  std::vector<McapChunkIndex> chunks;
};

void put_schema(McapBytes& out, std::uint16_t id, const McapSchema& schema);
void put_channel(McapBytes& out, std::uint16_t id, const McapSummary::Channel& channel);

/// Puts everything after the data section: summary, summary offsets, footer and magic. `at` is its position
/// in the file.
void put_summary(McapBytes& out, std::uint64_t at, const McapSummary& summary);

}  // namespace flexura
