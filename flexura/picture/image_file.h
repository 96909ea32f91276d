#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "flexura/base/image.h"

namespace flexura {

/// Compression effort: from 1 (fast) to 9.
struct PngConfig {
  int level = 6;
};

/// Returns the bytes of a PNG file: gray (one channel) or RGB (three), 8 or 16 bits per value, no colour
/// profile. Equal pictures give equal bytes. Throws std::invalid_argument for no pixels, or another number of
/// channels.
[[nodiscard]] std::string png(const Image<std::uint8_t>& image, PngConfig config = {});
[[nodiscard]] std::string png(const Image<std::uint16_t>& image, PngConfig config = {});

/// Reads the picture in a file of any of these kinds, identified by its first bytes.
///
/// - `PNG`: 1 to 16 bits per value, interlaced or not.
/// - `JPEG`: gray, colour or four inks (CMYK, YCCK; inverted, as introduced by Adobe), also progressive.
/// - `TIFF`: its first page, in gray, RGB or a palette (1 to 16 bits per value), or CMYK, YCbCr or CIELab (in
///   bytes). Strips or tiles, with every compression of libtiff except JBIG and the JPEG of before 1995.
/// - `PNM`: P1 to P6.
///
/// The result has one channel for gray, and for a palette of grays alone; three (red, green, blue) for
/// colours. Up to 8 bits give bytes from 0 to 255; more give words as in the file. The file's orientation,
/// alpha and colour profiles are ignored; transparent parts keep their colour. Other common kinds (BMP, WebP,
/// JPEG 2000, OpenEXR, ...) are refused with their names.
///
/// Throws InputError for `name` with one line if the file is of another kind, truncated, damaged, without
/// pixels, or has more than `most_pixels` (nothing is allocated for those). Writes nothing to standard error,
/// and is thread-safe.
[[nodiscard]] Picture read_picture(std::span<const std::uint8_t> file, const std::string& name,
                                   std::size_t most_pixels);

/// Reads a PNG file only. Throws std::runtime_error for anything else.
[[nodiscard]] Picture read_png(std::string_view bytes, std::size_t most_pixels = std::size_t{1} << 26);

/// JPEG quality: 1 to 100.
struct JpegConfig {
  int quality = 80;
};

/// Returns the bytes of a JPEG file (baseline): gray (one channel) or RGB (three). Equal pictures give equal
/// bytes. Throws std::invalid_argument for no pixels or more than 65500 per side, another number of channels,
/// or an invalid quality.
[[nodiscard]] std::string jpeg(const Image<std::uint8_t>& image, JpegConfig config = {});

/// Returns the bytes of a TIFF file: 32-bit floating point values, one or more channels, lossless (zlib).
/// Equal pictures give equal bytes. Throws std::invalid_argument for no pixels.
[[nodiscard]] std::string tiff(const Image<float>& image);

}  // namespace flexura
