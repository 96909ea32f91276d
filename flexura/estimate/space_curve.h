#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Intervals for each section of the prior's arm, so that knots follow bends of a quarter turn or so; of many
/// short sections two are enough.
[[nodiscard]] std::size_t intervals_a_section(const ShapePrior& prior);

/// A backbone by knots, evenly along each section, with derivatives by the unknowns. Reused, it allocates no
/// more.
class SpaceCurve {
 public:
  /// A place of the curve, and how its position depends on the unknowns.
  struct Knot {
    Eigen::Vector3d position;                           ///< p_WP, m.
    Eigen::Vector3d tangent;                            ///< Unit, W.
    Eigen::Matrix<double, 3, Eigen::Dynamic> unknowns;  ///< Of the position, by those that it depends on.
  };

  /// `intervals` in each section, at least 2.
  SpaceCurve(const ShapeVariables& variables, std::size_t intervals)
      : variables_(variables), intervals_(intervals) {}

  /// Sets it to a shape of the prior's arm. std::invalid_argument: a state that does not fit the arm.
  void set(const Shape& shape);

  /// `intervals` of each section, and one more: the first at the base, the last at the tip.
  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  [[nodiscard]] std::size_t intervals_a_section() const { return intervals_; }
  /// Arc length between knots i and i + 1, m.
  [[nodiscard]] double interval(std::size_t i) const { return lengths_[i / intervals_]; }
  /// Where the point `s` m along the unstretched arm lies, counted in knots: 0 at the base, the number of
  /// intervals at the tip; before and after, those.
  [[nodiscard]] double place_of(const Arm& arm, double s) const;
  /// The inverse, m along the unstretched arm.
  [[nodiscard]] double s_of(const Arm& arm, double place) const;

 private:
  ShapeVariables variables_;
  std::size_t intervals_;
  std::vector<Knot> knots_;
  std::vector<double> lengths_;  // Of an interval, one a section.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_state_;
};

}  // namespace flexura
