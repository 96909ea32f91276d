#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace flexura {

/// Number of moments of a curve's image in curve_moments().
inline constexpr Eigen::Index moment_count = 6;

/// Features of an arm's image in each camera. A law controls the vector of all features. Points are given as
/// shares of the unstretched arm's length, from its base.
struct FeatureSet {
  std::vector<double> points = {};  ///< Shares of the points whose pixels (u, v) are features, px.
  /// Pairs of shares. The feature of a pair is the angle of the image of the chord between its two points,
  /// rad.
  std::vector<std::array<double, 2>> chords = {};
  double angle_weight = 100;  ///< Weight of the angles, px per radian.
  bool has_moments = false;   ///< Whether the moments of the curve's image (curve_moments) are features.
  int moment_points = 33;     ///< Number of vertices of the polyline for the moments.
  /// Length by which the second moments (px^2) are divided to obtain features in px, px.
  double moment_weight = 100;

  /// Returns the features of `count` evenly spaced points; the last point is the tip.
  [[nodiscard]] static FeatureSet of_points(int count);
  /// Returns the angles of `count` consecutive chords from base to tip.
  [[nodiscard]] static FeatureSet of_chords(int count);
  /// Returns the features of the moments.
  [[nodiscard]] static FeatureSet of_moments();
  /// Returns the number of features per camera.
  [[nodiscard]] Eigen::Index rows() const;
};

/// Returns the shares of the points whose pixels the features need, in the order of feature_values(). These
/// points are the feature points, the ends of the chords, and the vertices of the polyline. Throws
/// std::invalid_argument for a share outside [0, 1].
[[nodiscard]] std::vector<double> needed_shares(const FeatureSet& set);

/// Returns one camera's features (set.rows() values) from measured or predicted pixels of needed_shares().
/// Returns std::nullopt if a chord's image has no direction, or the curve's image has no length. Throws
/// std::invalid_argument for a wrong number of pixels.
[[nodiscard]] std::optional<Eigen::VectorXd> feature_values(const FeatureSet& set,
                                                            const Eigen::Matrix2Xd& pixels);

/// Returns `seen` minus `desired`, with angle differences wrapped to at most half a turn. Throws
/// std::invalid_argument for vectors that do not fit this set.
[[nodiscard]] Eigen::VectorXd feature_error(const FeatureSet& set, const Eigen::VectorXd& seen,
                                            const Eigen::VectorXd& desired);
/// Computes the error into `error`, which it resizes if needed.
void feature_error(const FeatureSet& set, const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                   Eigen::VectorXd& error);

}  // namespace flexura
