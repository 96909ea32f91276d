#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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

/// The picture in a file of any of these kinds, told apart by their first bytes:
/// - PNG, 1 to 16 bits a value, interlaced or not;
/// - JPEG of gray, colours or four inks (CMYK, YCCK; inverted, as Adobe began it), progressive too;
/// - TIFF (its first page) of gray, RGB or a palette, 1 to 16 bits a value, or of CMYK, YCbCr or CIELab in
///   bytes, in strips or tiles, compressed in any way that libtiff reads but JBIG and the JPEG of before
///   1995;
/// - PNM (P1 to P6).
///
/// One channel for gray, and for a palette of grays alone; three (red, green, blue) for colours. Up to 8 bits
/// give bytes from 0 to 255; more give words as they stand in the file. Nothing is turned, whatever the file
/// says of its orientation; a transparent part is as it is coloured, alpha is left out; colour profiles count
/// for nothing. Other common kinds (BMP, WebP, JPEG 2000, OpenEXR, ...) are refused by their names.
///
/// Throws InputError of `name` with one line: of no such kind, cut short, damaged, without pixels or with
/// more than `most_pixels` (nothing is allocated for those). Writes nothing to standard error, and may be
/// called by several threads at once.
[[nodiscard]] Picture read_picture(std::span<const std::uint8_t> file, const std::string& name,
                                   std::size_t most_pixels);

/// The same of a PNG file alone. std::runtime_error for anything else.
[[nodiscard]] Picture read_png(std::string_view bytes, std::size_t most_pixels = std::size_t{1} << 26);

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
