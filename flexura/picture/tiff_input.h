#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "flexura/base/image.h"

namespace flexura {

/// A TIFF file in memory for libtiff, and the first error.
struct TiffInput {
  std::span<const std::uint8_t> bytes;
  std::uint64_t at = 0;
  bool is_cut_short = false;  ///< Whether a read went beyond the end.
  char text[200] = {};        ///< libtiff's first error.

  /// Returns the exception to throw when libtiff failed.
  [[nodiscard]] std::runtime_error problem() const;
};

struct CloseTiff {
  void operator()(TIFF* open) const { TIFFClose(open); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

/// Opens the first picture of `input`, which must outlive it. libtiff prints nothing, and allocates at most
/// `most_bytes` at once. Throws std::runtime_error if it is not a TIFF file.
[[nodiscard]] OpenTiff open_tiff(TiffInput* input, std::size_t most_bytes);

/// Reads red, green and blue as converted by libtiff, for files with other colours, in bytes. Sizes must have
/// been checked. Throws std::runtime_error for a damaged file, or a form that libtiff does not convert.
[[nodiscard]] Image<std::uint8_t> read_mixed_tiff(TIFF* open, const TiffInput& input);

}  // namespace flexura
