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
  Image<std::uint8_t>
      bytes;  ///< Picture with 8 bits per value. If the file has more bits, these are the upper 8 bits.
  Image<std::uint16_t> words;  ///< Picture with all bits, if the file has more than 8, otherwise empty.
                               ///< Values are from 0 to `white`, or larger for hot pixels.
  int white = 255;             ///< White level in `words`; 255 if `words` is empty.
  /// Whether the picture has only two values. `bytes` then has 0 and 255 instead, blurred by one pixel.
  bool is_mask = false;
};

/// Smallest standard deviation of positions in a mask, px, due to its pixel steps.
inline constexpr double mask_sigma = 0.1;

/// Maximum number of pixels of a picture.
inline constexpr std::size_t most_pixels = std::size_t{1} << 27;

/// Maximum size of a file, bytes.
inline constexpr std::size_t most_picture_bytes = std::size_t{1} << 29;

/// Decodes a picture file of any kind that read_picture() supports (flexura/picture/image_file.h), with up to
/// 16 bits per value. Transparency is ignored. Throws InputError with the source `name` if the file is not a
/// picture, truncated, damaged, too large, or has an unsupported number of bits.
[[nodiscard]] Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name);

/// Converts a colour picture to gray: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709), rounded.
/// Gamma-encoded values are not decoded before. A gray picture is returned unchanged.
[[nodiscard]] Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture);
[[nodiscard]] Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture);

}  // namespace flexura
