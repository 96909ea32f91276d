#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "flexura/base/degree.h"
#include "flexura/base/reader.h"
#include "flexura/kinematics/shape.h"
#include "flexura/rig/setup.h"
#include "flexura/tasks/dynamics/dynamics_plant.h"
#include "flexura/tasks/dynamics/dynamics_task_config.h"

namespace flexura {
namespace {

// Most sections with independent angles, and most with a common polynomial: the work grows with the third
// power, and with the second.
constexpr std::size_t most_sections = 40, most_of_polynomial = 200;

bool gives_bends(const DynamicsTargetConfig& target) {
  return target.cord_angles || target.archings || target.bends;
}

void check_ways(const DynamicsTask& task, const std::string& path, Reader& reader) {
  const DynamicsTargetConfig& target = task.target;
  const bool has_angles = target.azimuths || target.elevations;
  if (gives_bends(target) && has_angles)
    reader.problem_at(path,
                      "gives the shape in more than one way: expected bends, or azimuths and elevations");
  if (!gives_bends(target) && !has_angles && !target.stretches)
    reader.problem_at(path, "is empty: expected a shape, as bends, or azimuths and elevations");
  if (target.azimuths.has_value() != target.elevations.has_value() ||
      (target.azimuths && target.azimuths->size() != target.elevations->size()))
    reader.problem_at(path, "has different numbers of azimuths and elevations: expected equal numbers");
  if (target.stretches && !task.variable_lengths)
    reader.problem_at(path + ".stretches",
                      "requires variable_lengths = true: otherwise lengths do not change");
}

void check_size(const DynamicsTask& task, std::size_t sections, const std::string& path, Reader& reader) {
  const bool is_polynomial = task.basis == AngleBasis::polynomial;
  const std::size_t most = is_polynomial ? most_of_polynomial : most_sections;
  if (sections <= most) return;
  reader.problem_at(
      path + ".basis",
      fmt::format("\"{}\" with {} sections: expected at most {}{}", is_polynomial ? "polynomial" : "sections",
                  sections, most, sections <= most_of_polynomial ? ", or \"polynomial\"" : ""));
}

void check_angles(const DynamicsTask& task, const Arm& arm, const std::string& path, Reader& reader) {
  const std::vector<double>&azimuths = *task.target.azimuths, &elevations = *task.target.elevations;
  for (std::size_t i = 0; i < elevations.size(); ++i) {
    if (std::abs(elevations[i]) > most_elevation)
      reader.problem_at(fmt::format("{}.elevations[{}]", path, i),
                        fmt::format("{:.6g} deg: expected less than 90 deg, where the azimuth is undefined",
                                    elevations[i] / degree));
    if (arm.kind == ArmKind::planar && elevations[i] != 0)
      reader.problem_at(fmt::format("{}.elevations[{}]", path, i),
                        "leaves the plane: expected 0 for a planar arm");
  }
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    constexpr double most = std::numbers::pi + 1e-9;
    if (std::abs(azimuths[i] - azimuths[i - 1]) > most)
      reader.problem_at(fmt::format("{}.azimuths[{}]", path, i),
                        fmt::format("{:.6g} deg follows {:.6g} deg: expected successive azimuths that differ "
                                    "by at most 180 deg; azimuths may exceed 180 deg",
                                    azimuths[i] / degree, azimuths[i - 1] / degree));
  }
  const Eigen::Vector2d base = AnglesAlongArm(arm, ArmState::straight(arm.sections.size())).at(0, 0);
  constexpr double rounding = 1e-6;
  // A whole turn of all azimuths has no effect.
  const double azimuth_off = std::remainder(azimuths[0] - base[0], 2 * std::numbers::pi);
  for (const auto& [name, first, own, off] :
       {std::tuple("azimuths", azimuths[0], base[0], azimuth_off),
        std::tuple("elevations", elevations[0], base[1], elevations[0] - base[1])})
    if (std::abs(off) > rounding)
      reader.problem_at(fmt::format("{}.{}[0]", path, name),
                        fmt::format("{:.6g} deg: expected the value at the arm's clamped base, {:.6g} deg",
                                    first / degree, own / degree));
}

}  // namespace

void check_keys(const DynamicsTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  const ArmConfig& config = setup.arm;
  const std::string target = path + ".target";
  const std::size_t before = reader.problems().size();
  check_shape(task.target, config.kind, config.section.size(), target, reader);
  check_ways(task, target, reader);
  if (task.law.sign == 0) reader.problem_at(path + ".law.sign", "0: expected 1 or -1");
  check_size(task, config.section.size(), path, reader);
  if (config.kind == ArmKind::planar && task.gravity[2] != 0)
    reader.problem_at(path + ".gravity", "leaves the plane of a planar arm: expected 0 along Z");
  if (reader.problems().size() > before) return;
  const Arm arm = config.arm();
  check_bends(arm, task.target, target, reader);
  if (reader.problems().size() > before) return;
  const AnglesAlongArm straight(arm, ArmState::straight(arm.sections.size()));
  if (straight.largest_elevation() > most_elevation) {
    reader.problem_at(path,
                      "the arm's base points along Z: expected an elevation below 90 deg, where the "
                      "azimuth is undefined");
  } else if (task.target.azimuths) {
    check_angles(task, arm, target, reader);
  } else if (const double q = AnglesAlongArm(arm, arm_state(arm, task.target)).largest_elevation();
             q > most_elevation) {
    reader.problem_at(
        target, fmt::format("passes through an elevation of {:.4g} deg: expected less than 90 deg, where "
                            "the azimuth is undefined",
                            q / degree));
  }
  if (reader.problems().size() > before) return;
  // Checks the whole curve, not only its given values.
  const DynamicsPlant plant(task, arm, ArmState::straight(arm.sections.size()));
  if (const double q = plant.largest_target_elevation(); q > most_elevation)
    reader.problem_at(
        target,
        fmt::format("passes, as a polynomial (nodes = {}), through an elevation of {:.4g} deg: expected "
                    "less than 90 deg, where the azimuth is undefined",
                    task.nodes, q / degree));
}

}  // namespace flexura
