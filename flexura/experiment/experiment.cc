#include "flexura/experiment/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "flexura/base/table.h"
#include "flexura/experiment/calibrate_config.h"
#include "flexura/kinematics/shape.h"
#include "flexura/study/study_config.h"

namespace flexura {
namespace {

constexpr std::size_t max_tasks = 10000;
constexpr std::size_t max_obstacles = 1000;
constexpr std::size_t max_cameras = 100;

// The default cameras look at the arm's base; far from the origin a small distance from it is rounded away.
void check_default_cameras(const Experiment& experiment, Reader& reader) {
  for (const CameraConfig& camera : experiment.cameras()) {
    if (camera.mount.look_at != camera.mount.position) continue;
    reader.problem_at("stand.camera_distances",
                      fmt::format("puts camera \"{}\" where the arm's base is: expected distances that the "
                                  "base's coordinates can tell",
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

void check_task_at(const Experiment& experiment, std::size_t index, Reader& reader) {
  const TaskConfig& task = experiment.task[index];
  const std::string path = fmt::format("task[{}]", index);
  const std::size_t problems_before = reader.problems().size();
  check_task(task, experiment.arm.kind, experiment.arm.section.size(), path, reader);
  if (const auto* study = std::get_if<StudyTask>(&task))
    check_study(*study, experiment.cameras(), path, reader);
  if (const auto* calibration = std::get_if<CalibrateTask>(&task))
    check_calibration(*calibration, experiment.arm, experiment.cameras(), experiment.stand, path, reader);
  const auto* servo = std::get_if<ServoTask>(&task);
  if (servo != nullptr) check_servo(*servo, experiment.arm, experiment.cameras(), path, reader);
  if (const auto* dynamics = std::get_if<DynamicsTask>(&task))
    check_dynamics(*dynamics, experiment.arm, path, reader);
  if (reader.problems().size() > problems_before) return;  // Shapes fit the arm from here on.
  const Arm arm = experiment.arm.arm();
  if (const auto* move = std::get_if<MoveTask>(&task)) check_bends(arm, move->to, path + ".to", reader);
  if (const auto* calibration = std::get_if<CalibrateTask>(&task)) {
    for (std::size_t i = 0; i < calibration->pose.size(); ++i)
      check_bends(arm, calibration->pose[i], fmt::format("{}.pose[{}]", path, i), reader);
  }
  for (std::size_t i = 0; servo != nullptr && i < servo->target.size(); ++i)
    check_bends(arm, servo->target[i], fmt::format("{}.target[{}]", path, i), reader);
}

void check_experiment(const Experiment& experiment, Reader& reader) {
  check_bends(experiment.arm.arm(), experiment.arm.initial, "arm.initial", reader);
  check_obstacle_names(experiment.obstacle, reader);
  if (experiment.camera.empty()) check_default_cameras(experiment, reader);
  if (experiment.drive) check_drive(*experiment.drive, experiment.arm, "drive", reader);
  check_cameras(experiment.camera, "camera", reader);
  if (experiment.stand.camera_distances && !experiment.camera.empty())
    reader.problem_at("stand.camera_distances",
                      "is for the default cameras: expected no [[camera]] beside it");
  if (experiment.truth && experiment.truth->stand &&
      experiment.truth->stand->camera_distances != experiment.stand.camera_distances) {
    reader.problem_at("truth.stand.camera_distances",
                      "moves no camera: expected a mount.position in [[truth.camera]]");
  }
  if (experiment.truth) {
    const std::string problem = truth_problem(experiment.model_rig(), experiment.true_rig());
    if (!problem.empty()) reader.problem_at("truth", problem);
  }
  for (std::size_t i = 0; i < experiment.task.size(); ++i) check_task_at(experiment, i, reader);
}

}  // namespace

const Table<ClockConfig>& fields_of(const ClockConfig*) {
  static const auto table = Table<ClockConfig>("clock", "How time runs in the experiment.")
                                .field("step", &ClockConfig::step,
                                       {.meaning = "Time between two states of the experiment.",
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
      Table<RecordConfig>("record", "What is kept of a run.")
          .field("every", &RecordConfig::every,
                 {.meaning = "Steps from one state in the log to the next; the last one is always kept.",
                  .range = between(1, 1e9)})
          .field("report", &RecordConfig::report, {.meaning = "Write report.html and figures/."})
          .field("cameras", &RecordConfig::cameras, {.meaning = "Keep the cameras' images in the log."})
          .field(
              "scene", &RecordConfig::scene,
              {.meaning = "Keep in the log, for programs that draw it, what stands around the arm, and ten "
                          "times a second how the arm lies."})
          .field(
              "curve", &RecordConfig::curve,
              {.meaning =
                   "The line drawn along the arm in the report: its exact arcs (the arm itself), the paper's "
                   "Catmull-Rom spline through the sections' base points (eq. 11), or one Bezier a section "
                   "with exact tangents."})
          .field("tension", &RecordConfig::tension,
                 {.meaning = "Tension of the Catmull-Rom spline.", .range = between(0, 1)});
  return table;
}

const Table<TruthConfig>& fields_of(const TruthConfig*) {
  static const auto table =
      Table<TruthConfig>(
          "truth",
          "The simulated world, where it differs from what the rest of the file says and the tasks "
          "believe: parts of the same tables, laid upon them. Cameras are told apart by their names, "
          "sections and tendons by their places.")
          .field("arm", &TruthConfig::arm,
                 {.meaning = "The arm as it is.", .partial = true, .default_text = "as believed"})
          .field("drive", &TruthConfig::drive,
                 {.meaning = "What moves it.", .partial = true, .default_text = "as believed"})
          .field("camera", &TruthConfig::camera,
                 {.meaning = "The cameras as they are.",
                  .count = {0, max_cameras},
                  .partial = true,
                  .default_text = "as believed"})
          .field("stand", &TruthConfig::stand,
                 {.meaning = "What stands around the arm.", .partial = true, .default_text = "as believed"});
  return table;
}

const Table<Experiment>& fields_of(const Experiment*) {
  static const auto table =
      Table<Experiment>(
          "Flexura experiment file",
          "A rig and the tasks it does, one after another. An arm alone is a file with [arm] only.")
          .field("flexura", &Experiment::flexura,
                 {.meaning = "Version that ran the file; written into results.", .default_text = "not set"})
          .field("title", &Experiment::title,
                 {.meaning = "A title for the report.", .default_text = "the file's name"})
          .field("seed", &Experiment::seed,
                 {.meaning = "Seed of every random number of the run.", .range = between(0, 1e15)})
          .field("include", &Experiment::include,
                 {.meaning = "Files in this file's folder or below upon whose values this file's are laid.",
                  .count = {0, 100},
                  .default_text = "none"})
          .field("clock", &Experiment::clock, {.meaning = "How time runs."})
          .field("record", &Experiment::record, {.meaning = "What is kept of a run."})
          .field("arm", &Experiment::arm, {.meaning = "The arm.", .required = true})
          .field(
              "drive", &Experiment::drive,
              {.meaning = "What moves the arm; with it a run writes command lists.", .default_text = "none"})
          .field("obstacle", &Experiment::obstacle,
                 {.meaning = "What the arm must not touch.",
                  .count = {0, max_obstacles},
                  .default_text = "none"})
          .field("stand", &Experiment::stand,
                 {.meaning = "What stands around the arm for the cameras to see."})
          .field("camera", &Experiment::camera,
                 {.meaning = "The cameras.",
                  .count = {0, max_cameras},
                  .default_text =
                      "two, \"front\" on +Z and \"side\" on -X, with all of the arm's reach in view"})
          .field("truth", &Experiment::truth,
                 {.meaning = "Where the simulated world differs from what the tasks believe.",
                  .default_text = "nowhere"})
          .field("task", &Experiment::task,
                 {.meaning = "What is done, in this order.", .count = {0, max_tasks}, .default_text = "none"})
          .check(check_experiment);
  return table;
}

RigConfig Experiment::model_rig() const { return {arm, drive, cameras()}; }

RigConfig Experiment::true_rig() const {
  RigConfig rig = model_rig();
  if (!truth) return rig;
  if (truth->arm) rig.arm = *truth->arm;
  if (truth->drive) rig.drive = truth->drive;
  if (!truth->camera.empty()) rig.cameras = truth->camera;
  return rig;
}

StandConfig Experiment::true_stand() const {
  StandConfig shown = truth && truth->stand ? *truth->stand : stand;
  if (!shown.screen) shown.screen = default_screens(arm.arm().length(), arm.base.position);
  return shown;
}

std::vector<CameraConfig> Experiment::cameras() const {
  if (!camera.empty()) return camera;
  if (stand.camera_distances) return cameras_at(*stand.camera_distances, arm.base.position);
  double reach = 0;
  for (const Section& section : arm.section)
    reach += section.length * std::max(1.0, section.stretch_limits[1]);
  return default_cameras(reach, arm.base.position);
}

}  // namespace flexura
