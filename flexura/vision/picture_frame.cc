#include "flexura/vision/picture_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace flexura {
namespace {

enum class FrameSide { left, right, top, bottom };

// Returns the share of bright pixels in the line `depth` px inside a side of the picture.
double bright_share_of(const Image<std::uint8_t>& gray, FrameSide side, int depth, double level) {
  const bool is_column = side == FrameSide::left || side == FrameSide::right;
  const bool is_first = side == FrameSide::left || side == FrameSide::top;
  const int length = is_column ? gray.height() : gray.width(),
            lines = is_column ? gray.width() : gray.height();
  const int line = is_first ? depth : lines - 1 - depth;
  int bright = 0;
  for (int i = 0; i < length; ++i)
    bright += (is_column ? gray.at(line, i) : gray.at(i, line)) >= level ? 1 : 0;
  return static_cast<double>(bright) / length;
}

// Returns the width of the frame at one side, px; 0 without a frame. The line between frame and picture may
// have a brightness of its own.
int frame_at(const Image<std::uint8_t>& gray, FrameSide side, double level) {
  constexpr double all = 0.98, most = 0.9, few = 0.3;
  constexpr int widest_part = 8, between = 3;
  const int deepest = std::min(gray.width(), gray.height()) / widest_part;
  const double outside = bright_share_of(gray, side, 0, level);
  if (deepest < 1 || (outside < all && outside > 1 - all)) return 0;
  const auto share = [&](int depth) {
    const double bright = bright_share_of(gray, side, depth, level);
    return outside >= all ? bright : 1 - bright;
  };
  // Plain pictures have more of the ground here, too.
  if (share(deepest) > few) return 0;
  int mixed = 0;
  for (int depth = 1; depth <= deepest; ++depth) {
    const double here = share(depth);
    if (here <= few) return depth;
    if (here < most && ++mixed > between) return 0;
  }
  return 0;
}

}  // namespace

PixelBox inside_frame(const Image<std::uint8_t>& gray, double level) {
  PixelBox box{0, 0, gray.width(), gray.height()};
  // The frame's blur reaches a pixel or two farther.
  constexpr int blurred = 2;
  const int left = frame_at(gray, FrameSide::left, level);
  const int right = left > 0 ? frame_at(gray, FrameSide::right, level) : 0;
  if (left > 0 && right > 0) box.left += left + blurred, box.right -= right + blurred;
  const int top = frame_at(gray, FrameSide::top, level);
  const int bottom = top > 0 ? frame_at(gray, FrameSide::bottom, level) : 0;
  if (top > 0 && bottom > 0) box.top += top + blurred, box.bottom -= bottom + blurred;
  return box;
}

template <typename Value>
void cut_out(const Image<Value>& picture, const PixelBox& box, Image<Value>& part) {
  if (part.width() != box.width() || part.height() != box.height())
    part = Image<Value>(box.width(), box.height());
  for (int v = 0; v < box.height(); ++v) {
    const auto from = picture.row(box.top + v)
                          .subspan(static_cast<std::size_t>(box.left), static_cast<std::size_t>(box.width()));
    std::ranges::copy(from, part.row(v).begin());
  }
}

template void cut_out(const Image<std::uint8_t>&, const PixelBox&, Image<std::uint8_t>&);
template void cut_out(const Image<std::uint16_t>&, const PixelBox&, Image<std::uint16_t>&);

}  // namespace flexura
