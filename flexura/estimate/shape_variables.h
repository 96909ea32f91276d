#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// What is known of an arm before it is looked at.
struct ShapePrior {
  Arm arm;  ///< Its sections, and its base as far as it is known.
  bool is_base_position_known = true;
  bool is_base_direction_known = true;  ///< And how the arm is turned about it.
  bool is_length_known = true;          ///< Otherwise all sections stretch alike.
  /// Standard deviation of the change of curvature from one section to the next, 1/m; infinite: sections bend
  /// as they like. Smooth arms of unknown make are many short sections with a small one.
  double curvature_step = std::numeric_limits<double>::infinity();
  /// Where its markers' middles are, m along the unstretched arm, rising; empty: not known.
  std::vector<double> markers = {};
};

/// An arm as it may be: a point in the space of what is not known.
struct Shape {
  Arm arm;
  ArmState state;
};

/// The unknowns of a prior, in this order: the bends (x and y of each section; of planar arms x alone), the
/// base's position (m, W), its turn about its own x and y (rad), the logarithm of the stretch.
class ShapeVariables {
 public:
  explicit ShapeVariables(const ShapePrior& prior);

  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] Eigen::Index bends_a_section() const { return bends_; }
  /// `shape` moved by `step`.
  [[nodiscard]] Shape moved(const Shape& shape, const Eigen::VectorXd& step) const;
  /// From the derivatives by all bends and stretches (3 a section, as jacobian.h has them) of a point p_WP to
  /// those by the unknowns: 3 x count().
  void by_unknowns(const Shape& shape, const Eigen::Vector3d& p_WP,
                   const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_state,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> by_unknowns) const;

 private:
  Eigen::Index sections_, bends_;
  Eigen::Index position_ = -1, direction_ = -1, stretch_ = -1;  // Where they begin; -1: known.
  Eigen::Index count_;
};

}  // namespace flexura
