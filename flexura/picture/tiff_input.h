#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "flexura/base/image.h"

namespace flexura {

/// A TIFF file in memory, read by libtiff, and libtiff's first error.
struct TiffInput {
  std::span<const std::uint8_t> bytes;
  std::uint64_t at = 0;
  bool is_cut_short = false;  ///< Whether libtiff tried to read beyond the end.
  char text[200] = {};        ///< libtiff's first error.

  /// Returns the exception to throw after a failure of libtiff.
  [[nodiscard]] std::runtime_error problem() const;
};

struct CloseTiff {
  void operator()(TIFF* open) const { TIFFClose(open); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

/// Opens the first picture of `input`, which must outlive the result. libtiff then prints nothing, and
/// allocates at most `most_bytes` bytes at once. Throws std::runtime_error if `input` is not a TIFF file.
[[nodiscard]] OpenTiff open_tiff(TiffInput* input, std::size_t most_bytes);

/// Reads a file with colours other than gray or RGB. libtiff converts them to red, green and blue with 8 bits
/// each. The caller must have checked the size. Throws std::runtime_error for a damaged file, or for colours
/// that libtiff cannot convert.
[[nodiscard]] Image<std::uint8_t> read_mixed_tiff(TIFF* open, const TiffInput& input);

}  // namespace flexura
