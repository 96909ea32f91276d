#include "flexura/vision/linear_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace flexura {

Photograph linear_light(Photograph picture, double gamma) {
  if (!(gamma > 0) || !std::isfinite(gamma)) throw std::invalid_argument("gamma: expected a number above 0");
  if (gamma == 1 || picture.is_mask) return picture;
  constexpr int full = 65535;
  const bool has_words = !picture.words.values().empty();
  const int white = has_words ? picture.white : 255;
  std::vector<std::uint16_t> light(static_cast<std::size_t>(white) + 1);
  for (std::size_t value = 0; value < light.size(); ++value)
    light[value] = static_cast<std::uint16_t>(
        std::lround(full * std::pow(static_cast<double>(value) / static_cast<double>(white), gamma)));
  Image<std::uint16_t> words(picture.bytes.width(), picture.bytes.height(), picture.bytes.channels());
  const auto to = words.values();
  if (has_words)
    std::ranges::transform(picture.words.values(), to.begin(), [&](std::uint16_t value) {
      return light[std::min<std::size_t>(value, light.size() - 1)];
    });
  else
    std::ranges::transform(picture.bytes.values(), to.begin(),
                           [&](std::uint8_t value) { return light[value]; });
  std::ranges::transform(to, picture.bytes.values().begin(), [](std::uint16_t value) {
    constexpr int step = full / 255;
    return static_cast<std::uint8_t>((value + step / 2) / step);
  });
  picture.words = std::move(words), picture.white = full;
  return picture;
}

}  // namespace flexura
