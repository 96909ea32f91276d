#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/estimate/shape_problem.h"
#include "flexura/math/dense.h"

namespace flexura {

/// Where a descent came to.
struct ShapeFit {
  Shape shape;
  bool is_settled = false;  ///< No step leads further down.
  int iterations = 0;
  double scale = 1;    ///< Of the residuals, in units of their sigmas: robust, at least 1.
  double cost = 0;     ///< Mean over the points of their distances squared, bounded for each, px^2.
  double rms = 0;      ///< Of the believed points' distances, px.
  double doubted = 0;  ///< The share of the points that are taken for something else's.
  std::vector<double> doubted_in = {};  ///< The same of each sighting.
  double surprise = 0;         ///< Of a belief: root mean square of what speaks against it, in its sigmas.
  int contradicted = 0;        ///< Ends and markers that are seen elsewhere than the shape has them.
  Eigen::MatrixXd covariance;  ///< Of the unknowns; of infinite entries where the sightings tell nothing.

  static constexpr double most_scale = 8;  ///< In sigmas: what lies farther from its points is no fit.
  /// Whether nothing better need be looked for. `most_rms`: of points that are believed, px.
  [[nodiscard]] bool is_good(double most_rms) const {
    return is_settled && doubted < 0.1 && (scale < most_scale || rms < 0.5 * most_rms);
  }
};

/// Whether all that is seen is believed at first, however far off the start is, or what lies beyond the
/// residuals' spread is doubted at once.
enum class StartKind { far, near };

/// The Levenberg-Marquardt method from `start` down, with residuals beyond what their spread allows weighted
/// down (S. Geman and D. McClure, 1985). Reused, it allocates no more.
class ShapeDescent {
 public:
  [[nodiscard]] ShapeFit descend(ShapeProblem& problem, const Shape& start, int most_iterations,
                                 StartKind kind = StartKind::far);

 private:
  [[nodiscard]] double cutoff(const ShapeProblem& problem);
  void weigh(const ShapeProblem& problem, double cutoff);
  bool find_step(double damping);
  void finish(const ShapeProblem& problem, double cutoff, ShapeFit& fit);
  // Of the unknowns; `square`: of the points' weighted residuals, `weight`: of the points.
  [[nodiscard]] Eigen::MatrixXd covariance(const ShapeProblem& problem, double square, double weight);
  [[nodiscard]] Eigen::MatrixXd filtered_covariance(const ShapeProblem& problem, double square,
                                                    double weight);
  void load_scatter(const ShapeProblem& problem);

  std::vector<double> sizes_;
  Eigen::VectorXd weights_, gradient_, step_, near_, far_;
  Eigen::MatrixXd weighted_, normal_, damped_;                         // Of symmetric ones the lower half.
  Eigen::MatrixXd parts_, alike_, apart_, told_, followed_, scatter_;  // Of the covariance, whole.
  double promised_ = 1;  // How much more the points' mean varies than that of independent ones.
  PivotedCholesky solver_;
};

}  // namespace flexura
