#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "flexura/base/image.h"

namespace flexura {

/// A gray or colour picture from a file.
struct Photograph {
  Image<std::uint8_t>
      bytes;  ///< Picture with 8 bits per value. If the file has more bits, these are the upper 8 bits.
  /// Picture with all bits of its values; empty if the file has at most 8 bits. Values are from 0 to `white`;
  /// hot pixels may exceed `white`.
  Image<std::uint16_t> words;
  int white = 255;  ///< White level in `words`; 255 if `words` is empty.
  /// Whether the picture has only two values. `bytes` then has the values 0 and 255, blurred by one pixel.
  bool is_mask = false;
};

/// Smallest standard deviation of positions in a mask, px: the error due to whole pixels.
inline constexpr double mask_sigma = 0.1;

/// Maximum number of pixels of a picture.
inline constexpr std::size_t most_pixels = std::size_t{1} << 27;

/// Maximum size of a file, bytes.
inline constexpr std::size_t most_picture_bytes = std::size_t{1} << 29;

/// Decodes a picture file of any kind that read_picture() supports (flexura/picture/image_file.h), with up to
/// 16 bits per value. Transparency is ignored. Throws InputError with the source `name` if the file is not a
/// picture, truncated, damaged, too large, or has an unsupported number of bits.
[[nodiscard]] Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name);

/// Converts a colour picture to gray: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709), rounded. Uses
/// gamma-encoded values without decoding. Returns a gray picture unchanged.
[[nodiscard]] Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture);
[[nodiscard]] Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture);

}  // namespace flexura
