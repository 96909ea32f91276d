#pragma once

#include <cstdint>
#include <span>

#include "flexura/picture/image_file.h"

namespace flexura {

/// Returns the orientation (1 to 8) that the EXIF data of a JPEG or PNG file, or the tags of a TIFF file,
/// state; 1 if there is none or it is damaged. 1 means that the file's first row is the picture's top.
[[nodiscard]] int orientation_in(std::span<const std::uint8_t> file);

/// Returns the upright picture of one that a file stores with this orientation.
[[nodiscard]] Picture upright(Picture picture, int orientation);

}  // namespace flexura
