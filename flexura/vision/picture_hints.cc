#include "flexura/vision/picture_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexura {

std::optional<std::string> hint_of_size(const Lens& lens, int width, int height) {
  const Intrinsics& described = lens.intrinsics();
  const auto is_aside = [](double at, int size) { return at < 0.3 * size || at > 0.7 * size; };
  if (!is_aside(described.cx, width) && !is_aside(described.cy, height)) return std::nullopt;
  // Picture size whose middle is the principal point, if it has the same aspect ratio.
  const double wide = 2 * described.cx + 1, high = 2 * described.cy + 1, factor = wide / width;
  constexpr double alike = 0.2;
  const bool is_scaled = factor > 0 && std::abs(high / (factor * height) - 1) < alike;
  return fmt::format(
      "the principal point ({:.4g}, {:.4g}) is far from the middle of this picture of {} x {} px: is the "
      "camera's description for pictures of another size{}?",
      described.cx, described.cy, width, height,
      is_scaled ? fmt::format(", {:.3g} times as large", factor) : "");
}

std::optional<std::string> hint_of_exposure(const Image<std::uint8_t>& gray) {
  constexpr double most = 0.1, percent = 100;
  const auto values = gray.values();
  const double share =
      static_cast<double>(std::ranges::count(values, 255)) / static_cast<double>(values.size());
  if (!(share > most)) return std::nullopt;
  return fmt::format(
      "{:.0f} % of the picture is saturated: borders next to saturated areas are shifted: use a shorter "
      "exposure",
      percent * share);
}

}  // namespace flexura
