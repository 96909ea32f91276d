#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flexura/base/image.h"

namespace flexura {

/// A picture from a file: gray or red, green, blue.
struct Photograph {
  Image<std::uint8_t> bytes;   ///< Always set; of more than 8 bits the upper ones.
  Image<std::uint16_t> words;  ///< Empty for 8 bits; values from 0 to `white`, larger for hot pixels.
  int white = 255;             ///< White level in `words`; 255 if there are none.
  /// Whether it has two values only: `bytes` has 0 and 255 for them, blurred by a pixel.
  bool is_mask = false;
};

/// Smallest standard deviation of positions in a mask, px: the error of its staircase.
inline constexpr double mask_sigma = 0.1;

/// Maximum number of pixels of a picture.
inline constexpr std::size_t most_pixels = std::size_t{1} << 27;

/// Maximum size of a file, bytes.
inline constexpr std::size_t most_picture_bytes = std::size_t{1} << 29;

/// Decodes every kind of file, up to 16 bits per value, that read_picture() supports
/// (flexura/picture/image_file.h); transparency is ignored. Throws InputError with the source `name` if the
/// file is not a picture, truncated, damaged, of another depth, or too large.
[[nodiscard]] Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name);

/// Returns the brightness of a picture, rounded: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709) of
/// its values, without undoing a gamma. A gray picture is returned unchanged.
[[nodiscard]] Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture);
[[nodiscard]] Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture);

}  // namespace flexura
