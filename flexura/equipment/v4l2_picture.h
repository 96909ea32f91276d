#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "flexura/base/image.h"

namespace flexura {

/// Layout of a video device's pictures.
struct V4l2Layout {
  std::uint32_t format = 0;  ///< V4L2_PIX_FMT_GREY, _YUYV, _RGB24 or _MJPEG.
  int width = 0, height = 0;
  std::size_t stride = 0;  ///< Bytes from one row to the next; 0: without gaps.
  /// Whether the brightness of YUYV uses all values, 0 to 255; otherwise 16 to 235.
  bool is_full_range = false;
  /// Shares of red and blue in the brightness of YUYV; default: the shares of ITU-R BT.601.
  double red_share = 0.299, blue_share = 0.114;
};

/// Returns a device's picture with one channel (gray) or three (color). Returns std::nullopt for a picture
/// that is too short, damaged, or of another size. The brightness of a color is computed by ITU-R BT.601.
[[nodiscard]] std::optional<Image<std::uint8_t>> v4l2_picture(std::span<const std::uint8_t> bytes,
                                                              const V4l2Layout& layout, int channels);

}  // namespace flexura
