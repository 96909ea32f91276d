#include "flexura/view/moves.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "flexura/base/problems.h"
#include "flexura/base/reader.h"
#include "flexura/kinematics/motion.h"
#include "flexura/kinematics/shape.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/math/arrays.h"
#include "flexura/model/arm_config.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/safety/motion_check.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

// Tolerance for a violation deeper than at the start, m or rad: too small to be visible.
constexpr double no_worse = 1e-5;

// Returns whether the violation existed at the start, and is nowhere much worse.
bool was_there(const Violation& violation, const std::vector<Violation>& at_start) {
  return std::ranges::any_of(at_start, [&](const Violation& before) {
    return before.hazard == violation.hazard && before.section == violation.section &&
           before.other_section == violation.other_section && before.name == violation.name &&
           std::abs(violation.value - violation.limit) <= std::abs(before.value - before.limit) + no_worse;
  });
}

SafetyReport check_path(const ArmModel& arm, const std::vector<Obstacle>& obstacles, const ArmState& from,
                        const MotionPtr& motion) {
  constexpr double step = 0.02;
  return check_motions(arm, obstacles, from, {{motion, 0, ""}}, step);
}

// An arm equal to a backbone, with a section for each of its arcs. Its sections have no twist: twist before
// an arc rotates the arc's bend direction instead.
struct ArcArm {
  explicit ArcArm(const Backbone& backbone) {
    arm.kind = ArmKind::spatial;
    arm.X_WB = backbone.arcs().front().X_WS;
    double twist = 0;
    for (const Arc& arc : backbone.arcs()) {
      Section& section = arm.sections.emplace_back();
      section.length = arc.rest_length, section.radius = arc.radius;
      state.bends.emplace_back(twist == 0 ? arc.bend : Eigen::Rotation2Dd(twist) * arc.bend);
      state.stretches.push_back(arc.length / arc.rest_length);
      twist += arc.twist;
    }
  }

  Arm arm;
  ArmState state;
};

std::string contact_text(const ContactWatch& watch, const Contact& contact) {
  Violation violation;
  violation.hazard = watch.hazard();
  violation.section = contact.section;
  violation.other_section = contact.other_section;
  violation.name = watch.obstacle_name();
  violation.value = -contact.clearance;
  return violation.what();
}

}  // namespace

void require_travel(const Camera& camera, const StageRequest& request) {
  constexpr std::array<const char*, 3> names = {"x", "y", "z"};
  const std::array<const std::optional<double>*, 3> desired = {&request.x, &request.y, &request.z};
  const auto travels = [](const AxisConfig& axis) { return axis.limits[1] > axis.limits[0]; };
  const std::string name = Node{camera.config().name, {}}.brief();
  if (std::ranges::none_of(camera.stage_axes(), travels))
    throw ViewRefusal(fmt::format("the camera {} has no stage", name));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (*desired[i] && !travels(camera.stage_axes()[i]))
      throw ViewRefusal(fmt::format("the stage of camera {} does not move along {}", name, names[i]));
}

ArmState within_limits(const Arm& arm, ArmState state) {
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    const double bend = state.bends[i].norm();
    if (bend > section.max_bend) state.bends[i] *= section.max_bend / bend;
    state.stretches[i] = std::clamp(state.stretches[i], section.stretch_limits[0], section.stretch_limits[1]);
  }
  return state;
}

ArmState requested_shape(const Arm& arm, const ShapeConfig& shape) {
  Reader reader;
  check_shape(shape, arm.kind, arm.sections.size(), "", reader);
  if (reader.problems().empty()) check_bends(arm, shape, "", reader);
  if (!reader.problems().empty()) throw ViewRefusal(joined(reader.problems()));
  return arm_state(arm, shape);
}

ArmState requested_shape(const Arm& arm, const std::optional<Drive>& drive, const ArmRequest& request) {
  if (!request.tendons)
    return within_limits(arm, requested_shape(arm, static_cast<const ShapeConfig&>(request)));
  if (!drive) throw ViewRefusal("tendons: the arm has no drive");
  if (request.tendons->size() != drive->tendons.size())
    throw ViewRefusal(fmt::format("tendons: expected {} displacements", drive->tendons.size()));
  return within_limits(arm, fit_state(arm, *drive, {*request.tendons}).state);
}

TendonPull requested_pull(const std::vector<PulledTendon>& actuators,
                          const std::vector<double>& displacements) {
  if (displacements.size() != actuators.size())
    throw ViewRefusal(fmt::format("tendons: expected {} displacements", actuators.size()));
  // Tolerance for the rounded numbers of a page.
  constexpr double rounding = 1e-7;  // m
  TendonPull pull{displacements};
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const auto [least, most] = actuators[i].range;
    const bool is_inside = displacements[i] >= least - rounding && displacements[i] <= most + rounding;
    if (!is_inside)
      throw ViewRefusal(
          fmt::format("tendons[{}] = {}: expected {:.4g} to {:.4g} m", i, displacements[i], least, most));
    pull.displacements[i] = std::clamp(displacements[i], least, most);
  }
  return pull;
}

InverseResult shape_for_tip(const ArmModel& arm, const ArmState& from, const TipRequest& request) {
  TipTarget target;
  target.position = vector(request.position);
  if (request.direction) target.direction = vector(*request.direction);
  InverseConfig config;
  config.start = within_limits(arm.driven(), from);
  // Searches from the current state first, since a dragging hand must not cause jumps. Searches from other
  // states only if that fails.
  config.max_starts = 1;
  InverseResult near = solve_inverse(arm, target, config);
  if (near.converged() || near.is_proven) return near;
  config.max_starts = 40;
  InverseResult far = solve_inverse(arm, target, config);
  return far.converged() ? far : near;
}

std::string danger_on_path(const ArmModel& arm, const std::vector<Obstacle>& obstacles, const ArmState& from,
                           const ArmState& to) {
  const std::vector<Profile> profiles(arm.driven().sections.size(), Profile::linear(1));
  const SafetyReport way = check_path(arm, obstacles, from, point_to_point_motion(from, to, profiles));
  if (way.is_safe()) return {};
  const SafetyReport start = check_path(arm, obstacles, from, hold_motion(from, 0));
  for (const Violation& violation : way.violations) {
    // The rig itself limits its speed.
    constexpr std::array speeds = {Hazard::bend_rate, Hazard::stretch_rate, Hazard::jump};
    if (std::ranges::find(speeds, violation.hazard) != speeds.end()) continue;
    // Whether a rod has an equilibrium is decided by the simulated arm, which takes its own path.
    if (violation.hazard == Hazard::not_finite && !arm.actuation().is_linear()) continue;
    if (!was_there(violation, start.violations)) return violation.what();
  }
  return {};
}

std::string beyond_limits(const Arm& arm, const ArmState& state) {
  constexpr double rounding = 1e-6;  // rad, and of a length
  for (std::size_t i = 0; i < arm.sections.size() && i < state.bends.size(); ++i) {
    const Section& section = arm.sections[i];
    const double bend = state.bends[i].norm();
    if (bend > section.max_bend + rounding)
      return fmt::format("section {} is bent by {:.4g} rad: expected at most {:.4g} rad", i + 1, bend,
                         section.max_bend);
    const auto [least, most] = section.stretch_limits;
    if (state.stretches[i] < least - rounding || state.stretches[i] > most + rounding)
      return fmt::format("section {} is stretched by {:.4g}: expected {:.4g} to {:.4g}", i + 1,
                         state.stretches[i], least, most);
  }
  return {};
}

std::string touched(const Backbone& backbone, const std::vector<Obstacle>& obstacles) {
  const ArcArm arm(backbone);
  const auto touching = [&](const ContactWatch& watch) -> std::string {
    Contact contact = watch.contact(arm.state, 0);
    if (contact.clearance >= -contact_tolerance) return {};
    contact.section = backbone.arcs()[contact.section].section;
    if (contact.other_section) contact.other_section = backbone.arcs()[*contact.other_section].section;
    return contact_text(watch, contact);
  };
  std::string text = touching(ContactWatch(arm.arm));
  for (std::size_t i = 0; i < obstacles.size() && text.empty(); ++i)
    text = touching(ContactWatch(arm.arm, obstacles[i]));
  return text;
}

}  // namespace flexura
