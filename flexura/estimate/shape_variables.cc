#include "flexura/estimate/shape_variables.h"

#include <Eigen/Geometry>
#include <cmath>

#include "flexura/math/so3.h"

namespace flexura {

ShapeVariables::ShapeVariables(const ShapePrior& prior)
    : sections_(static_cast<Eigen::Index>(prior.arm.sections.size())),
      bends_(prior.arm.kind == ArmKind::planar ? 1 : 2),
      count_(sections_ * bends_) {
  const auto take = [this](Eigen::Index count) { return count_ += count, count_ - count; };
  if (!prior.is_base_position_known) position_ = take(3);
  if (!prior.is_base_direction_known) direction_ = take(2);
  if (!prior.is_length_known) stretch_ = take(1);
}

Shape ShapeVariables::moved(const Shape& shape, const Eigen::VectorXd& step) const {
  Shape there = shape;
  for (Eigen::Index i = 0; i < sections_; ++i)
    there.state.bends[static_cast<std::size_t>(i)].head(bends_) += step.segment(i * bends_, bends_);
  if (position_ >= 0) there.arm.X_WB.position += step.segment<3>(position_);
  if (direction_ >= 0)
    there.arm.X_WB.rotation *= so3_exp(Eigen::Vector3d(step[direction_], step[direction_ + 1], 0));
  if (stretch_ >= 0)
    for (double& stretch : there.state.stretches) stretch *= std::exp(step[stretch_]);
  return there;
}

void ShapeVariables::by_unknowns(const Shape& shape, const Eigen::Vector3d& p_WP,
                                 const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_state,
                                 Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> by_unknowns) const {
  for (Eigen::Index i = 0; i < sections_; ++i)
    by_unknowns.middleCols(i * bends_, bends_) = by_state.block(0, 3 * i, 3, bends_);
  const Pose& X_WB = shape.arm.X_WB;
  if (position_ >= 0) by_unknowns.middleCols<3>(position_).setIdentity();
  if (direction_ >= 0) {
    const Eigen::Vector3d arm = p_WP - X_WB.position;
    for (Eigen::Index i = 0; i < 2; ++i) by_unknowns.col(direction_ + i) = X_WB.rotation.col(i).cross(arm);
  }
  if (stretch_ >= 0) {
    by_unknowns.col(stretch_).setZero();
    for (Eigen::Index i = 0; i < sections_; ++i)
      by_unknowns.col(stretch_) +=
          shape.state.stretches[static_cast<std::size_t>(i)] * by_state.block<3, 1>(0, 3 * i + 2);
  }
}

}  // namespace flexura
