#include "flexura/vision/eight_bits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <variant>

namespace flexura {
namespace {

template <typename Value>
Image<std::uint8_t> scaled(const Image<Value>& picture, int white) {
  if (white < 1) throw std::invalid_argument(fmt::format("white level {}: expected at least 1", white));
  Image<std::uint8_t> result(picture.width(), picture.height(), picture.channels());
  const auto from = picture.values();
  const auto to = result.values();
  for (std::size_t i = 0; i < from.size(); ++i)
    to[i] = static_cast<std::uint8_t>(std::min(255, (255 * int{from[i]} + white / 2) / white));
  return result;
}

}  // namespace

Image<std::uint8_t> eight_bits(const Image<std::uint16_t>& picture, int white) {
  return scaled(picture, white);
}

Image<std::uint8_t> eight_bits(const Picture& picture, int white) {
  const auto* bytes = std::get_if<Image<std::uint8_t>>(&picture);
  if (bytes != nullptr && white == 255) return *bytes;
  return std::visit([&](const auto& image) { return scaled(image, white); }, picture);
}

}  // namespace flexura
