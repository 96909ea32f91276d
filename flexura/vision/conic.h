#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace flexura {

/// A circle through points: the least sum of squared distances.
struct CircleFit {
  Eigen::Vector2d center = {0, 0};                       ///< px, in the picture's (u, v).
  double radius = 0;                                     ///< px
  double rms = 0;                                        ///< Of the distances, px.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of center and radius, px^2.
  double arc = 0;  ///< What the points span of the circle, rad; 2 pi when all of it.
  /// Whether the points verify the circle's equation (section 3.4, step 5): an ellipse would not fit better
  /// than noise makes it in 99 of 100 cases.
  bool is_verified = false;
  /// And what that is worth: the smallest tilt of the circle's plane, in the direction in which it shows
  /// least, that this test would see on these points in 9 of 10 cases, rad; pi/2 when it would see none.
  double detectable_tilt = 0;
  /// How much what is left of neighbours (by their angle) is alike, in [-1, 1]: about 0 for points with noise
  /// of their own, near 1 where they lie on something else than a circle, or are smoothed.
  double misfit_correlation = 0;
  double sigma = 0;  ///< The points' standard deviation, px, if it was known; else 0.

  /// Whether the points tell a circle from a line: its radius is known to half of itself.
  [[nodiscard]] bool is_curved() const {
    constexpr double least_known = 0.5;
    return std::sqrt(covariance(2, 2)) <= least_known * radius;
  }
  /// Whether the points verify the equation and what they leave of it is no figure of its own. Of points that
  /// are known to `sigma`: no more than four times that. Of others a figure, as a polygon or a drop leaves,
  /// is known by neighbours that are alike by more than noise is, and more than points are smoothed to.
  [[nodiscard]] bool is_circle() const {
    constexpr double most_alike = 0.9, smooth = 0.15;  // px
    const bool is_noise = sigma > 0 ? rms <= 4 * sigma : misfit_correlation <= most_alike || rms <= smooth;
    return is_verified && is_noise;
  }
};

/// An ellipse through points: the least sum of squared distances.
struct EllipseFit {
  Eigen::Vector2d center = {0, 0};     ///< px, in the picture's (u, v).
  Eigen::Vector2d semi_axes = {0, 0};  ///< The longer one first, px.
  double angle = 0;                    ///< Of the longer one from u towards v, rad in (-pi/2, pi/2].
  double rms = 0;                      ///< Of the distances, px.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();  ///< In the order above.
};

/// The circle through at least 3 points: V. Pratt's algebraic one (1987), then Gauss-Newton's method on the
/// distances. None for points on a line, or fewer. `sigma`: the points' standard deviation, px, when it is
/// known; otherwise their own rms serves.
[[nodiscard]] std::optional<CircleFit> fit_circle(std::span<const Eigen::Vector2d> points,
                                                  std::optional<double> sigma = std::nullopt);

/// The ellipse through at least 6 points: the algebraic one of R. Halir and J. Flusser (1998), then the
/// Levenberg-Marquardt method on the distances. None where no ellipse fits, or one 10,000 times as long as
/// wide.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse(std::span<const Eigen::Vector2d> points);

/// The same through most of the points, whatever the others are: the ellipse through six of them that most
/// lie on to within `tolerance` px, out of a few hundred tries that are the same every time, then through all
/// that lie within 3.5 times the rms of the rest. `points` keeps those.
[[nodiscard]] std::optional<EllipseFit> fit_ellipse_to_most(std::vector<Eigen::Vector2d>& points,
                                                            double tolerance = 0.6);

/// The share of the way around an ellipse, by its eccentric anomaly, along which there are points: two
/// parallel sides lie on a long ellipse, and cover little of it.
[[nodiscard]] double share_around(const EllipseFit& ellipse, std::span<const Eigen::Vector2d> points);

/// The distance of a point from an ellipse, positive outside, px.
[[nodiscard]] double distance_to(const EllipseFit& ellipse, const Eigen::Vector2d& point);

}  // namespace flexura
