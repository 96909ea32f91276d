#include "flexura/app/picture_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexura {

std::optional<std::string> doubt_of_size(const View& view) {
  const Intrinsics lens = view.lens.intrinsics();
  const auto is_aside = [](double at, int size) { return at < 0.3 * size || at > 0.7 * size; };
  if (!is_aside(lens.cx, view.width) && !is_aside(lens.cy, view.height)) return std::nullopt;
  // In whose middle the principal point would be, if that is a picture of the same shape.
  const double width = 2 * lens.cx + 1, height = 2 * lens.cy + 1, factor = width / view.width;
  constexpr double alike = 0.2;
  const bool is_scaled = factor > 0 && std::abs(height / (factor * view.height) - 1) < alike;
  return fmt::format(
      "the principal point ({:.4g}, {:.4g}) is far from the middle of this picture of {} x {} px: is the "
      "camera's description one for pictures of another size{}?",
      lens.cx, lens.cy, view.width, view.height,
      is_scaled ? fmt::format(", {:.3g} times as large", factor) : "");
}

std::optional<std::string> doubt_of_exposure(const Photograph& picture, const Image<std::uint8_t>& gray) {
  constexpr double most = 0.1, percent = 100;
  const auto values = gray.values();
  const double share =
      static_cast<double>(std::ranges::count(values, 255)) / static_cast<double>(values.size());
  if (picture.is_mask || share <= most) return std::nullopt;
  return fmt::format("{:.0f} % of the picture is saturated: borders beside that are seen aside, expose less",
                     percent * share);
}

}  // namespace flexura
