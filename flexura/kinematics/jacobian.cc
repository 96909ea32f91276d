#include "flexura/kinematics/jacobian.h"

#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/math/series.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

using Columns = BackboneJacobian::Columns;

// A point of a section, in the frame at the section's base, and its twist per unit rate of bend_x, bend_y and
// stretch.
struct PointOfSection {
  Pose X_SP;
  Columns V_S;
};

// A point at the fraction f is the end of an arc with bend f * bend and length f * stretch * rest_length.
PointOfSection point_of(const BackboneJacobian::Part& part, double fraction) {
  const Eigen::Vector2d bend = fraction * part.bend;
  const double x = bend.x(), y = bend.y(), length = fraction * part.stretch * part.rest_length;
  const auto [S, A, C, S_slope, A_slope] = bend_functions(bend.norm());
  // The gradient of g(|bend|) is g'(t)/t times the bend, smooth at t = 0.
  const double across = length * A, along_slope = length * S_slope;
  const double across_x = length * A_slope * x, across_y = length * A_slope * y;
  Columns V;
  V << x * across_x + across, x * across_y, A * x,  //
      y * across_x, y * across_y + across, A * y,   //
      along_slope * x, along_slope * y, S,          //
      // Of the rotation vector (-y, x, 0): columns of so3_left_jacobian without its zeros.
      -C * x * y, C * x * x - 1, 0,  //
      1 - C * y * y, C * y * x, 0,   //
      -A * y, A * x, 0;
  V.leftCols<2>() *= fraction;
  V.col(2) *= fraction * part.rest_length;
  return {arc_pose(bend, length, S, A), V};
}

Columns turned(const Eigen::Matrix3d& rotation, const Columns& V) {
  Columns result;
  result.topRows<3>() = rotation * V.topRows<3>();
  result.bottomLeftCorner<3, 2>() = rotation * V.bottomLeftCorner<3, 2>();
  result.bottomRightCorner<3, 1>().setZero();  // A stretch does not rotate the point.
  return result;
}

}  // namespace

void BackboneJacobian::set(const Arm& arm, const ArmState& state) {
  require_fit(arm, state);
  parts_.resize(arm.sections.size());
  Pose X_WS = arm.X_WB;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    part.X_WS = X_WS;
    part.bend = state.bends[i];
    part.rest_length = arm.sections[i].length;
    part.stretch = state.stretches[i];
    const PointOfSection end = point_of(part, 1.0);
    part.V_end = turned(X_WS.rotation, end.V_S);
    X_WS = X_WS * end.X_SP;
    part.p_end = X_WS.position;
  }
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
  const Part& own = parts_[point.section];
  const auto own_column = static_cast<Eigen::Index>(3 * point.section);
  Eigen::Vector3d p_WP = own.p_end;
  if (point.fraction == 1.0) {
    J.middleCols<3>(own_column) = own.V_end;
  } else {
    const PointOfSection inside = point_of(own, point.fraction);
    J.middleCols<3>(own_column) = turned(own.X_WS.rotation, inside.V_S);
    p_WP = own.X_WS * inside.X_SP.position;
  }
  for (std::size_t i = 0; i < point.section; ++i) {
    // Everything past section i moves with its end as one rigid body.
    auto columns = J.middleCols<3>(static_cast<Eigen::Index>(3 * i));
    const Eigen::Vector3d lever = p_WP - parts_[i].p_end;
    columns = parts_[i].V_end;
    for (const Eigen::Index bend : {0, 1}) {
      const Eigen::Vector3d turning = columns.col(bend).tail<3>();
      columns.col(bend).head<3>() -= lever.cross(turning);
    }
  }
  J.rightCols(J.cols() - own_column - 3).setZero();
}

Jacobian tip_jacobian(const Arm& arm, const ArmState& state) {
  Jacobian J(6, 3 * static_cast<Eigen::Index>(arm.sections.size()));
  BackboneJacobian(arm, state).tip(J);
  return J;
}

}  // namespace flexura
