#pragma once

#include <cstdint>
#include <span>

#include "flexura/picture/image_file.h"

namespace flexura {

/// Returns the orientation (1 to 8) of a picture file, from the EXIF data of a JPEG or PNG file or from the
/// tags of a TIFF file. The orientation 1 means that the file's first row is the picture's top. Returns 1 for
/// a missing or damaged orientation.
[[nodiscard]] int orientation_in(std::span<const std::uint8_t> file);

/// Returns the upright picture of one that a file stores with this orientation.
[[nodiscard]] Picture upright(Picture picture, int orientation);

}  // namespace flexura
