#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "flexura/base/image.h"

namespace flexura {

/// A TIFF file in memory, as libtiff reads it, and what it found wrong with it.
struct TiffInput {
  std::span<const std::uint8_t> bytes;
  std::uint64_t at = 0;
  bool is_cut_short = false;  ///< More was asked for than there is.
  char text[200] = {};        ///< libtiff's first error.

  /// What to throw when libtiff failed.
  [[nodiscard]] std::runtime_error problem() const;
};

struct CloseTiff {
  void operator()(TIFF* open) const { TIFFClose(open); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

/// Opens the first picture of `input`, which has to outlive it. libtiff prints nothing, and allocates no more
/// than `most_bytes` at once. std::runtime_error: no TIFF file.
[[nodiscard]] OpenTiff open_tiff(TiffInput* input, std::size_t most_bytes);

/// Red, green and blue as libtiff mixes them: for colours that a file has otherwise, in bytes. The sizes were
/// judged. std::runtime_error: damaged, or of a form that libtiff does not mix.
[[nodiscard]] Image<std::uint8_t> read_mixed_tiff(TIFF* open, const TiffInput& input);

}  // namespace flexura
