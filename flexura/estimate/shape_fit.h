#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/estimate/shape_problem.h"
#include "flexura/math/dense.h"

namespace flexura {

/// Result of a descent.
struct ShapeFit {
  Shape shape;
  bool is_settled = false;  ///< Whether the descent converged: no step reduces the cost further.
  int iterations = 0;
  double scale = 1;          ///< Robust scale of the residuals, in units of their sigmas; at least 1.
  double cost = 0;           ///< Mean of the points' squared distances, each limited to a bound, px^2.
  double rms = 0;            ///< Root mean square of the inlier points' distances, px.
  double outlier_share = 0;  ///< Share of the points that are outliers.
  std::vector<double> outlier_share_in = {};  ///< Share of outliers in each observation.
  /// Normalised innovation of a prediction: root mean square of the prediction's residuals, in standard
  /// deviations.
  double innovation = 0;
  int contradicted = 0;  ///< Number of observed ends and markers that the shape contradicts.
  /// Covariance of the unknowns; infinite if the observations do not determine them.
  Eigen::MatrixXd covariance;

  static constexpr double most_scale = 8;  ///< Scale above which the fit is rejected, in standard deviations.
  /// Returns whether no better fit is needed. `most_rms`: largest accepted `rms`, px.
  [[nodiscard]] bool is_good(double most_rms) const {
    return is_settled && outlier_share < 0.1 && (scale < most_scale || rms < 0.5 * most_rms);
  }
};

/// Treatment of outliers at the beginning of a descent. `far`: all points are inliers at first, regardless of
/// their residuals at the start. `near`: points beyond the residuals' spread are outliers from the beginning.
enum class StartKind { far, near };

/// Minimises by the Levenberg-Marquardt method from `start`, with Geman-McClure weights for residuals beyond
/// their spread (S. Geman and D. McClure, 1985). Allocates only in the first use.
class ShapeDescent {
 public:
  [[nodiscard]] ShapeFit descend(ShapeProblem& problem, const Shape& start, int most_iterations,
                                 StartKind kind = StartKind::far);

 private:
  [[nodiscard]] double cutoff(const ShapeProblem& problem);
  void weigh(const ShapeProblem& problem, double cutoff);
  bool find_step(double damping);
  void finish(const ShapeProblem& problem, double cutoff, ShapeFit& fit);
  // Covariance of the unknowns. `square`: sum of the points' weighted squared residuals. `weight`: sum of the
  // points' weights.
  [[nodiscard]] Eigen::MatrixXd covariance(const ShapeProblem& problem, double square, double weight);
  [[nodiscard]] Eigen::MatrixXd filtered_covariance(const ShapeProblem& problem, double square,
                                                    double weight);
  void load_scatter(const ShapeProblem& problem);

  std::vector<double> sizes_;
  Eigen::VectorXd weights_, gradient_, step_, near_, far_;
  Eigen::MatrixXd weighted_, normal_, damped_;  // Lower halves of symmetric matrices.
  Eigen::MatrixXd parts_, alike_, apart_, predicted_rows_, followed_,
      scatter_;          // For the covariance, complete.
  double promised_ = 1;  // Ratio of the variance of the points' mean to that of independent ones.
  PivotedCholesky solver_;
};

}  // namespace flexura
