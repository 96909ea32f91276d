#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>

#include "flexura/board/board_bundle.h"

namespace flexura {

/// Lens model of a fit, and the number of its fitted coefficients.
struct FittedLens {
  LensModel model = LensModel::brown;
  int distortion = 5;
};

/// Structure of a camera's residuals. A lens model that does not fit leaves residuals that are alike in
/// neighbouring points and may depend on the distance from the principal point.
struct LensMisfit {
  double rms = 0;  ///< Root mean square of the residuals, px.
  /// Correlation of the residuals of neighbouring points: 0 for noise, 1 for smooth residuals.
  double likeness = 0;
  /// Share of the residuals' sum of squares that a radial displacement explains, which depends only on the
  /// distance from the principal point. The share is near 0 for noise.
  double radial_share = 0;

  /// Returns whether the residuals are over 0.5 px and alike in neighbouring points, as those of a wrong lens
  /// model or of a board that is not flat.
  [[nodiscard]] bool is_systematic() const;
  /// Returns the reason to state if is_systematic() is true.
  [[nodiscard]] std::string reason(const FittedLens& lens) const;
};

/// Computes the structure of a camera's residuals in the views with a pose in `bundle`. Views in which the
/// lens does not show a point are skipped.
[[nodiscard]] LensMisfit lens_misfit(std::span<const Eigen::Vector2d> points,
                                     std::span<const BoardView> views, const BoardBundle& bundle,
                                     std::size_t camera);

/// Returns the structure of the residuals of the camera whose residuals are largest.
[[nodiscard]] LensMisfit worst_misfit(std::span<const Eigen::Vector2d> points,
                                      std::span<const BoardView> views, const BoardBundle& bundle);

}  // namespace flexura
