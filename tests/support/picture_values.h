#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>

#include "flexura/picture/image_file.h"
#include "tests/support/picture_files.h"
#include "tests/support/random_cases.h"

// Values that a test of the readers writes to a file, and the values expected when reading it.
namespace flexura {

inline Picture read_made(const std::string& file) {
  constexpr std::size_t enough = 1U << 16U;
  return read_picture(file_bytes(file), "made", enough);
}
inline Image<std::uint8_t> read_bytes(const std::string& file) {
  return std::get<Image<std::uint8_t>>(read_made(file));
}
inline Image<std::uint16_t> read_words(const std::string& file) {
  return std::get<Image<std::uint16_t>>(read_made(file));
}

inline double mean_difference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
  if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) sum += std::abs(a.values()[i] - b.values()[i]);
  return sum / static_cast<double>(a.values().size());
}

inline int side(TestRandom& random) { return random.integer(1, 40); }

// Returns the picture without alpha: one channel of two, three of four.
template <typename T>
Image<T> without_alpha(const Image<T>& image) {
  Image<T> rest(image.width(), image.height(), image.channels() < 3 ? 1 : 3);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      for (int c = 0; c < rest.channels(); ++c) rest.at(u, v, c) = image.at(u, v, c);
  return rest;
}

inline Image<std::uint8_t> scaled(Image<std::uint8_t> values, int bits) {
  for (std::uint8_t& value : values.values())
    value = static_cast<std::uint8_t>(value * 255 / ((1 << bits) - 1));
  return values;
}

inline Colors random_colors(TestRandom& random, int bits, bool is_gray) {
  Colors colors(std::size_t{1} << bits);
  for (auto& color : colors) {
    for (std::uint8_t& value : color) value = static_cast<std::uint8_t>(random.integer(0, 255));
    if (is_gray) color[1] = color[2] = color[0];
  }
  if (!is_gray) colors[0] = {1, 2, 3};
  return colors;
}

inline Image<std::uint8_t> colored(const Image<std::uint8_t>& indices, const Colors& colors, bool is_gray) {
  Image<std::uint8_t> image(indices.width(), indices.height(), is_gray ? 1 : 3);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      for (int c = 0; c < image.channels(); ++c)
        image.at(u, v, c) = colors[indices.at(u, v)][static_cast<std::size_t>(c)];
  return image;
}

}  // namespace flexura
