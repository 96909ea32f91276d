#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flexura/base/image.h"

namespace flexura {

/// What a BMP file says before its pixels.
struct BmpHeader {
  std::int64_t width = 0, height = 0;
  bool is_top_first = false;
  bool is_in_runs = false;                                        ///< RLE4 or RLE8, by `bits`.
  std::size_t bits = 0;                                           ///< A pixel.
  std::array<std::uint32_t, 3> fields = {};                       ///< Of 16 or 32 bits: red, green, blue.
  std::size_t pixels = 0;                                         ///< Where they begin.
  std::size_t palette = 0, palette_size = 0, palette_colors = 0;  ///< Where; bytes a colour.
};

/// std::runtime_error: cut short, damaged, or of a form that is not read. The size is not judged.
[[nodiscard]] BmpHeader read_bmp_header(std::span<const std::uint8_t> file);

/// The indices that runs (RLE4, RLE8) stand for; 0 where they leave a pixel out. std::runtime_error: cut
/// short, or a run that does not fit into its row.
[[nodiscard]] Image<std::uint8_t> read_bmp_runs(std::span<const std::uint8_t> runs, const BmpHeader& header);

}  // namespace flexura
