#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace flexura {

/// How many moments a curve's image has in curve_moments().
inline constexpr Eigen::Index moment_count = 6;

/// Which features of an arm's image make up the vector that is steered, in each camera. Shares are of the
/// unstretched arm's length, from its base.
struct FeatureSet {
  std::vector<double> points = {};  ///< Shares whose pixels (u, v) count, px.
  std::vector<std::array<double, 2>> chords =
      {};                      ///< Pairs of shares: the angle of the image of their chord.
  double angle_weight = 100;   ///< px for a radian.
  bool has_moments = false;    ///< The moments of the curve's image (curve_moments).
  int moment_points = 33;      ///< Corners of the polygon that they are taken of.
  double moment_weight = 100;  ///< Second moments count as px^2 over so many px.

  /// Points at `count` equal shares, the last one the tip.
  [[nodiscard]] static FeatureSet of_points(int count);
  /// The angles of `count` chords in a row from base to tip.
  [[nodiscard]] static FeatureSet of_chords(int count);
  /// The moments.
  [[nodiscard]] static FeatureSet of_moments();
  /// Rows that one camera gives.
  [[nodiscard]] Eigen::Index rows() const;
};

/// The shares of the arm whose pixels a camera needs for the features, in the order in which feature_values()
/// takes them: points, chords' ends, the polygon's corners. std::invalid_argument: a share outside [0, 1].
[[nodiscard]] std::vector<double> needed_shares(const FeatureSet& set);

/// One camera's features (values, set.rows() of them) from the pixels of needed_shares(), however these were
/// come by. None where an image has no direction or length. std::invalid_argument for another number of
/// pixels.
[[nodiscard]] std::optional<Eigen::VectorXd> feature_values(const FeatureSet& set,
                                                            const Eigen::Matrix2Xd& pixels);

/// `seen` less `desired`, the angles' differences within half a turn. std::invalid_argument for vectors that
/// are not of this set.
[[nodiscard]] Eigen::VectorXd feature_error(const FeatureSet& set, const Eigen::VectorXd& seen,
                                            const Eigen::VectorXd& desired);
/// The same, into what is made to fit.
void feature_error(const FeatureSet& set, const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                   Eigen::VectorXd& error);

}  // namespace flexura
