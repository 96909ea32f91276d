#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace flexura {

/// A set of vectors x: |x[at ... at + size - 1] - center| <= radius.
struct BallLimit {
  Eigen::Index at = 0;
  Eigen::VectorXd center;  ///< The size of `center` is the number of limited entries.
  double radius = 0;       ///< >= 0
};

/// A set of vectors x: lower <= normal . x <= upper.
struct BandLimit {
  Eigen::VectorXd normal;
  double lower = 0, upper = 0;
};

/// Limits on a vector: the intersection of convex sets.
struct ConvexLimits {
  std::vector<BallLimit> balls;
  std::vector<BandLimit> bands;
};

/// Returns the largest distance of x from one of the sets.
[[nodiscard]] double excess(const ConvexLimits& limits, const Eigen::VectorXd& x);

/// Settings of nearest_point().
struct NearestPointConfig {
  int most_rounds = 400;  ///< Largest number of projections on each set.
  /// Tolerance: the search ends if x changes by less than this value in a round. The tolerance is also the
  /// largest allowed excess().
  double tolerance = 1e-7;
};

/// Returns the vector within all limits that is nearest to `start`, by alternating projections with Dykstra's
/// correction (Dykstra, 1983). If the number of rounds is too small for convergence, the result is within the
/// limits but may not be the nearest vector. Returns std::nullopt if no vector within the limits was found.
/// Throws std::invalid_argument for limits whose sizes do not fit `start`.
[[nodiscard]] std::optional<Eigen::VectorXd> nearest_point(const ConvexLimits& limits,
                                                           const Eigen::VectorXd& start,
                                                           const NearestPointConfig& config = {});

}  // namespace flexura
