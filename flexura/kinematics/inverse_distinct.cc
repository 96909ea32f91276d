#include "flexura/kinematics/inverse_distinct.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/kinematics/arc_motion.h"
#include "flexura/math/pose.h"

namespace flexura {

std::vector<Eigen::Vector3d> backbone_points(const ArmVariables& variables, const Eigen::VectorXd& x) {
  constexpr int points = 5;
  std::vector<Eigen::Vector3d> result;
  result.reserve(points * variables.parts().size());
  Pose X_BS;
  for (const ArmVariables::Part& part : variables.parts()) {
    const double length = part.length * part.stretch(x);
    Pose end;
    for (int k = 1; k <= points; ++k) {
      const double done = static_cast<double>(k) / points;
      const ArcMotion motion = arc_motion(done * part.bend(x), done * length);
      end = X_BS * Pose{motion.rotation, motion.position};
      result.push_back(end.position);
    }
    X_BS = end;
  }
  return result;
}

double backbone_distance(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

// Sections do not twist, so all bends rotate by the same angle.
void turn_to_x(const ArmVariables& variables, Eigen::VectorXd& x) {
  constexpr double bent = 1e-6;  // In rad.
  const auto& parts = variables.parts();
  const auto first = std::ranges::find_if(
      parts, [&](const ArmVariables::Part& part) { return part.is_spatial && part.bend(x).norm() > bent; });
  if (first == parts.end()) return;
  const Eigen::Vector2d towards = first->bend(x).normalized();
  for (const ArmVariables::Part& part : parts) {
    if (!part.is_spatial) continue;
    const Eigen::Vector2d bend = part.bend(x);
    x[part.at] = towards.dot(bend);
    x[part.at + 1] = towards.x() * bend.y() - towards.y() * bend.x();
  }
}

bool comes_first(double objective_a, const Eigen::VectorXd& a, double objective_b, const Eigen::VectorXd& b) {
  constexpr double same_objective = 1e-7;
  constexpr double same_value = 1e-5;
  if (std::abs(objective_a - objective_b) > same_objective * (1.0 + objective_a))
    return objective_a < objective_b;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > same_value) return a[i] > b[i];
  }
  return false;
}

}  // namespace flexura
