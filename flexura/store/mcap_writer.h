#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "flexura/store/mcap_file.h"
#include "flexura/store/mcap_records.h"
#include "flexura/store/mcap_summary.h"

namespace flexura {

/// Writes a new log (docs/log-format.md): messages on channels, gathered into chunks. A chunk goes to the
/// operating system in one write when it is full, so a process killed at any moment leaves a log that reads
/// up to its last complete chunk. The same calls give the same bytes. Every call that writes throws
/// std::system_error with the path when the system refuses (disk full, ...); what the file holds by then
/// stays readable, and the writer takes nothing more.
class McapWriter {
 public:
  /// How the file is cut.
  struct Config {
    /// A chunk is closed once its messages take this many bytes (1 to 2^30); a bigger message is a chunk of
    /// its own.
    std::size_t chunk_size = std::size_t{256} * 1024;
  };

  /// Creates the file; never overwrites one. Throws std::system_error with the path when it
  /// exists already or cannot be created, std::invalid_argument for a chunk size out of range.
  explicit McapWriter(const std::filesystem::path& path) : McapWriter(path, Config{}) {}
  McapWriter(const std::filesystem::path& path, Config config);
  /// Closes the log as well as it can, without a word; call close() to hear of failures.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// The new channel's number, counted from 1. Channels with the same schema share one record of it.
  /// Throws std::invalid_argument when the topic is empty or taken, std::length_error past 65535 channels.
  std::uint16_t add_channel(McapChannel channel);

  /// Adds a message. `log_time` is simulated time in ns and need not grow. Throws std::out_of_range for a
  /// channel that add_channel did not return.
  void write(std::uint16_t channel, std::uint64_t log_time, std::span<const std::byte> data);
  /// The same of text.
  void write(std::uint16_t channel, std::uint64_t log_time, std::string_view text) {
    write(channel, log_time, std::as_bytes(std::span(text)));
  }

  /// Closes the current chunk, if it holds a message.
  void flush();
  /// Ends the log with its summary. Later calls, but for close(), throw std::logic_error.
  void close();

 private:
  struct IndexEntry {
    std::uint64_t time, offset;  ///< Offset from the start of the chunk's records.
  };

  void append(const McapBytes& out);
  void require_open() const;
  void put_chunk(McapBytes& out) const;
  void put_message_indexes(McapBytes& out, McapChunkIndex& chunk) const;

  Config config_;
  AppendFile file_;
  std::uint32_t crc_ = 0;  ///< Of every byte appended so far.
  McapSummary summary_;
  McapBytes records_;  ///< The current chunk's messages,
  McapTimeRange chunk_time_;
  std::vector<std::vector<IndexEntry>> chunk_index_;  ///< and where they are, by channel.
};

}  // namespace flexura
