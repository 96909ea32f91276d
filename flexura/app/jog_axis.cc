#include "flexura/app/jog_axis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "flexura/app/words.h"
#include "flexura/base/degree.h"
#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/experiment/schedule.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/port/driven_arm.h"
#include "flexura/safety/violation.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

constexpr double millimetre = 1e-3;  // m
// Slow enough to watch and to stop by hand.
constexpr double jog_bend_rate = 10 * degree;  // rad/s
constexpr double jog_tendon_speed = 5e-3;      // m/s
constexpr double shortest_jog = 0.5;           // s
constexpr double longest_jog = 300;            // s

// Splits "section.1.x" at its dots.
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// Returns the index of a number from 1 to `count`, or std::nullopt.
std::optional<std::size_t> index_in(const std::string& text, std::size_t count) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1 || number > count)
    return std::nullopt;
  return number - 1;
}

std::size_t motors_of(const Experiment& experiment) {
  return experiment.drive ? experiment.drive->tendon.size() : 0;
}

bool has_head(const CameraEquipment& camera) { return camera.visca || camera.onvif || camera.v4l2_head; }

std::optional<JogAxis> camera_axis(const Experiment& experiment, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  const std::string camera = name.substr(0, dot), axis = name.substr(dot + 1);
  const auto& devices = experiment.equipment->camera;
  const auto device = std::ranges::find(devices, camera, &CameraEquipment::name);
  if (device == devices.end() || !has_head(*device)) return std::nullopt;
  using Kind = JogAxis::Kind;
  static constexpr std::array<std::pair<std::string_view, Kind>, 3> kinds{
      {{"pan", Kind::pan}, {"tilt", Kind::tilt}, {"zoom", Kind::zoom}}};
  const auto* const kind = std::ranges::find(kinds, axis, &std::pair<std::string_view, Kind>::first);
  if (kind == kinds.end()) return std::nullopt;
  const std::vector<CameraConfig> cameras = experiment.cameras();
  const auto found = std::ranges::find(cameras, camera, &CameraConfig::name);
  return JogAxis{.kind = kind->second,
                 .index = static_cast<std::size_t>(found - cameras.begin()),
                 .component = 0,
                 .name = name};
}

std::optional<JogAxis> arm_axis(const Experiment& experiment, const std::string& name) {
  const std::vector<std::string> parts = parts_of(name);
  const bool is_section = parts.front() == "section";
  if (parts.size() != (is_section ? 3 : 2)) return std::nullopt;
  const auto index = index_in(parts[1], is_section ? experiment.arm.section.size() : motors_of(experiment));
  if (!index) return std::nullopt;
  if (!is_section) {
    if (parts.front() != "motor" && parts.front() != "tendon") return std::nullopt;
    const auto kind = parts.front() == "motor" ? JogAxis::Kind::motor : JogAxis::Kind::tendon;
    return JogAxis{.kind = kind, .index = *index, .component = 0, .name = name};
  }
  const bool is_planar = experiment.arm.kind == ArmKind::planar;
  if (parts[2] != "x" && (parts[2] != "y" || is_planar)) return std::nullopt;
  return JogAxis{
      .kind = JogAxis::Kind::section, .index = *index, .component = parts[2] == "y" ? 1 : 0, .name = name};
}

double sense_of_motor(const Axis& axis) { return axis.reversed ? -1 : 1; }

// Returns the limits of each motor's controller in the file, microsteps.
std::vector<std::array<double, 2>> controller_limits(const RigEquipment& equipment) {
  constexpr double most = 2097152;  // Grbl counts exactly up to here.
  std::vector<std::array<double, 2>> limits;
  if (equipment.cia402)
    for (const Cia402AxisConfig& axis : equipment.cia402->axes) limits.push_back(axis.limits);
  for (const GrblConfig& config : equipment.grbl) {
    const double travel = config.travel ? static_cast<double>(*config.travel) : most;
    limits.insert(limits.end(), config.axes.size(), std::array{-travel, travel});
  }
  return limits;
}

// Checks a move from the initial shape.
SafetyReport check_jog(const Experiment& experiment, const ArmJog& jog) {
  Experiment moved = experiment;
  MoveTask move;
  move.name = "jog";
  move.duration = jog.duration;
  // Controllers accelerate and brake; a linear law would jump.
  move.law = {MoveLaw::minimum_jerk};
  move.to.bends.emplace();
  for (const auto& bend : jog.to.bends) move.to.bends->push_back({bend.x(), bend.y()});
  if (std::ranges::any_of(experiment.arm.section, &Section::can_stretch))
    move.to.stretches = jog.to.stretches;
  moved.task = {move};
  NoProgress nobody;
  return check_experiment_safety(moved, nobody);
}

bool is_of_speed(const Violation& violation) {
  switch (violation.hazard) {
    case Hazard::bend_rate:
    case Hazard::stretch_rate:
    case Hazard::motor_speed:
    case Hazard::step_rate:
    case Hazard::motor_acceleration:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string_view JogAxis::unit() const {
  switch (kind) {
    case Kind::motor:
      return "microsteps";
    case Kind::tendon:
      return "mm";
    case Kind::zoom:
      return "";
    default:
      return "deg";
  }
}

double JogAxis::scale() const {
  switch (kind) {
    case Kind::motor:
    case Kind::zoom:
      return 1;
    case Kind::tendon:
      return millimetre;
    default:
      return degree;
  }
}

std::vector<std::string> jog_axis_names(const Experiment& experiment) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= motors_of(experiment); ++i) names.push_back(fmt::format("motor.{}", i));
  for (std::size_t i = 1; i <= motors_of(experiment); ++i) names.push_back(fmt::format("tendon.{}", i));
  for (std::size_t i = 1; motors_of(experiment) > 0 && i <= experiment.arm.section.size(); ++i) {
    names.push_back(fmt::format("section.{}.x", i));
    if (experiment.arm.kind == ArmKind::spatial) names.push_back(fmt::format("section.{}.y", i));
  }
  for (const CameraEquipment& camera : experiment.equipment->camera)
    if (has_head(camera))
      for (const char* axis : {"pan", "tilt", "zoom"}) names.push_back(camera.name + "." + axis);
  return names;
}

JogAxis jog_axis(const Experiment& experiment, const std::string& name) {
  if (auto axis = camera_axis(experiment, name)) return *axis;
  if (motors_of(experiment) > 0)
    if (auto axis = arm_axis(experiment, name)) return *axis;
  throw input_error(
      "AXIS", fmt::format("\"{}\": expected one of {}", name, fmt::join(jog_axis_names(experiment), ", ")));
}

double jog_distance(const JogAxis& axis, const std::string& text) {
  const auto refuse = [&](std::string_view why) {
    throw input_error("DISTANCE", fmt::format("\"{}\" for {}: {}", text, axis.name, why));
  };
  const std::string expected = axis.kind == JogAxis::Kind::zoom
                                   ? "expected a number of zoom positions, such as 0.5"
                                   : fmt::format("expected a number of {0}, such as 5 or 5{0}", axis.unit());
  double number = 0;
  const char *begin = text.data(), *const end = begin + text.size();
  if (text.starts_with('+')) ++begin;
  const auto [rest, error] = std::from_chars(begin, end, number);
  if (error != std::errc()) refuse(expected);
  std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  if (!unit.empty() && unit != axis.unit()) refuse(expected);
  if (!std::isfinite(number)) refuse("expected a finite number");
  if (number == 0) refuse("expected a distance other than 0");
  return number * axis.scale();
}

ArmJog plan_arm_jog(const Experiment& experiment, const JogAxis& axis, double distance,
                    std::vector<std::string>& refusals) {
  const ArmSetup setup(experiment.model_rig());
  const Drive& drive = setup.drive.value();
  ArmJog jog{.pulled = {}, .from = setup.initial, .to = setup.initial};
  const std::vector<double> start = tendon_displacements(setup.arm, drive, setup.initial).pulled;
  if (axis.kind == JogAxis::Kind::section) {
    jog.to.bends.at(axis.index)[axis.component] += distance;
    jog.pulled = tendon_displacements(setup.arm, drive, jog.to).pulled;
  } else {
    const Axis& motor = drive.axes.at(axis.index);
    jog.pulled = start;
    jog.pulled.at(axis.index) += axis.kind == JogAxis::Kind::tendon
                                     ? distance
                                     : sense_of_motor(motor) * distance / motor.microsteps_a_metre();
    const TendonFit fit = fit_state(setup.arm, drive, {jog.pulled});
    jog.to = fit.state;
    for (std::size_t i = 0; i < jog.pulled.size(); ++i)
      if (fit.residual.pulled[i] > most_jog_strain)
        refusals.push_back(
            fmt::format("tendon {} would pull {:.3g} mm against the others, limit {:.3g} mm: let the others "
                        "out first, or go in smaller steps",
                        i + 1, fit.residual.pulled[i] / millimetre, most_jog_strain / millimetre));
  }
  const auto limits = controller_limits(*experiment.equipment);
  double longest = 0, bent = 0;
  for (std::size_t i = 0; i < jog.pulled.size(); ++i) {
    longest = std::max(longest, std::abs(jog.pulled[i] - start[i]));
    const Axis& motor = drive.axes[i];
    const double target = sense_of_motor(motor) * jog.pulled[i] * motor.microsteps_a_metre();
    // Only a motor that moves can break a limit.
    const bool moves = jog.pulled[i] != start[i];
    if (moves && (target < limits.at(i)[0] || target > limits.at(i)[1]))
      refusals.push_back(
          fmt::format("motor {} would go to {:.0f} microsteps, its controller's limits in the file "
                      "are {:.6g} to {:.6g}",
                      i + 1, target, limits.at(i)[0], limits.at(i)[1]));
  }
  for (std::size_t i = 0; i < jog.to.bends.size(); ++i)
    bent = std::max(bent, (jog.to.bends[i] - jog.from.bends[i]).norm());
  jog.duration = std::max({shortest_jog, longest / jog_tendon_speed, bent / jog_bend_rate});
  SafetyReport report = check_jog(experiment, jog);
  // Limits of speeds are a matter of the duration.
  while (!report.is_safe() && std::ranges::all_of(report.violations, is_of_speed) &&
         jog.duration < longest_jog) {
    jog.duration *= 2;
    report = check_jog(experiment, jog);
  }
  for (const Violation& violation : report.violations) {
    const std::string what = violation.what();
    if (std::ranges::find(refusals, what) == refusals.end()) refusals.push_back(what);
  }
  return jog;
}

}  // namespace flexura
