#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace flexura {

/// Returns the bytes compressed into one frame of Zstandard (RFC 8878). Equal bytes give equal frames if the
/// version of libzstd is equal. Throws std::runtime_error if libzstd fails.
[[nodiscard]] std::vector<std::byte> zstd(std::span<const std::byte> bytes);

/// Bytes in memory that are not initialised. The system provides physical memory only for bytes that are
/// written.
struct ByteBuffer {
  std::unique_ptr<std::byte[]> start;  ///< May be null if `size` is 0.
  std::size_t size = 0;                ///< In bytes.

  /// Returns the bytes; valid as long as the buffer.
  [[nodiscard]] std::span<const std::byte> bytes() const { return {start.get(), size}; }
};

/// Returns the content of frames of Zstandard that must decompress to exactly `size` bytes. The function
/// never writes more than `size` bytes. Before allocating memory, the function refuses a size that the frames
/// cannot contain. Throws std::runtime_error with the reason for invalid frames.
[[nodiscard]] ByteBuffer unzstd(std::span<const std::byte> frames, std::size_t size);

}  // namespace flexura
