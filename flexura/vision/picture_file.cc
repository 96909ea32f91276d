#include "flexura/vision/picture_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/picture/image_file.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

template <typename Value>
Image<Value> gray_of_colors(const Image<Value>& picture) {
  if (picture.channels() == 1) return picture;
  Image<Value> gray(picture.width(), picture.height());
  const Value* from = picture.values().data();
  // In 1/65536: 0.2126, 0.7152, 0.0722.
  for (Value& value : gray.values()) {
    const std::uint64_t sum =
        13933U * std::uint64_t{from[0]} + 46871U * std::uint64_t{from[1]} + 4732U * std::uint64_t{from[2]};
    value = static_cast<Value>((sum + 32768U) >> 16U);
    from += 3;
  }
  return gray;
}

// Returns a gray picture stored in colour as one channel; other pictures unchanged.
Image<std::uint8_t> without_colors(Image<std::uint8_t> picture) {
  if (picture.channels() != 3) return picture;
  const auto values = picture.values();
  for (std::size_t i = 0; i < values.size(); i += 3)
    if (values[i] != values[i + 1] || values[i] != values[i + 2]) return picture;
  Image<std::uint8_t> gray(picture.width(), picture.height());
  for (std::size_t i = 0; i < gray.values().size(); ++i) gray.values()[i] = values[3 * i];
  return gray;
}

template <typename Value>
bool has_two_values(const Image<Value>& picture) {
  const auto [least, most] = std::ranges::minmax(picture.values());
  const auto is_either = [low = least, high = most](Value value) { return value == low || value == high; };
  return least < most && std::ranges::all_of(picture.values(), is_either);
}

// Scales a mask to 0 and 255 and blurs it by one pixel. A pixel staircase has no subpixel position, but its
// mean over several steps has one.
Image<std::uint8_t> softened_mask(const Image<std::uint8_t>& mask) {
  constexpr std::array<int, 5> kernel = {1, 4, 6, 4, 1};
  const std::uint8_t most = std::ranges::max(mask.values());
  Image<std::uint16_t> rows(mask.width(), mask.height());
  Image<std::uint8_t> soft(mask.width(), mask.height());
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      int sum = 0;
      for (int i = 0; i < 5; ++i)
        sum += kernel[static_cast<std::size_t>(i)] *
               (mask.at(std::clamp(u + i - 2, 0, mask.width() - 1), v) == most ? 255 : 0);
      rows.at(u, v) = static_cast<std::uint16_t>(sum);
    }
  }
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      int sum = 128;
      for (int i = 0; i < 5; ++i)
        sum += kernel[static_cast<std::size_t>(i)] * rows.at(u, std::clamp(v + i - 2, 0, mask.height() - 1));
      soft.at(u, v) = static_cast<std::uint8_t>(sum / 256);
    }
  }
  return soft;
}

// Finds the white level: sensors of 10 or 12 bits write unscaled values, and a few hot pixels do not count.
int white_found_in(const Image<std::uint16_t>& words) {
  constexpr std::size_t hot = 10000;  // One in this many may be hot.
  std::vector<std::uint16_t> values(words.values().begin(), words.values().end());
  const auto place = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / hot);
  std::ranges::nth_element(values, place);
  return std::max(255, static_cast<int>(std::bit_ceil(*place + 1U)) - 1);
}

}  // namespace

Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name) {
  Picture picture = read_picture(file, name, most_pixels);
  Photograph photograph;
  if (auto* bytes = std::get_if<Image<std::uint8_t>>(&picture)) {
    photograph.bytes = std::move(*bytes);
  } else {
    photograph.words = std::move(std::get<Image<std::uint16_t>>(picture));
    photograph.white = white_found_in(photograph.words);
    photograph.bytes = eight_bits(photograph.words, photograph.white);
  }
  const Image<std::uint8_t> gray = without_colors(photograph.bytes);
  // A picture of little contrast in 16 bits may have only two values in 8 bits.
  photograph.is_mask = gray.channels() == 1 && has_two_values(gray) &&
                       (photograph.words.values().empty() || has_two_values(photograph.words));
  if (photograph.is_mask) photograph.bytes = softened_mask(gray), photograph.words = {};
  return photograph;
}

Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture) { return gray_of_colors(picture); }
Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture) { return gray_of_colors(picture); }

}  // namespace flexura
