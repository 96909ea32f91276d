#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns the number of intervals between knots in each section of the prior's arm. The number is sufficient
/// for bends of about a quarter turn per section. Many short sections need only two intervals each.
[[nodiscard]] std::size_t intervals_a_section(const ShapePrior& prior);

/// A backbone as knots, evenly spaced along each section, with derivatives with respect to the unknowns.
/// Allocates only in the first use.
class SpaceCurve {
 public:
  /// A point of the curve, and its derivative with respect to the unknowns.
  struct Knot {
    Eigen::Vector3d position;  ///< Position p_WP, m.
    Eigen::Vector3d tangent;   ///< Unit tangent, W.
    /// Derivative of the position with respect to the unknowns on which it depends.
    Eigen::Matrix<double, 3, Eigen::Dynamic> unknowns;
  };

  /// `intervals`: number of intervals in each section, at least 2.
  SpaceCurve(const ShapeVariables& variables, std::size_t intervals)
      : variables_(variables), intervals_(intervals) {}

  /// Computes the curve of a shape of the prior's arm. Throws std::invalid_argument for a state that does not
  /// fit the arm.
  void set(const Shape& shape);

  /// Returns the knots, `intervals` per section plus one: the first is at the base, the last at the tip.
  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  [[nodiscard]] std::size_t intervals_a_section() const { return intervals_; }
  /// Returns the arc length between knots i and i + 1, m.
  [[nodiscard]] double interval(std::size_t i) const { return lengths_[i / intervals_]; }
  /// Returns the position, as a fractional index of knots, of the point `s` m along the unstretched arm. The
  /// index is 0 at the base and the number of intervals at the tip. The index is clamped to this range.
  [[nodiscard]] double place_of(const Arm& arm, double s) const;
  /// Returns the inverse of place_of(): the arc length on the unstretched arm, m.
  [[nodiscard]] double s_of(const Arm& arm, double place) const;

 private:
  ShapeVariables variables_;
  std::size_t intervals_;
  std::vector<Knot> knots_;
  std::vector<double> lengths_;  // Length of an interval, one per section.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_state_;
};

}  // namespace flexura
