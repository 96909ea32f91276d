#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "flexura/estimate/sighting.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// What is known of an arm before it is looked at.
struct ShapePrior {
  Arm arm;                              ///< Its sections, and its base as far as it is known.
  bool is_base_position_known = true;   ///< Arm::X_WB's position holds.
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
  Arm arm;  ///< With what is found of its base.
  ArmState state;
  std::vector<ViewError> views = {};  ///< Of the cameras that see it; of those that are not here, none.
};

/// What is known of a shape from before it is looked at.
struct ShapeBelief {
  Shape mean;
  Eigen::MatrixXd covariance;  ///< Of the unknowns (ShapeVariables), views in doubt among them.
};

/// The unknowns of a prior, in this order: the bends (x and y of each section; of planar arms x alone), the
/// base's position (m, W), its turn about its own x and y (rad), the logarithm of the stretch; then of every
/// view that is in doubt its error (turn in rad, focal).
class ShapeVariables {
 public:
  /// `sightings` say which views are in doubt.
  explicit ShapeVariables(const ShapePrior& prior, std::span<const Sighting> sightings = {});

  /// Of all unknowns.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Of these the ones that the arm's shape depends on come first.
  [[nodiscard]] Eigen::Index of_shape() const { return of_shape_; }
  /// Where the error of a sighting's view begins; -1: it has none.
  [[nodiscard]] Eigen::Index of_view(std::size_t sighting) const {
    return sighting < views_.size() ? views_[sighting] : -1;
  }
  /// 1 of a planar arm, 2 of a spatial one.
  [[nodiscard]] Eigen::Index bends_a_section() const { return bends_; }
  /// The step that leads to `to` from `from`: the inverse of plus(), to first order in turns of the base.
  [[nodiscard]] Eigen::VectorXd minus(const Shape& to, const Shape& from) const;
  /// `shape` moved by `step`.
  [[nodiscard]] Shape plus(const Shape& shape, const Eigen::VectorXd& step) const;
  /// From the derivatives by all bends and stretches (3 a section, as jacobian.h has them) of a point p_WP to
  /// those by the unknowns: 3 x of_shape().
  void by_unknowns(const Shape& shape, const Eigen::Vector3d& p_WP,
                   const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_state,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> by_unknowns) const;

 private:
  Eigen::Index sections_, bends_;
  Eigen::Index position_ = -1, direction_ = -1, stretch_ = -1;  // Where they begin; -1: known.
  std::vector<Eigen::Index> views_;                             // Likewise, of each sighting.
  Eigen::Index of_shape_, count_;
};

}  // namespace flexura
