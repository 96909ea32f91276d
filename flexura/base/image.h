#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace flexura {

/// A picture: `height` rows of `width` pixels of `channels` values each, row after row from the top, without
/// gaps. Colour is red, green, blue.
template <typename T>
class Image {
 public:
  Image() = default;
  /// Sets every value to `value`. Sizes must not be negative.
  Image(int width, int height, int channels = 1, T value = T{})
      : width_(width),
        height_(height),
        channels_(channels),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                    static_cast<std::size_t>(channels),
                value) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int channels() const { return channels_; }

  /// Pixel (u, v): column u from the left, row v from the top.
  [[nodiscard]] T& at(int u, int v, int channel = 0) { return values_[index(u, v, channel)]; }
  [[nodiscard]] const T& at(int u, int v, int channel = 0) const { return values_[index(u, v, channel)]; }

  /// Row v, width() * channels() values, pixel by pixel. As in at(), v is not checked.
  [[nodiscard]] std::span<T> row(int v) { return {&values_[index(0, v, 0)], row_size()}; }
  [[nodiscard]] std::span<const T> row(int v) const { return {&values_[index(0, v, 0)], row_size()}; }

  /// All values, in the order above.
  [[nodiscard]] std::span<T> values() { return values_; }
  [[nodiscard]] std::span<const T> values() const { return values_; }

  bool operator==(const Image&) const = default;

 private:
  [[nodiscard]] std::size_t row_size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
  }
  [[nodiscard]] std::size_t index(int u, int v, int channel) const {
    return static_cast<std::size_t>(v) * row_size() +
           static_cast<std::size_t>(u) * static_cast<std::size_t>(channels_) +
           static_cast<std::size_t>(channel);
  }

  int width_ = 0, height_ = 0, channels_ = 1;
  std::vector<T> values_;
};

/// A picture from a sensor or a file: bytes up to 8 bits per value, words above.
using Picture = std::variant<Image<std::uint8_t>, Image<std::uint16_t>>;

}  // namespace flexura
