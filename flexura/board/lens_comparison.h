#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/board/board_bundle.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/camera/distortion.h"

namespace flexura {

/// Calibration with one lens model.
struct LensTrial {
  LensModel model = LensModel::brown;
  IntrinsicsFit fit;
  /// Bayesian information criterion (G. Schwarz, "Estimating the dimension of a model", 1978): n ln(S / n) +
  /// p ln n, for n residuals with the sum of squares S and p lens parameters, at least those of `brown`. The
  /// smallest value belongs to the model that explains the pictures best with the fewest parameters. Infinite
  /// if the fit failed.
  double criterion = 0;
};

/// Comparison of lens models on the same views.
struct LensComparison {
  std::vector<LensTrial> trials;  ///< One trial per lens model, in the order of LensModel.
  std::size_t best = 0;           ///< Index of the trial that explains the views best.
};

/// Calibrates cameras with each lens model and all its coefficients, and chooses the model with the smallest
/// criterion. Another model than `brown` is chosen only if its criterion is smaller by more than 10. If no
/// fit succeeded, chooses the one with the smallest residuals. `config.model` and
/// `config.distortion` are ignored. Throws like fit_intrinsics().
[[nodiscard]] LensComparison compare_lenses(std::span<const Eigen::Vector2d> points,
                                            std::span<const BoardView> views,
                                            std::span<const std::array<int, 2>> sizes,
                                            IntrinsicsConfig config = {});

}  // namespace flexura
