#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Prior knowledge of an arm.
struct ShapePrior {
  Arm arm;                              ///< Its sections, and its base as far as known.
  bool is_base_position_known = true;   ///< Whether the position in Arm::X_WB is known; else it is estimated.
  bool is_base_direction_known = true;  ///< Whether the rotation in Arm::X_WB is known; else it is estimated.
  bool is_length_known = true;          ///< Otherwise all sections have a common stretch.
  /// Standard deviation of the change of curvature from one section to the next, 1/m; infinite: sections bend
  /// independently. Smooth arms without a kinematic model are many short sections with a small one.
  double curvature_step = std::numeric_limits<double>::infinity();
  /// Positions of its markers' middles, m along the unstretched arm, ascending; empty: not known.
  std::vector<double> markers = {};
};

/// A possible arm: a point in the space of the unknowns.
struct Shape {
  Arm arm;  ///< With the estimated base.
  ArmState state;
  std::vector<ViewError> views = {};  ///< Errors of the cameras' views; missing entries mean no error.
};

/// Previous knowledge of a shape.
struct ShapePrediction {
  Shape mean;
  Eigen::MatrixXd covariance;  ///< Covariance of the unknowns (ShapeVariables), including views with a prior.
};

/// The unknowns of a prior, in this order: the bends (x and y of each section; of planar arms x alone), the
/// base's position (m, W). Then its rotation about its own x and y (rad), and the logarithm of the stretch.
/// Then the error of each view with a prior (turn in rad, focal).
class ShapeVariables {
 public:
  /// `observations` show which views have a prior.
  explicit ShapeVariables(const ShapePrior& prior, std::span<const Observation> observations = {});

  /// Returns the number of all unknowns.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Returns the number of unknowns of the arm's shape, which come first.
  [[nodiscard]] Eigen::Index of_shape() const { return of_shape_; }
  /// Returns the first index of the error of an observation's view; -1: it has none.
  [[nodiscard]] Eigen::Index of_view(std::size_t observation) const {
    return observation < views_.size() ? views_[observation] : -1;
  }
  /// Returns 1 for a planar arm, 2 for a spatial one.
  [[nodiscard]] Eigen::Index bends_a_section() const { return bends_; }
  /// Returns the step from `from` to `to`: the inverse of plus(), to first order in rotations of the base.
  [[nodiscard]] Eigen::VectorXd minus(const Shape& to, const Shape& from) const;
  /// Returns `shape` moved by `step`.
  [[nodiscard]] Shape plus(const Shape& shape, const Eigen::VectorXd& step) const;
  /// Converts the derivatives of a point p_WP by all bends and stretches (3 per section, as in jacobian.h) to
  /// those by the unknowns: 3 x of_shape().
  void by_unknowns(const Shape& shape, const Eigen::Vector3d& p_WP,
                   const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_state,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> by_unknowns) const;

 private:
  Eigen::Index sections_, bends_;
  Eigen::Index position_ = -1, direction_ = -1, stretch_ = -1;  // First index; -1: known.
  std::vector<Eigen::Index> views_;                             // First index by observation; -1: no error.
  Eigen::Index of_shape_, count_;
};

}  // namespace flexura
