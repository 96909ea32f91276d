#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "flexura/store/mcap_file.h"
#include "flexura/store/zstd.h"

namespace flexura {

/// Largest decompressed size of a compressed chunk, bytes. The writer does not compress larger chunks.
inline constexpr std::size_t mcap_most_chunk = std::size_t{128} << 20;

/// Gives access to the messages in a log file and in its compressed chunks. Decompresses a chunk when one of
/// its messages is read, and keeps the last few decompressed chunks. Several threads may read at once.
class McapChunks {
 public:
  /// `file`: the log, which must outlive this object. `name`: name of the log in errors. `mapped`: the file,
  /// if the log is mapped; null otherwise.
  McapChunks(std::span<const std::byte> file, std::string name, const MappedFile* mapped = nullptr)
      : file_(file), name_(std::move(name)), mapped_(mapped) {}

  /// Chunk number of uncompressed messages, which are read directly from the file.
  static constexpr std::uint32_t plain = 0;

  /// Adds a chunk of zstd frames with `size` bytes of content. Returns the number of the chunk, from 1.
  std::uint32_t add(std::span<const std::byte> frames, std::size_t size);
  /// Returns the content of a chunk. Throws std::runtime_error if the chunk does not decompress to the size
  /// given to add().
  [[nodiscard]] std::shared_ptr<const ByteBuffer> content(std::uint32_t chunk) const;
  /// Returns a part of a chunk's content or of the file. The part must be within this content. Throws
  /// std::runtime_error if the chunk does not decompress.
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
  const MappedFile* mapped_;
  std::vector<Chunk> chunks_;
  mutable std::mutex mutex_;        // Of held_.
  mutable std::vector<Held> held_;  // The last ones used, newest last.
};

}  // namespace flexura
