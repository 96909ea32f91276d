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

/// Writes a new log (docs/log-format.md): messages on channels, collected into chunks. A full chunk is passed
/// to the operating system in one write. If the process is killed, the log is therefore readable up to its
/// last complete chunk. Equal calls give equal bytes if the version of libzstd is equal. Every call that
/// writes throws std::system_error with the path on a system error, such as a full disk. The content written
/// before remains readable, and the writer accepts no more messages.
class McapWriter {
 public:
  /// Layout of the file.
  struct Config {
    /// A chunk is closed when its messages reach this number of bytes (1 to 2^30). A larger message is a
    /// separate chunk.
    std::size_t chunk_size = std::size_t{256} * 1024;
    /// Whether to compress a chunk by zstd if this makes the chunk smaller.
    bool compress = true;
  };

  /// Creates the file. Never overwrites an existing file. Throws std::system_error with the path if the file
  /// already exists or cannot be created, and std::invalid_argument for a chunk size out of range.
  explicit McapWriter(const std::filesystem::path& path) : McapWriter(path, Config{}) {}
  McapWriter(const std::filesystem::path& path, Config config);
  /// Closes the log and ignores failures. Call close() to detect failures.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Returns the new channel's number, counted from 1. Channels with equal schemas share one schema record.
  /// Throws std::invalid_argument if the topic is empty or exists, std::length_error beyond 65535 channels.
  std::uint16_t add_channel(McapChannel channel);

  /// Adds a message. `log_time` is simulated time in ns and need not increase. Throws std::out_of_range for a
  /// channel that add_channel did not return.
  void write(std::uint16_t channel, std::uint64_t log_time, std::span<const std::byte> data);
  /// Adds a message from text.
  void write(std::uint16_t channel, std::uint64_t log_time, std::string_view text) {
    write(channel, log_time, std::as_bytes(std::span(text)));
  }

  /// Closes the current chunk if it has a message.
  void flush();
  /// Ends the log with its summary. Later calls, except close(), throw std::logic_error.
  void close();

 private:
  struct IndexEntry {
    std::uint64_t time, offset;  ///< Log time, ns, and position from the start of the chunk's records, bytes.
  };

  void append(const McapBytes& out);
  void require_open() const;
  /// Appends the current chunk to `out` and completes the chunk's entry in the summary.
  void put_chunk(McapBytes& out, McapChunkIndex& chunk) const;
  void put_message_indexes(McapBytes& out, McapChunkIndex& chunk) const;

  Config config_;
  AppendFile file_;
  std::uint32_t crc_ = 0;  ///< CRC of all bytes appended so far.
  McapSummary summary_;
  McapBytes records_;  ///< Messages of the current chunk.
  McapTimeRange chunk_time_;
  std::vector<std::vector<IndexEntry>> chunk_index_;  ///< Positions of the chunk's messages, by channel.
};

}  // namespace flexura
