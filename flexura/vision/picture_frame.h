#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// A rectangle of a picture: columns [left, right), rows [top, bottom), px.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;

  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
};

/// Returns the part of a picture inside a frame. A frame is a strip of one brightness class along two
/// opposite sides, at most an eighth of the picture wide, behind which the other class begins over most of
/// the side. `level` separates the classes. Without a frame, returns the whole picture.
[[nodiscard]] PixelBox inside_frame(const Image<std::uint8_t>& gray, double level);

/// Sets `part` to a rectangle of a picture with one channel. Keeps the memory of `part`.
template <typename Value>
void cut_out(const Image<Value>& picture, const PixelBox& box, Image<Value>& part);

extern template void cut_out(const Image<std::uint8_t>&, const PixelBox&, Image<std::uint8_t>&);
extern template void cut_out(const Image<std::uint16_t>&, const PixelBox&, Image<std::uint16_t>&);

}  // namespace flexura
