#include "flexura/equipment/v4l2_picture.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "flexura/base/problems.h"
#include "flexura/picture/image_file.h"

namespace flexura {
namespace {

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

Image<std::uint8_t> with_channels(Image<std::uint8_t> image, int channels) {
  if (image.channels() == channels) return image;
  Image<std::uint8_t> result(image.width(), image.height(), channels);
  const auto from = image.values();
  const auto to = result.values();
  const std::size_t count = from.size() / static_cast<std::size_t>(image.channels());
  for (std::size_t i = 0; i < count; ++i) {
    if (channels == 3)
      std::fill_n(&to[3 * i], 3, from[i]);
    else
      to[i] = byte_of(0.299 * from[3 * i] + 0.587 * from[3 * i + 1] + 0.114 * from[3 * i + 2]);
  }
  return result;
}

// Converts a pair of pixels, Y0 Cb Y1 Cr.
struct FromYuyv {
  double offset, scale, blue_scale, red_scale, blue_in_green, red_in_green;
  explicit FromYuyv(const V4l2Layout& layout)
      : offset(layout.is_full_range ? 0 : 16), scale(layout.is_full_range ? 1 : 255.0 / 219) {
    const double color_scale = layout.is_full_range ? 1 : 255.0 / 224;
    const double green_share = 1 - layout.red_share - layout.blue_share;
    blue_scale = 2 * color_scale * (1 - layout.blue_share);
    red_scale = 2 * color_scale * (1 - layout.red_share);
    blue_in_green = blue_scale * layout.blue_share / green_share;
    red_in_green = red_scale * layout.red_share / green_share;
  }

  void row(const std::uint8_t* from, std::span<std::uint8_t> to, int width, int channels) const {
    for (int u = 0; u < width; ++u) {
      const std::uint8_t* pair = from + std::ptrdiff_t{4} * std::ptrdiff_t{u / 2};
      const double light = scale * (pair[u % 2 == 0 ? 0 : 2] - offset);
      if (channels == 1) {
        to[static_cast<std::size_t>(u)] = byte_of(light);
        continue;
      }
      const double blue = pair[1] - 128, red = pair[3] - 128;
      const auto at = 3 * static_cast<std::size_t>(u);
      to[at] = byte_of(light + red_scale * red);
      to[at + 1] = byte_of(light - blue_in_green * blue - red_in_green * red);
      to[at + 2] = byte_of(light + blue_scale * blue);
    }
  }
};

std::optional<Image<std::uint8_t>> unpacked(std::span<const std::uint8_t> bytes, const V4l2Layout& layout,
                                            int channels) {
  Picture picture;
  try {
    const auto pixels = static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height);
    picture = read_picture(bytes, "frame", pixels);
  } catch (const InputError&) {
    return std::nullopt;
  }
  auto* image = std::get_if<Image<std::uint8_t>>(&picture);
  if (image == nullptr || image->width() != layout.width || image->height() != layout.height)
    return std::nullopt;
  return with_channels(std::move(*image), channels);
}

std::size_t bytes_per_pixel(std::uint32_t format) {
  if (format == V4L2_PIX_FMT_RGB24) return 3;
  return format == V4L2_PIX_FMT_YUYV ? 2 : 1;
}

}  // namespace

std::optional<Image<std::uint8_t>> v4l2_picture(std::span<const std::uint8_t> bytes, const V4l2Layout& layout,
                                                int channels) {
  if (layout.width <= 0 || layout.height <= 0) return std::nullopt;
  if (layout.format == V4L2_PIX_FMT_MJPEG || layout.format == V4L2_PIX_FMT_JPEG)
    return unpacked(bytes, layout, channels);
  // A pair of pixels of YUYV is whole at the end of a row of odd width, too.
  const bool is_yuyv = layout.format == V4L2_PIX_FMT_YUYV;
  const auto width =
      static_cast<std::size_t>(layout.width) + (is_yuyv ? static_cast<std::size_t>(layout.width % 2) : 0);
  const std::size_t used = width * bytes_per_pixel(layout.format);
  const std::size_t stride = layout.stride == 0 ? used : layout.stride;
  const auto rows = static_cast<std::size_t>(layout.height);
  if (stride < used || bytes.size() < stride * (rows - 1) + used) return std::nullopt;
  const int stored = layout.format == V4L2_PIX_FMT_RGB24 ? 3 : 1;
  Image<std::uint8_t> image(layout.width, layout.height, is_yuyv ? channels : stored);
  const FromYuyv convert(layout);
  for (int v = 0; v < layout.height; ++v) {
    const std::uint8_t* from = bytes.data() + static_cast<std::size_t>(v) * stride;
    if (is_yuyv)
      convert.row(from, image.row(v), layout.width, channels);
    else
      std::copy_n(from, image.row(v).size(), image.row(v).begin());
  }
  return with_channels(std::move(image), channels);
}

}  // namespace flexura
