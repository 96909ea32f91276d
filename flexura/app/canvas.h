#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "flexura/base/image.h"
#include "flexura/vision/conic.h"

namespace flexura {

using PenColor = std::array<std::uint8_t, 3>;

/// Draws thin lines over a picture.
class Canvas {
 public:
  /// Copies a gray or three-channel picture.
  explicit Canvas(const Image<std::uint8_t>& picture);

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const PenColor& color);
  /// Draws a cross that extends `size` pixels to each side.
  void cross(const Eigen::Vector2d& at, double size, const PenColor& color);
  void ellipse(const EllipseFit& ellipse, const PenColor& color);

  [[nodiscard]] const Image<std::uint8_t>& picture() const { return picture_; }

 private:
  void dot(const Eigen::Vector2d& at, const PenColor& color);

  Image<std::uint8_t> picture_;
};

}  // namespace flexura
