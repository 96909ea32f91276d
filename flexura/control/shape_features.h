#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace flexura {

/// Number of moments of a curve's image in curve_moments().
inline constexpr Eigen::Index moment_count = 6;

/// Features of an arm's image in each camera that form the controlled vector. Shares are of the unstretched
/// arm's length, from its base.
struct FeatureSet {
  std::vector<double> points = {};                 ///< Shares of points whose pixels (u, v) count, px.
  std::vector<std::array<double, 2>> chords = {};  ///< Pairs of shares: angle of the image of their chord.
  double angle_weight = 100;                       ///< In px per radian.
  bool has_moments = false;                        ///< The moments of the curve's image (curve_moments).
  int moment_points = 33;                          ///< Corners of the polygon for the moments.
  double moment_weight = 100;                      ///< Second moments, px^2, are divided by this, px.

  /// Returns points at `count` equal shares, the last one the tip.
  [[nodiscard]] static FeatureSet of_points(int count);
  /// Returns the angles of `count` consecutive chords from base to tip.
  [[nodiscard]] static FeatureSet of_chords(int count);
  /// Returns the moments.
  [[nodiscard]] static FeatureSet of_moments();
  /// Returns the number of rows per camera.
  [[nodiscard]] Eigen::Index rows() const;
};

/// Returns the shares of the arm whose pixels a camera needs for the features, in the order of
/// feature_values(): points, chords' ends, the polygon's corners. Throws std::invalid_argument for a share
/// outside [0, 1].
[[nodiscard]] std::vector<double> needed_shares(const FeatureSet& set);

/// Returns one camera's features (set.rows() values) from the pixels of needed_shares(), from any source.
/// Returns std::nullopt if an image has no direction or length. Throws std::invalid_argument for another
/// number of pixels.
[[nodiscard]] std::optional<Eigen::VectorXd> feature_values(const FeatureSet& set,
                                                            const Eigen::Matrix2Xd& pixels);

/// Returns `seen` minus `desired`, with the angles' differences within half a turn. Throws
/// std::invalid_argument for vectors that are not of this set.
[[nodiscard]] Eigen::VectorXd feature_error(const FeatureSet& set, const Eigen::VectorXd& seen,
                                            const Eigen::VectorXd& desired);
/// Computes the error into `error`, which it resizes if needed.
void feature_error(const FeatureSet& set, const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                   Eigen::VectorXd& error);

}  // namespace flexura
