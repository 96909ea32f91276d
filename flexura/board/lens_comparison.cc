#include "flexura/board/lens_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double criterion_of(const IntrinsicsFit& fit, LensModel model) {
  if (!fit.is_found) return infinity;
  // Below this, all models explain the pictures.
  constexpr double least = 1e-6;  // px
  // No model counts for less than brown: a fisheye lens has one coefficient less, but over small angles each
  // describes the other.
  const std::size_t coefficients =
      std::max(Distortion::size_of(model), Distortion::size_of(LensModel::brown));
  const double residuals = 2 * static_cast<double>(fit.points),
               parameters = static_cast<double>(fit.cameras.size() * (4 + coefficients));
  // The rms is that of distances, which have two residuals each.
  return residuals * std::log(0.5 * std::pow(std::max(fit.rms, least), 2)) + parameters * std::log(residuals);
}

}  // namespace

LensComparison compare_lenses(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                              std::span<const std::array<int, 2>> sizes, IntrinsicsConfig config) {
  LensComparison comparison;
  config.distortion.reset();
  for (const LensModel model : {LensModel::brown, LensModel::rational, LensModel::fisheye}) {
    config.model = model;
    LensTrial& trial = comparison.trials.emplace_back();
    trial.model = model;
    trial.fit = fit_intrinsics(points, views, sizes, config);
    trial.criterion = criterion_of(trial.fit, model);
  }
  // A smaller difference is no strong evidence (R. E. Kass and A. E. Raftery, "Bayes factors", 1995).
  constexpr double strong = 10;
  const auto rank = [](const LensTrial& trial) {
    const double credit = trial.model == LensModel::brown ? strong : 0;
    return std::pair(trial.criterion - credit, trial.fit.points > 0 ? trial.fit.rms : infinity);
  };
  comparison.best = static_cast<std::size_t>(std::ranges::min_element(comparison.trials, {}, rank) -
                                             comparison.trials.begin());
  return comparison;
}

}  // namespace flexura
