#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/vision/blurred_step.h"

namespace flexura {

/// What was found of a figure's border.
struct EdgeFit {
  double offset = 0;    ///< px outward from where it was looked for.
  double contrast = 0;  ///< Positive where the ground is outward.
  double residual = 0;  ///< Standard deviation of the brightnesses from the model.
  double sigma = 0;     ///< Standard deviation of the offset, px, for noise as large as the contrast.
};

/// Finds borders of a figure in a picture, at pixels of one row or one column each, whichever is more across
/// the border: nothing is interpolated, which would shift an edge by as much as 0.014 px.
template <typename Value>
class EdgeFinder {
 public:
  /// `sign`: 1 for a dark figure, -1 for a bright one. `steps` is used by one finder at a time.
  /// `widest_blur`: in samples, beyond which every other pixel and so on is one. The wider, the less of the
  /// figure is looked at, and the more of the blur's tails are missed.
  EdgeFinder(const Image<Value>& picture, int sign, BlurredSteps& steps, double widest_blur = 1.6);

  /// Whether a pixel's four neighbours are in the picture.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width_ - 1 && pixel.y() < height_ - 1;
  }
  /// Brightness at a place that it holds, linear between pixels.
  [[nodiscard]] double at(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] int sign() const { return sign_; }

  /// The border near `from`, whose outward normal (a unit vector) is known roughly. `blur` along the normal,
  /// px; `room`: how far before the border the figure
  /// is shaded evenly, px. None where samples would lie outside
  /// the picture.
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
