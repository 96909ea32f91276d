#pragma once

#include <cstdint>
#include <string>

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

/// A TIFF file's bytes: 32-bit floating point values, one or more channels, lossless (zlib). The same picture
/// gives the same bytes. std::invalid_argument: no pixels.
[[nodiscard]] std::string tiff(const Image<float>& image);

}  // namespace flexura
