#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/store/mcap_chunks.h"
#include "flexura/store/mcap_file.h"
#include "flexura/store/mcap_records.h"

namespace flexura {

/// One message of a log. The message is valid as long as its McapReader exists.
struct McapMessage {
  const McapChannel* channel;
  std::uint64_t log_time;  ///< Simulated time, ns.
  std::uint32_t sequence;  ///< Sequence number of the message, set by the writer, modulo 2^32.
  std::uint32_t chunk;     ///< Number of the compressed chunk with the message's data, or McapChunks::plain.
  const McapChunks* chunks;  ///< Chunks of the reader.
  std::size_t offset;        ///< Start of the data in the chunk or in the file.
  std::size_t size;          ///< Size of the data, bytes.

  /// Returns the data as written: JSON in the logs of runs. Decompresses the message's chunk, unless this
  /// chunk is among the last few that were used. Reading messages in the file's order is therefore fast.
  /// Several threads may call this function at once. Throws std::runtime_error if the file has become
  /// shorter or a chunk has changed since it was opened.
  [[nodiscard]] std::string text() const { return chunks->text(chunk, offset, size); }
};

/// How to handle damage. `crc`: checksums are verified, and any damage is an error. `structure`: only the
/// structure is verified; all messages of a damaged log with intact structure are read. `skip`: as `crc`, but
/// damaged chunks are skipped and listed in McapReader::damage().
enum class McapCheck : std::uint8_t { crc, structure, skip };

/// A damaged chunk.
struct McapDamage {
  std::uint64_t from = 0, to = 0;  ///< Times of its first and last message according to its header, ns.
  std::string what;                ///< Error message, with the byte in the log.
};

/// Reads a whole log that Flexura or another program wrote. An McapReader reads the data section of the log
/// from start to end. Chunks may be plain or compressed by zstd. Memory grows only with the number of
/// messages: plain data remain in the mapped file, and only a few decompressed chunks are kept. If the writer
/// of a log was killed, the log is read up to its last complete chunk, and `truncated` is set. Constructors
/// throw std::runtime_error with the log's name and the byte of the error. Errors are a file that is not a
/// log, a record that extends beyond its chunk or the file, a wrong CRC, a message without channel, and an
/// unknown compression. Further errors are a chunk that does not decompress to its stated size, and a size
/// above mcap_most_chunk. Compressed chunks must not have more than 64 MiB and 256 times the file's size in
/// total.
class McapReader {
 public:
  /// Throws std::system_error if the file cannot be read.
  explicit McapReader(const std::filesystem::path& path, McapCheck check = McapCheck::crc);
  /// `bytes` must outlive the reader. `name`: name of the log in errors.
  McapReader(std::span<const std::byte> bytes, const std::string& name, McapCheck check = McapCheck::crc);

  /// Returns the channels by their identifiers.
  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  /// Returns the messages in the file's order, which may differ from the order of time.
  [[nodiscard]] const std::vector<McapMessage>& messages() const { return messages_; }
  /// Returns the name of the program that wrote the log, from its header.
  [[nodiscard]] const std::string& library() const { return library_; }
  [[nodiscard]] bool truncated() const { return truncated_; }
  /// Returns the chunks that were skipped, in the file's order; only with McapCheck::skip.
  [[nodiscard]] const std::vector<McapDamage>& damage() const { return damage_; }

 private:
  friend class McapScan;

  std::unique_ptr<const MappedFile> file_;
  std::unique_ptr<McapChunks> chunks_;             // At a fixed place, because messages point to it.
  std::map<std::uint16_t, McapChannel> channels_;  // A map, because messages point into it.
  std::vector<McapMessage> messages_;
  std::string library_;
  bool truncated_ = false;
  std::vector<McapDamage> damage_;
};

}  // namespace flexura
