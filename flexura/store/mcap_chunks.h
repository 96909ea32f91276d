#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "flexura/store/zstd.h"

namespace flexura {

/// A compressed chunk decompresses to at most this number of bytes; the writer leaves larger ones plain.
inline constexpr std::size_t mcap_most_chunk = std::size_t{128} << 20;

/// The places of a log's messages: the file, and its compressed chunks. Decompresses a chunk when a message
/// of it is read, and keeps the last few. Threads may read at once.
class McapChunks {
 public:
  /// `file`: the log, which must outlive this object; `name` identifies it in errors.
  McapChunks(std::span<const std::byte> file, std::string name) : file_(file), name_(std::move(name)) {}

  /// The number of the file itself, for messages that are not compressed.
  static constexpr std::uint32_t plain = 0;

  /// Adds a chunk of zstd frames with `size` bytes of content. Returns its number, from 1.
  std::uint32_t add(std::span<const std::byte> frames, std::size_t size);
  /// Returns the content of a chunk that was added. Throws std::runtime_error if it does not decompress to
  /// the size given.
  [[nodiscard]] std::shared_ptr<const ByteBuffer> content(std::uint32_t chunk) const;
  /// Returns a part of a chunk's content, or of the file, which must contain it. Throws std::runtime_error if
  /// the chunk does not decompress.
  [[nodiscard]] std::string text(std::uint32_t chunk, std::size_t offset, std::size_t size) const;

 private:
  struct Chunk {
    std::span<const std::byte> frames;
    std::size_t size;
  };
  struct Held {
    std::uint32_t chunk;
    std::shared_ptr<const ByteBuffer> content;
  };

  std::span<const std::byte> file_;
  std::string name_;
  std::vector<Chunk> chunks_;
  mutable std::mutex mutex_;        // Of held_.
  mutable std::vector<Held> held_;  // The last ones used, newest last.
};

}  // namespace flexura
