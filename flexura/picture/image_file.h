#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "flexura/base/image.h"

namespace flexura {

/// Compression of a PNG file.
struct PngConfig {
  int level = 6;  ///< Compression effort, from 1 (fastest) to 9 (smallest file).
};

/// Returns the bytes of a PNG file: gray (one channel) or RGB (three channels), 8 or 16 bits per value,
/// without a colour profile. Equal pictures give equal bytes. Throws std::invalid_argument for a picture
/// without pixels or with another number of channels.
[[nodiscard]] std::string png(const Image<std::uint8_t>& image, PngConfig config = {});
[[nodiscard]] std::string png(const Image<std::uint16_t>& image, PngConfig config = {});

/// Reads the picture in a file. The file's first bytes identify its kind:
///
/// - `PNG`: 1 to 16 bits per value, interlaced or not.
/// - `JPEG`: gray, colour or four inks (CMYK, YCCK; inverted, as introduced by Adobe), also progressive.
/// - `TIFF`: its first page, in gray, RGB or a palette (1 to 16 bits per value), or CMYK, YCbCr or CIELab (in
///   bytes). Such files have strips or tiles, and any compression of libtiff except JBIG and the old JPEG
///   format of before 1995.
/// - `PNM`: P1 to P6.
///
/// The result has one channel for gray, including palettes of only grays, and otherwise three channels (red,
/// green, blue). Values with up to 8 bits are scaled to 0 to 255. Values with more bits are as in the file,
/// stored in 16 bits. The picture is upright: the
/// orientation in EXIF data (JPEG, PNG) or TIFF tags is applied. Alpha and colour profile are ignored.
/// Transparent parts keep their colour. For other common kinds (BMP, WebP, JPEG 2000, OpenEXR, ...), the
/// error message states the kind.
///
/// Throws InputError with one line, which begins with `name`, if the file is of another kind, truncated,
/// damaged or without pixels. Also throws InputError for more than `most_pixels` pixels, before allocating
/// memory for them. Writes nothing to standard error. Thread-safe.
[[nodiscard]] Picture read_picture(std::span<const std::uint8_t> file, const std::string& name,
                                   std::size_t most_pixels);

/// Reads a PNG file. Throws std::runtime_error for other files.
[[nodiscard]] Picture read_png(std::string_view bytes, std::size_t most_pixels = std::size_t{1} << 26);

/// Compression of a JPEG file.
struct JpegConfig {
  int quality = 80;  ///< Quality, from 1 to 100 (best).
};

/// Returns the bytes of a baseline JPEG file: gray (one channel) or RGB (three channels). Equal pictures give
/// equal bytes. Throws std::invalid_argument for a picture without pixels, with more than 65500 pixels per
/// side or with another number of channels. Also throws std::invalid_argument for an invalid quality.
[[nodiscard]] std::string jpeg(const Image<std::uint8_t>& image, JpegConfig config = {});

/// Returns the bytes of a TIFF file: 32-bit floating point values, one or more channels, lossless (zlib).
/// Equal pictures give equal bytes. Throws std::invalid_argument for a picture without pixels.
[[nodiscard]] std::string tiff(const Image<float>& image);

}  // namespace flexura
