#include "flexura/calibrate/eight_bits.h"

#include <algorithm>
#include <cstddef>
#include <variant>

namespace flexura {

Image<std::uint8_t> eight_bits(const Picture& picture, int white) {
  if (const auto* bytes = std::get_if<Image<std::uint8_t>>(&picture)) return *bytes;
  const auto& words = std::get<Image<std::uint16_t>>(picture);
  Image<std::uint8_t> bytes(words.width(), words.height(), words.channels());
  for (std::size_t i = 0; i < words.values().size(); ++i)
    bytes.values()[i] =
        static_cast<std::uint8_t>(std::min(255, (255 * int{words.values()[i]} + white / 2) / white));
  return bytes;
}

}  // namespace flexura
