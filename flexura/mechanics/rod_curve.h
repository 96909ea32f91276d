#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// A smooth curve through places along a rod, with a cubic between consecutive places. The slope at a place
/// is the slope of the parabola through this place and its two neighbours. The tangent is continuous, and the
/// error on a smooth rod is of fourth order in the spacing.
class RodCurve {
 public:
  /// Segment from one place to the next, computed from four places x_i: x(u) = sum of weights.row(i) (1, u,
  /// u^2, u^3)^T x_i, u from 0 to 1. The segment is between the second and the third place.
  struct Segment {
    std::array<std::size_t, 4> places{};
    Eigen::Matrix4d weights = Eigen::Matrix4d::Zero();
  };
  /// Geometry of a segment: x(u) = sum of powers.col(k) u^k. The segment is inside the ball of radius
  /// `reach`, m, about `middle`.
  struct Piece {
    Eigen::Matrix<double, 3, 4> powers;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double reach = 0;

    /// Returns the point x(u), m, for u in [0, 1].
    [[nodiscard]] Eigen::Vector3d at(double u) const {
      return powers.col(0) + u * (powers.col(1) + u * (powers.col(2) + u * powers.col(3)));
    }
    /// Returns dx/du.
    [[nodiscard]] Eigen::Vector3d slope_at(double u) const {
      return powers.col(1) + u * (2 * powers.col(2) + 3 * u * powers.col(3));
    }
    /// Returns d2x/du2.
    [[nodiscard]] Eigen::Vector3d bend_at(double u) const {
      return 2 * powers.col(2) + 6 * u * powers.col(3);
    }
  };

  RodCurve() = default;
  /// `s`: positions of the places along the rod, rising, m.
  explicit RodCurve(std::span<const double> s);

  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  /// Returns the curve of a segment through the positions of its four points.
  [[nodiscard]] static Piece piece(const Segment& segment, const std::array<Eigen::Vector3d, 4>& places);

 private:
  std::vector<Segment> segments_;
};

}  // namespace flexura
