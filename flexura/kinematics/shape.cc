#include "flexura/kinematics/shape.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/base/reader.h"
#include "flexura/kinematics/planar.h"

namespace flexura {

double base_tangent_angle(const Arm& arm) {
  const Eigen::Vector3d tangent_W = arm.X_WB.rotation.col(2);
  const double angle = std::atan2(tangent_W.y(), tangent_W.x());
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((arm.near_tangent - angle) / turn);
}

ArmState arm_state(const Arm& arm, const ShapeConfig& shape) {
  const std::size_t count = arm.sections.size();
  ArmState state = ArmState::straight(count);
  const auto require_count = [count](std::size_t given) {
    if (given != count) throw std::invalid_argument("arm_state: expected one value per section");
  };
  if (shape.bends) {
    require_count(shape.bends->size());
    for (std::size_t i = 0; i < count; ++i) state.bends[i] = {(*shape.bends)[i][0], (*shape.bends)[i][1]};
  } else if (shape.archings || shape.cord_angles) {
    const std::vector<double> archings =
        shape.archings ? *shape.archings
                       : archings_from_cord_angles(*shape.cord_angles, base_tangent_angle(arm));
    require_count(archings.size());
    for (std::size_t i = 0; i < count; ++i) state.bends[i] = bend_from_arching(archings[i]);
  }
  if (shape.stretches) {
    require_count(shape.stretches->size());
    state.stretches = *shape.stretches;
  }
  return state;
}

void check_bends(const Arm& arm, const ShapeConfig& shape, const std::string& path, Reader& reader) {
  const ArmState state = arm_state(arm, shape);
  const char* way = shape.archings ? "archings" : "bends";
  if (shape.cord_angles) way = "cord_angles";
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const double bend = state.bends[i].norm();
    if (bend <= largest_bend) continue;
    reader.problem_at(fmt::format("{}{}{}", path, path.empty() ? "" : ".", way),
                      fmt::format("bends section {} by {:.6g} rad: expected at most {:.6g} rad", i + 1, bend,
                                  largest_bend));
  }
}

std::vector<double> archings(const ArmState& state) {
  std::vector<double> result;
  result.reserve(state.bends.size());
  for (const Eigen::Vector2d& bend : state.bends) result.push_back(arching_from_bend(bend));
  return result;
}

std::vector<double> cord_angles(const Arm& arm, const ArmState& state) {
  return cord_angles_from_archings(archings(state), base_tangent_angle(arm));
}

}  // namespace flexura
