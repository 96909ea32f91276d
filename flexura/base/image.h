#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace flexura {

/// A picture of `height` rows of `width` pixels with `channels` values each. Values are stored row by row
/// from the top, without gaps. With three channels, the values are red, green and blue.
template <typename T>
class Image {
 public:
  Image() = default;
  /// Makes a picture with every value equal to `value`. Width, height and channels must not be negative.
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

  /// Value of pixel (u, v): column u from the left, row v from the top, both counted from 0. u and v are not
  /// checked.
  [[nodiscard]] T& at(int u, int v, int channel = 0) { return values_[index(u, v, channel)]; }
  [[nodiscard]] const T& at(int u, int v, int channel = 0) const { return values_[index(u, v, channel)]; }

  /// Values of row v, pixel by pixel: width() * channels() numbers. v is not checked.
  [[nodiscard]] std::span<T> row(int v) { return {&values_[index(0, v, 0)], row_size()}; }
  [[nodiscard]] std::span<const T> row(int v) const { return {&values_[index(0, v, 0)], row_size()}; }

  /// All values, row by row from the top.
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

/// A picture from a sensor or a file: values of up to 8 bits are stored in 8 bits, longer values in 16.
using Picture = std::variant<Image<std::uint8_t>, Image<std::uint16_t>>;

}  // namespace flexura
