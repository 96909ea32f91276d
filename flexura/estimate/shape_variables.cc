#include "flexura/estimate/shape_variables.h"

#include <Eigen/Geometry>
#include <cmath>

#include "flexura/math/so3.h"

namespace flexura {

ShapeVariables::ShapeVariables(const ShapePrior& prior, std::span<const Observation> observations)
    : sections_(static_cast<Eigen::Index>(prior.arm.sections.size())),
      bends_(prior.arm.kind == ArmKind::planar ? 1 : 2),
      count_(sections_ * bends_) {
  const auto take = [this](Eigen::Index count) { return count_ += count, count_ - count; };
  if (!prior.is_base_position_known) position_ = take(3);
  if (!prior.is_base_direction_known) direction_ = take(2);
  if (!prior.is_length_known) stretch_ = take(1);
  of_shape_ = count_;
  constexpr Eigen::Index of_view = 4;
  for (const Observation& seen : observations)
    views_.push_back(seen.view_prior.is_any() ? take(of_view) : -1);
}

Shape ShapeVariables::plus(const Shape& shape, const Eigen::VectorXd& step) const {
  Shape there = shape;
  for (Eigen::Index i = 0; i < sections_; ++i)
    there.state.bends[static_cast<std::size_t>(i)].head(bends_) += step.segment(i * bends_, bends_);
  if (position_ >= 0) there.arm.X_WB.position += step.segment<3>(position_);
  if (direction_ >= 0)
    there.arm.X_WB.rotation *= so3_exp(Eigen::Vector3d(step[direction_], step[direction_ + 1], 0));
  if (stretch_ >= 0)
    for (double& stretch : there.state.stretches) stretch *= std::exp(step[stretch_]);
  if (count_ > of_shape_) there.views.resize(views_.size());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (views_[i] < 0) continue;
    there.views[i].turn += step.segment<3>(views_[i]);
    there.views[i].focal += step[views_[i] + 3];
  }
  return there;
}

Eigen::VectorXd ShapeVariables::minus(const Shape& to, const Shape& from) const {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count_);
  for (Eigen::Index i = 0; i < sections_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    step.segment(i * bends_, bends_) = (to.state.bends[k] - from.state.bends[k]).head(bends_);
  }
  if (position_ >= 0) step.segment<3>(position_) = to.arm.X_WB.position - from.arm.X_WB.position;
  if (direction_ >= 0)
    step.segment<2>(direction_) =
        so3_log(from.arm.X_WB.rotation.transpose() * to.arm.X_WB.rotation).head<2>();
  if (stretch_ >= 0) step[stretch_] = std::log(to.state.stretches.front() / from.state.stretches.front());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (views_[i] < 0) continue;
    const ViewError was = i < from.views.size() ? from.views[i] : ViewError{},
                    is = i < to.views.size() ? to.views[i] : ViewError{};
    step.segment<3>(views_[i]) = is.turn - was.turn;
    step[views_[i] + 3] = is.focal - was.focal;
  }
  return step;
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
