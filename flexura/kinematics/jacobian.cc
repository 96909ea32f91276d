#include "flexura/kinematics/jacobian.h"

#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/math/series.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// The twist of an arc's end, in the frame at its start, per unit rate of bend_x, bend_y and length.
Eigen::Matrix<double, 6, 3> arc_derivatives(const Eigen::Vector2d& bend, double length) {
  const double t = bend.norm();
  Eigen::Matrix<double, 6, 3> V;
  // The gradient of g(|bend|) is g'(t)/t times the bend: the slopes below, smooth at t = 0.
  const Eigen::Vector2d across_slope = length * cosc_slope(t) * bend;
  V.topLeftCorner<2, 2>() = bend * across_slope.transpose();
  V.topLeftCorner<2, 2>().diagonal().array() += length * cosc(t);
  V.block<1, 2>(2, 0) = (length * sinc_slope(t)) * bend.transpose();
  V.block<3, 1>(0, 2) << cosc(t) * bend, sinc(t);
  // The rotation vector is (-bend_y, bend_x, 0).
  const Eigen::Matrix3d J_left = so3_left_jacobian({-bend.y(), bend.x(), 0.0});
  V.block<3, 1>(3, 0) = J_left.col(1);
  V.block<3, 1>(3, 1) = -J_left.col(0);
  V.block<3, 1>(3, 2).setZero();
  return V;
}

}  // namespace

void BackboneJacobian::set(const Arm& arm, const ArmState& state) {
  frames_.resize(arm.sections.size() + 1);
  section_frames(arm, state, frames_);
  parts_.clear();
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    Part& part = parts_.emplace_back(Part{frames_[i], state.bends[i], arm.sections[i].length,
                                          state.stretches[i], Columns::Zero(), frames_[i + 1].position});
    part.V_end = own_columns(part, 1.0);
  }
}

// A point a fraction f along is the end of an arc with bend f * bend and length f * stretch * rest_length.
BackboneJacobian::Columns BackboneJacobian::own_columns(const Part& part, double fraction) {
  Columns V = arc_derivatives(fraction * part.bend, fraction * part.stretch * part.rest_length);
  V.leftCols<2>() *= fraction;
  V.col(2) *= fraction * part.rest_length;
  Columns V_W;
  V_W.topRows<3>() = part.X_WS.rotation * V.topRows<3>();
  V_W.bottomRows<3>() = part.X_WS.rotation * V.bottomRows<3>();
  return V_W;
}

Pose BackboneJacobian::pose(const MaterialPoint& point) const {
  const Part& part = parts_[point.section];
  return part.X_WS * arc_pose(point.fraction * part.bend, point.fraction * part.stretch * part.rest_length);
}

void BackboneJacobian::at(const MaterialPoint& point, Eigen::Ref<Jacobian> J) const {
  if (point.section >= parts_.size() || J.cols() != static_cast<Eigen::Index>(3 * parts_.size())) {
    throw std::invalid_argument("a Jacobian of " + std::to_string(J.cols()) + " columns for section " +
                                std::to_string(point.section) + " does not fit an arm of " +
                                std::to_string(parts_.size()) + " sections");
  }
  const bool at_end = point.fraction == 1.0;
  const Part& own = parts_[point.section];
  const Eigen::Vector3d p_WP = at_end ? own.p_end : pose(point).position;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < point.section; ++i, column += 3) {
    // Everything past section i moves with its end as one rigid body.
    J.middleCols<3>(column) = parts_[i].V_end;
    const Eigen::Matrix3d lever = skew(p_WP - parts_[i].p_end);
    J.block<3, 3>(0, column) -= lever * parts_[i].V_end.bottomRows<3>();
  }
  J.middleCols<3>(column) = at_end ? own.V_end : own_columns(own, point.fraction);
  J.rightCols(J.cols() - column - 3).setZero();
}

Jacobian tip_jacobian(const Arm& arm, const ArmState& state) {
  Jacobian J(6, 3 * static_cast<Eigen::Index>(arm.sections.size()));
  BackboneJacobian(arm, state).tip(J);
  return J;
}

std::vector<Jacobian> backbone_jacobians(const Arm& arm, const ArmState& state,
                                         std::span<const MaterialPoint> points) {
  const BackboneJacobian jacobian(arm, state);
  std::vector<Jacobian> result(points.size(),
                               Jacobian(6, 3 * static_cast<Eigen::Index>(arm.sections.size())));
  for (std::size_t i = 0; i < points.size(); ++i) jacobian.at(points[i], result[i]);
  return result;
}

}  // namespace flexura
