#include "flexura/kinematics/tip_problem.h"

#include <cmath>

#include "flexura/kinematics/arc_motion.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Returns the rotation vector, without rotation about z, from the direction d to z; both in the tip's frame.
Eigen::Vector2d turn_from(const Eigen::Vector3d& d) {
  const double sine = std::hypot(d.x(), d.y());
  const double angle = std::atan2(sine, d.z());
  // For -z, which has many half turns, takes the one about x.
  if (sine < 1e-300) return {angle, 0.0};
  return Eigen::Vector2d(d.y(), -d.x()) * (angle / sine);
}

}  // namespace

TipProblem::TipProblem(TipRows rows, const ArmVariables& variables, const Pose& X_BT, double length,
                       double position_tolerance, double angle_tolerance)
    : rows_(rows),
      variables_(variables),
      X_BT_(X_BT),
      scale_(1.0 / length),
      position_tolerance_(position_tolerance * scale_),
      angle_tolerance_(angle_tolerance),
      linear_(3, variables.size()),
      angular_(3, variables.size()),
      ends_(3, static_cast<Eigen::Index>(variables.parts().size())) {}

void TipProblem::chain(const Eigen::VectorXd& x) {
  tip_ = Pose{};
  Eigen::Index section = 0;
  for (const ArmVariables::Part& part : variables_.parts()) {
    const double stretch = part.stretch(x);
    const ArcMotion motion = arc_motion(part.bend(x), part.length * stretch);
    const Eigen::Vector3d along = tip_.rotation * motion.position;
    for (Eigen::Index k = 0; k < (part.is_spatial ? 2 : 1); ++k) {
      linear_.col(part.at + k).noalias() = tip_.rotation * motion.linear.col(k);
      angular_.col(part.at + k).noalias() = tip_.rotation * motion.angular.col(k);
    }
    if (part.is_stretchable) {
      linear_.col(part.stretch_at()) = along / stretch;
      angular_.col(part.stretch_at()).setZero();
    }
    tip_.position += along;
    tip_.rotation *= motion.rotation;
    ends_.col(section++) = tip_.position;
  }
}

void TipProblem::linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
  chain(x);
  const Eigen::Index angles = row_count() - 3;
  Eigen::Index section = 0;
  for (const ArmVariables::Part& part : variables_.parts()) {
    const Eigen::Vector3d lever = tip_.position - ends_.col(section++);
    const Eigen::Index end = part.stretch_at() + (part.is_stretchable ? 1 : 0);
    for (Eigen::Index k = part.at; k < end; ++k) {
      const Eigen::Vector3d angular = angular_.col(k);
      J.col(k).head<3>() = scale_ * (linear_.col(k) + angular.cross(lever));
      for (Eigen::Index i = 0; i < angles; ++i) J(3 + i, k) = tip_.rotation.col(i).dot(angular);
    }
  }
  r.head<3>() = scale_ * (tip_.position - X_BT_.position);
  if (rows_ == TipRows::direction)
    r.tail<2>() = turn_from(tip_.rotation.transpose() * X_BT_.rotation.col(2));
  else if (rows_ == TipRows::rotation)
    r.tail<3>() = so3_log(X_BT_.rotation.transpose() * tip_.rotation);
}

bool TipProblem::is_met(const Eigen::VectorXd& r) const {
  return r.head<3>().squaredNorm() <= position_tolerance_ * position_tolerance_ &&
         r.tail(r.size() - 3).squaredNorm() <= angle_tolerance_ * angle_tolerance_;
}

}  // namespace flexura
