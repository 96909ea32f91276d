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
  Arm arm;  ///< Sections of the arm, and its base as far as known.
  /// Whether the position in Arm::X_WB is known; otherwise it is estimated.
  bool is_base_position_known = true;
  /// Whether the rotation in Arm::X_WB is known; otherwise it is estimated.
  bool is_base_direction_known = true;
  bool is_length_known =
      true;  ///< Whether the length is known; otherwise one stretch, common to all sections, is estimated.
  /// Standard deviation of the change of curvature from one section to the next, 1/m; infinite: sections bend
  /// independently. An arm without a kinematic model is represented by many short sections with a small
  /// standard deviation.
  double curvature_step = std::numeric_limits<double>::infinity();
  /// Increasing arc lengths of the middles of the arm's markers on the unstretched arm, m; empty: unknown.
  std::vector<double> markers = {};
};

/// Estimated arm, shape and view errors: values of all unknowns.
struct Shape {
  Arm arm;  ///< The arm with the estimated base.
  ArmState state;
  std::vector<ViewError> views = {};  ///< Errors of the cameras' views; missing entries mean no error.
};

/// Predicted shape with its covariance.
struct ShapePrediction {
  Shape mean;
  Eigen::MatrixXd covariance;  ///< Covariance of the unknowns (ShapeVariables), including views with a prior.
  /// Whether this is a guess, not the state of a filter. The covariance of the estimate then allows for the
  /// correlated errors of the observations. A filter treats them as independent.
  bool is_guess = false;
};

/// The unknowns of a prior, in order. First are the bends (x and y of each section; only x for planar arms).
/// Next are the base's position (m, in W), the base's rotation about its own x and y (rad), and the logarithm
/// of the stretch. Last is the error of each view with a prior (turn in rad, focal).
class ShapeVariables {
 public:
  /// `observations`: their view priors determine which views have an error.
  explicit ShapeVariables(const ShapePrior& prior, std::span<const Observation> observations = {});

  /// Returns the number of all unknowns.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Returns the number of unknowns of the arm's shape. These unknowns are the first unknowns.
  [[nodiscard]] Eigen::Index of_shape() const { return of_shape_; }
  /// Returns the index of the first unknown of the error of an observation's view; -1: the view has no error.
  [[nodiscard]] Eigen::Index of_view(std::size_t observation) const {
    return observation < views_.size() ? views_[observation] : -1;
  }
  /// Returns the number of bends of a section: 1 for a planar arm, 2 for a spatial arm.
  [[nodiscard]] Eigen::Index bends_a_section() const { return bends_; }
  /// Returns the step from `from` to `to`: the inverse of plus(), to first order in rotations of the base.
  [[nodiscard]] Eigen::VectorXd minus(const Shape& to, const Shape& from) const;
  /// Returns `shape` changed by `step`.
  [[nodiscard]] Shape plus(const Shape& shape, const Eigen::VectorXd& step) const;
  /// Converts the derivatives of a point p_WP with respect to all bends and stretches (3 per section, as in
  /// jacobian.h). The result has the derivatives with respect to the unknowns: 3 x of_shape().
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
