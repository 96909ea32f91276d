#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace flexura {

/// Least-squares circle through points, by distance.
struct CircleFit {
  Eigen::Vector2d center = {0, 0};                       ///< Center, px, in the picture's (u, v).
  double radius = 0;                                     ///< Radius, px.
  double rms = 0;                                        ///< Root mean square of the distances, px.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Covariance of center and radius, px^2.
  double arc = 0;  ///< Part of the circle spanned by the points, rad; 2 pi for the whole circle.
  /// Whether the points satisfy the circle's equation (section 3.4, step 5): an ellipse fits no better than
  /// noise explains in 99 of 100 cases.
  bool is_verified = false;
  /// Power of that test, rad: the smallest tilt of the circle's plane that it would detect on these points in
  /// 9 of 10 cases. This is for the least favourable direction; pi/2 if it would detect no tilt.
  double detectable_tilt = 0;
  /// Correlation of neighbouring residuals (by angle), in [-1, 1]: about 0 for independent noise, near 1 if
  /// the points follow another curve than a circle, or are smoothed.
  double misfit_correlation = 0;
  double sigma = 0;  ///< Standard deviation of the points, px, if known; otherwise 0.

  /// Returns whether the points distinguish a circle from a line: the radius is known to half of itself.
  [[nodiscard]] bool is_curved() const {
    constexpr double least_known = 0.5;
    return std::sqrt(covariance(2, 2)) <= least_known * radius;
  }
  /// Returns whether the equation is verified and the residuals have no shape of their own. If `sigma` is
  /// known, they may be at most four times as large. Otherwise a shape, such as a polygon or a drop, shows as
  /// a high correlation of neighbours, together with residuals larger than smoothing leaves.
  [[nodiscard]] bool is_circle() const {
    constexpr double most_alike = 0.9, smooth = 0.15;  // px
    const bool is_noise = sigma > 0 ? rms <= 4 * sigma : misfit_correlation <= most_alike || rms <= smooth;
    return is_verified && is_noise;
  }
};

/// Least-squares ellipse through points, by distance.
struct EllipseFit {
  Eigen::Vector2d center = {0, 0};     ///< Center, px, in the picture's (u, v).
  Eigen::Vector2d semi_axes = {0, 0};  ///< Semi-axes, px, the longer one first.
  double angle = 0;                    ///< Angle of the longer axis from u towards v, rad in (-pi/2, pi/2].
  double rms = 0;                      ///< Root mean square of the distances, px.
  /// Covariance in the order above.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
};

/// Fits a circle to at least 3 points: V. Pratt's algebraic one (1987), then Gauss-Newton's method on the
/// distances. Empty for collinear or fewer points. `sigma`: the points' standard deviation, px, if known;
/// otherwise their own rms is used.
[[nodiscard]] std::optional<CircleFit> fit_circle(std::span<const Eigen::Vector2d> points,
                                                  std::optional<double> sigma = std::nullopt);

/// Fits an ellipse to at least 6 points: the algebraic one of R. Halir and J. Flusser (1998), then the
/// Levenberg-Marquardt method on the distances. Empty if no ellipse fits, or only one 10,000 times as long as
/// wide.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse(std::span<const Eigen::Vector2d> points);

/// Fits an ellipse to most of the points, ignoring outliers. Starts with the ellipse through six of them that
/// has most points within `tolerance` px, out of a few hundred deterministic trials. Then fits all points
/// within 3.5 times the rms of the rest. `points` keeps those.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse_to_most(std::vector<Eigen::Vector2d>& points,
                                                            double tolerance = 0.6);

/// Returns the share of an ellipse, by eccentric anomaly, along which there are points. Two parallel sides
/// lie on a long ellipse but cover little of it.
[[nodiscard]] double share_around(const EllipseFit& ellipse, std::span<const Eigen::Vector2d> points);

/// Returns the distance of a point from an ellipse, positive outside, px.
[[nodiscard]] double distance_to(const EllipseFit& ellipse, const Eigen::Vector2d& point);

}  // namespace flexura
