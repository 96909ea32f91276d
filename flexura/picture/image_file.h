#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "flexura/base/image.h"

namespace flexura {

/// How hard to look for a shorter file: 1, quick, to 9.
struct PngConfig {
  int level = 6;
};

/// A PNG file's bytes: gray (one channel) or RGB (three), 8 or 16 bits a value, no colour profile. The same
/// picture gives the same bytes. std::invalid_argument: no pixels, another number of channels.
[[nodiscard]] std::string png(const Image<std::uint8_t>& image, PngConfig config = {});
[[nodiscard]] std::string png(const Image<std::uint16_t>& image, PngConfig config = {});

/// The picture in a PNG file of gray or RGB with 8 or 16 bits a value, without a palette. std::runtime_error
/// for anything else, damaged files among them, and for more than `most_pixels`.
[[nodiscard]] std::variant<Image<std::uint8_t>, Image<std::uint16_t>> read_png(
    std::string_view bytes, std::size_t most_pixels = std::size_t{1} << 26);

/// How much of a picture to keep: 1 to 100.
struct JpegConfig {
  int quality = 80;
};

/// A JPEG file's bytes (baseline): gray (one channel) or RGB (three). The same picture gives the same bytes.
/// std::invalid_argument: no pixels or more than 65500 a side, another number of channels, a quality that is
/// none.
[[nodiscard]] std::string jpeg(const Image<std::uint8_t>& image, JpegConfig config = {});

/// A TIFF file's bytes: 32-bit floating point values, one or more channels, lossless (zlib). The same picture
/// gives the same bytes. std::invalid_argument: no pixels.
[[nodiscard]] std::string tiff(const Image<float>& image);

}  // namespace flexura
