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
  Image<std::uint8_t> bytes;   ///< Always; of more than 8 bits the upper ones.
  Image<std::uint16_t> words;  ///< Empty for 8 bits; values from 0 to `white`, of hot pixels more.
  int white = 255;             ///< What counts as white in `words`; 255 where there are none.
  /// It has two values only: `bytes` has 0 and 255 for them, blurred by a pixel.
  bool is_mask = false;
};

/// No place in a mask is known better, px: its staircase leaves as much, whatever its noise says.
inline constexpr double mask_sigma = 0.1;

/// Larger pictures are refused, px.
inline constexpr std::size_t most_pixels = std::size_t{1} << 27;

/// Larger files are refused, bytes.
inline constexpr std::size_t most_picture_bytes = std::size_t{1} << 29;

/// Reads every kind of file, up to 16 bits a value, that read_picture() does (flexura/picture/image_file.h);
/// a transparent part counts as it is coloured. Throws InputError, with `name` for its source: not a picture,
/// cut short, damaged, of another depth, too large.
[[nodiscard]] Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name);

/// The brightness of a picture, rounded: 0.2126 red + 0.7152 green + 0.0722 blue (ITU-R BT.709) of its values
/// as they are, gamma and all. A gray one comes back as it is.
[[nodiscard]] Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture);
[[nodiscard]] Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture);

}  // namespace flexura
