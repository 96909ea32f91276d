#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace flexura {

/// Circle with the least sum of squared distances from points.
struct CircleFit {
  Eigen::Vector2d center = {0, 0};  ///< Center, px, in the picture's (u, v).
  double radius = 0;                ///< Radius, px.
  double rms = 0;                   ///< Root mean square of the points' distances from the curve, px.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Covariance of center and radius, px^2.
  double arc = 0;  ///< Angle of the circle's part that the points span, rad; 2 pi for the whole circle.
  /// Whether the points satisfy the circle's equation (paper, section 3.4, step 5). It is a test at the
  /// significance level 1 %: an ellipse must not fit significantly better.
  bool is_verified = false;
  /// Smallest tilt of the circle's plane, rad, that this test would detect with these points in 9 of 10
  /// cases. It assumes the least favourable direction of the tilt. The value is pi/2 if the test cannot
  /// detect any tilt.
  double detectable_tilt = 0;
  /// Correlation of the residuals of points with neighbouring angles, in [-1, 1]. It is about 0 for
  /// independent noise. It is near 1 if the points are on another curve than a circle, or if they were
  /// smoothed.
  double misfit_correlation = 0;
  double sigma = 0;  ///< Standard deviation of the points, px, if known; otherwise 0.

  /// Returns whether the points distinguish a circle from a line: the radius has a relative standard
  /// deviation of at most one half.
  [[nodiscard]] bool is_curved() const {
    constexpr double least_known = 0.5;
    return std::sqrt(covariance(2, 2)) <= least_known * radius;
  }
  /// Returns whether the points are on a circle: the circle's equation is verified and the residuals are
  /// noise. If `sigma` is known, residuals up to four times `sigma` are noise. If it is unknown, another
  /// shape, such as a polygon or a drop, is recognised by a high correlation of neighbouring residuals.
  /// Smoothed points, whose residuals are smaller, are accepted.
  [[nodiscard]] bool is_circle() const {
    constexpr double most_alike = 0.9, smooth = 0.15;  // px
    const bool is_noise = sigma > 0 ? rms <= 4 * sigma : misfit_correlation <= most_alike || rms <= smooth;
    return is_verified && is_noise;
  }
};

/// Ellipse with the least sum of squared distances from points.
struct EllipseFit {
  Eigen::Vector2d center = {0, 0};     ///< Center, px, in the picture's (u, v).
  Eigen::Vector2d semi_axes = {0, 0};  ///< Semi-axes, px, the longer one first.
  double angle = 0;                    ///< Angle of the longer axis from u towards v, rad in (-pi/2, pi/2].
  double rms = 0;                      ///< Root mean square of the points' distances from the curve, px.
  /// Covariance of center, semi-axes and angle, in this order, in px and rad.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
};

/// Fits a circle to at least 3 points. Starts with V. Pratt's algebraic fit (1987), then applies the
/// Gauss-Newton method to the distances. Returns std::nullopt for fewer points and for collinear points.
/// `sigma` is the standard deviation of the points, px, if known; otherwise the rms of the distances is used.
[[nodiscard]] std::optional<CircleFit> fit_circle(std::span<const Eigen::Vector2d> points,
                                                  std::optional<double> sigma = std::nullopt);

/// Fits an ellipse to at least 6 points. Starts with the algebraic fit of R. Halir and J. Flusser (1998),
/// then applies the Levenberg-Marquardt method to the distances. Returns std::nullopt if no ellipse fits, or
/// if the ellipse is more than 10,000 times as long as wide.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse(std::span<const Eigen::Vector2d> points);

/// Fits an ellipse to most of the points, ignoring outliers. In a few hundred deterministic trials, computes
/// an ellipse through six points, and selects the ellipse with the most points within `tolerance` px.
/// Starting with it, fits all points within 3.5 times the rms of the fitted points. Removes the outliers from
/// `points`.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse_to_most(std::vector<Eigen::Vector2d>& points,
                                                            double tolerance = 0.6);

/// Returns the fraction of an ellipse, measured by eccentric anomaly, that is covered by points. For example,
/// two parallel lines of points are near a long ellipse but cover only a small fraction of it.
[[nodiscard]] double share_around(const EllipseFit& ellipse, std::span<const Eigen::Vector2d> points);

/// Returns the distance of a point from an ellipse, positive outside, px.
[[nodiscard]] double distance_to(const EllipseFit& ellipse, const Eigen::Vector2d& point);

}  // namespace flexura
