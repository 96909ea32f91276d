#include "flexura/rig/setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/kinematics/shape.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/rig/setup_fields.h"

namespace flexura {
namespace {

// The default cameras look at the arm's base. Far from the origin, a small distance from it is lost in
// rounding.
void check_default_cameras(const Setup& setup, Reader& reader) {
  for (const CameraConfig& camera : setup.cameras()) {
    if (camera.mount.look_at != camera.mount.position) continue;
    reader.problem_at("stand.camera_distances",
                      fmt::format("puts camera \"{}\" at the arm's base: expected distances that are not "
                                  "negligible compared with the base's coordinates",
                                  camera.name));
  }
}

void check_obstacle_names(const std::vector<ObstacleConfig>& configs, Reader& reader) {
  const std::vector<Obstacle> all = obstacles(configs);
  std::set<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (names.insert(all[i].name).second) continue;
    reader.problem_at(fmt::format("obstacle[{}].name", i),
                      fmt::format("\"{}\" is the name of another obstacle", all[i].name));
  }
}

}  // namespace

void check_setup(const Setup& setup, Reader& reader) {
  check_bends(setup.arm.arm(), setup.arm.initial, "arm.initial", reader);
  check_obstacle_names(setup.obstacle, reader);
  if (setup.camera.empty()) check_default_cameras(setup, reader);
  if (setup.drive) check_drive(*setup.drive, setup.arm, "drive", reader);
  check_cameras(setup.camera, "camera", reader);
  check_seeing(setup, reader);
  if (setup.stand.camera_distances && !setup.camera.empty())
    reader.problem_at("stand.camera_distances",
                      "applies only to the default cameras: expected no [[camera]]");
  if (setup.truth && setup.truth->stand &&
      setup.truth->stand->camera_distances != setup.stand.camera_distances) {
    reader.problem_at("truth.stand.camera_distances",
                      "moves no camera: expected a mount.position in [[truth.camera]]");
  }
  if (setup.equipment) {
    std::vector<std::string> names;
    for (const CameraConfig& camera : setup.cameras()) names.push_back(camera.name);
    check_equipment(*setup.equipment, names, setup.drive ? setup.drive->tendon.size() : 0, reader);
  }
  // Without [truth], the world is the model.
  const std::string problem = truth_problem(setup.model_rig(), setup.true_rig());
  if (!problem.empty()) reader.problem_at(setup.truth ? "truth" : "arm", problem);
}

const Table<ClockConfig>& fields_of(const ClockConfig*) {
  static const auto table = Table<ClockConfig>("clock", "Time of the experiment.")
                                .field("step", &ClockConfig::step,
                                       {.meaning = "Time step between two states.",
                                        .unit = Unit::second,
                                        .range = between(1e-6, 1e3)});
  return table;
}

const std::vector<std::string>& names_of(const CurveKind*) {
  static const std::vector<std::string> names = {"arcs", "catmull_rom", "bezier"};
  return names;
}

const Table<RecordConfig>& fields_of(const RecordConfig*) {
  static const auto table =
      Table<RecordConfig>("record", "Contents of the log and the report.")
          .field("every", &RecordConfig::every,
                 {.meaning = "Number of steps between two states in the log. The last state is always kept.",
                  .range = between(1, 1e9)})
          .field("report", &RecordConfig::report,
                 {.meaning = "Whether report.html and figures/ are written."})
          .field("cameras", &RecordConfig::cameras, {.meaning = "Whether the log keeps the cameras' images."})
          .field("scene", &RecordConfig::scene,
                 {.meaning = "Whether the log contains the arm's surroundings and ten arm shapes per second, "
                             "for programs that draw logs."})
          .field("curve", &RecordConfig::curve,
                 {.meaning = "Curve drawn along the arm in the report. `arcs`: its exact arcs. "
                             "`catmull_rom`: the paper's spline through the sections' base points (eq. 11). "
                             "`bezier`: one curve per section with exact tangents."})
          .field("tension", &RecordConfig::tension,
                 {.meaning = "Tension of the Catmull-Rom spline.", .range = between(0, 1)});
  return table;
}

const Table<TruthConfig>& fields_of(const TruthConfig*) {
  static const auto table =
      Table<TruthConfig>(
          "truth",
          "True values of the simulated world: parts of the same tables, which override the models that "
          "tasks use. Cameras are matched by name, sections and tendons by position in the list.")
          .field("arm", &TruthConfig::arm,
                 {.meaning = "True arm.", .partial = true, .default_text = "as modelled"})
          .field("drive", &TruthConfig::drive,
                 {.meaning = "True drive.", .partial = true, .default_text = "as modelled"})
          .field("camera", &TruthConfig::camera,
                 {.meaning = "True cameras.",
                  .count = {0, max_cameras},
                  .partial = true,
                  .default_text = "as modelled"})
          .field("stand", &TruthConfig::stand,
                 {.meaning = "True surroundings.", .partial = true, .default_text = "as modelled"});
  return table;
}

ArmModel Setup::arm_model() const {
  try {
    return arm_model_of(arm, drive);
  } catch (const std::invalid_argument& error) {
    throw InputError(std::vector<Problem>{{{}, fmt::format("arm: {}", error.what())}});
  }
}

RigConfig Setup::model_rig() const { return {arm, drive, cameras(), obstacle}; }

RigConfig Setup::true_rig() const {
  RigConfig rig = model_rig();
  if (!truth) return rig;
  if (truth->arm) rig.arm = *truth->arm;
  if (truth->drive) rig.drive = truth->drive;
  if (!truth->camera.empty()) rig.cameras = truth->camera;
  return rig;
}

StandConfig Setup::true_stand() const {
  StandConfig shown = truth && truth->stand ? *truth->stand : stand;
  if (!shown.screen) shown.screen = default_screens(arm.arm().length(), arm.base.position);
  return shown;
}

std::vector<CameraConfig> Setup::cameras() const {
  std::vector<CameraConfig> all = modelled_cameras();
  if (!equipment) return all;
  for (CameraConfig& one : all) {
    const auto found = std::ranges::find(equipment->camera, one.name, &CameraEquipment::name);
    if (found != equipment->camera.end() && found->visca)
      one.head = with_visca_resolution(one.head, *found->visca);
  }
  return all;
}

std::vector<CameraConfig> Setup::modelled_cameras() const {
  if (!camera.empty()) return camera;
  if (stand.camera_distances) return cameras_at(*stand.camera_distances, arm.base.position);
  double reach = 0;
  for (const Section& section : arm.section)
    reach += section.length * std::max(1.0, section.stretch_limits[1]);
  return default_cameras(reach, arm.base.position);
}

}  // namespace flexura
