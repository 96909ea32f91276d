#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/vision/blurred_step.h"

namespace flexura {

/// Result of the search for a figure's border at one position.
struct EdgeFit {
  double offset = 0;    ///< Distance of the border outward from the expected position, px.
  double contrast = 0;  ///< Contrast; positive if the background is on the outward side.
  double residual = 0;  ///< Standard deviation of the difference between the brightness and the fitted model.
  /// Standard deviation of the offset, px, for noise whose standard deviation equals the contrast.
  double sigma = 0;
};

/// Finds borders of a figure in a picture, using pixels of one row or one column, whichever is closer to
/// perpendicular to the border. Pixels are not interpolated, because interpolation would shift an edge by up
/// to 0.014 px.
template <typename Value>
class EdgeFinder {
 public:
  /// `sign` is 1 for a dark figure, -1 for a bright figure. Only one finder at a time may use `steps`. If the
  /// blur exceeds `widest_blur`, in samples, only every second pixel is used; if it still exceeds it, every
  /// third pixel, and so on. A larger `widest_blur` needs a smaller part of the figure, but neglects more of
  /// the blur's tails.
  EdgeFinder(const Image<Value>& picture, int sign, BlurredSteps& steps, double widest_blur = 1.6);

  /// Returns whether a pixel's four neighbours are in the picture.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width_ - 1 && pixel.y() < height_ - 1;
  }
  /// Returns the brightness at a position for which holds() is true, by bilinear interpolation.
  [[nodiscard]] double at(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] int sign() const { return sign_; }

  /// Finds the border near the pixel `from`, px. `normal` is the approximate outward unit normal. `blur` is
  /// the standard deviation of the blur along the normal, px. `room` is the distance inside the border over
  /// which the figure's brightness is linear, px. Returns std::nullopt if samples would be outside the
  /// picture.
  [[nodiscard]] std::optional<EdgeFit> look(const Eigen::Vector2d& from, const Eigen::Vector2d& normal,
                                            double blur, double room) const;

 private:
  const Value* values_;
  int width_, height_, sign_;
  BlurredSteps& steps_;
  double widest_blur_;
};

extern template class EdgeFinder<std::uint8_t>;
extern template class EdgeFinder<std::uint16_t>;

}  // namespace flexura
