#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/vision/blurred_step.h"

namespace flexura {

/// Result of the search for a figure's border.
struct EdgeFit {
  double offset = 0;    ///< Distance outward from the expected position, px.
  double contrast = 0;  ///< Contrast, positive if the background is outward.
  double residual = 0;  ///< Standard deviation of the brightness from the model.
  double sigma = 0;     ///< Standard deviation of the offset, px, for noise as large as the contrast.
};

/// Finds borders of a figure in a picture at pixels of one row or one column, whichever is more across the
/// border. It does not interpolate, which would shift an edge by up to 0.014 px.
template <typename Value>
class EdgeFinder {
 public:
  /// `sign`: 1 for a dark figure, -1 for a bright one. `steps` must be used by one finder at a time.
  /// `widest_blur`: in samples; beyond it only every second pixel is used, and so on. Larger values use less
  /// of the figure and miss more of the blur's tails.
  EdgeFinder(const Image<Value>& picture, int sign, BlurredSteps& steps, double widest_blur = 1.6);

  /// Returns whether a pixel's four neighbours are in the picture.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width_ - 1 && pixel.y() < height_ - 1;
  }
  /// Returns the brightness at such a position, linear between pixels.
  [[nodiscard]] double at(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] int sign() const { return sign_; }

  /// Finds the border near `from`; the outward normal (a unit vector) is known roughly. `blur` is along the
  /// normal, px; `room`: distance inside the border over which the figure is shaded uniformly, px. Empty if
  /// samples would lie outside the picture.
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
