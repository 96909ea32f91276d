#include "flexura/kinematics/inverse_check.h"

#include <cmath>
#include <stdexcept>

namespace flexura {
namespace {

void require(bool holds, const char* expected) {
  if (!holds) throw std::invalid_argument(std::string("inverse kinematics: expected ") + expected);
}

void check_config(const InverseConfig& config) {
  require(!config.position_tolerance || *config.position_tolerance > 0.0, "a positive position tolerance");
  require(config.angle_tolerance > 0.0, "a positive angle tolerance");
  require(config.max_starts >= 1, "at least one start");
}

}  // namespace

void check_question(const TipTarget& target, const InverseConfig& config) {
  constexpr double orthonormal = 1e-6;
  check_config(config);
  require(target.position.allFinite(), "a finite position");
  require(!(target.direction && target.rotation), "a direction or a rotation, not both");
  if (target.direction) {
    require(target.direction->allFinite() && !target.direction->isZero(0.0), "a finite direction, not zero");
  }
  if (target.rotation) {
    const Eigen::Matrix3d& R = *target.rotation;
    require(R.allFinite() && (R.transpose() * R).isIdentity(orthonormal) && R.determinant() > 0.0,
            "a rotation matrix");
  }
}

void check_question(const CurveTarget& target, const InverseConfig& config) {
  check_config(config);
  double length = 0.0;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    require(target.points[i].allFinite(), "finite points of the curve");
    if (i > 0) length += (target.points[i] - target.points[i - 1]).norm();
  }
  require(length > 0.0 && std::isfinite(length), "a curve with a length");
}

}  // namespace flexura
