#include "flexura/tasks/calibrate/calibrate_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"
#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/etalon_figure.h"
#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/tasks/camera_names.h"

namespace flexura {
namespace {

constexpr std::int64_t image_limit = 1000;
constexpr double longest = 1e4;  // s

RigPatience patience_of(const CalibrateTask& task) {
  return {.settle = task.settle_timeout, .frame = task.frame_timeout, .pause = task.pause};
}

// Bends of the arm's lower, middle and upper third, rad. Mild bends come first: there rough priors suffice to
// recognise the markers. The following ones bend every part in every direction.
constexpr std::array<std::array<double, 6>, 6> patterns = {{{0.5, 0, 0.5, 0, 0.5, 0},
                                                            {0, 0.5, 0, 0.5, 0, 0.5},
                                                            {-0.6, 0.3, 0.7, 0.1, 0.5, -0.8},
                                                            {0.4, -0.7, -0.3, -0.4, 0.9, 0.2},
                                                            {1, 0.2, 0.8, -0.3, -1, 0.4},
                                                            {-0.3, 1, 0.2, -1, -0.4, 1}}};

// Returns the bends of a pattern, distributed among the sections of each third by their lengths.
ArmState patterned(const Arm& arm, const std::array<double, 6>& pattern) {
  std::vector<std::size_t> third_of;
  std::array<double, 3> lengths = {0, 0, 0};
  double s = 0;
  for (const Section& section : arm.sections) {
    const double middle = (s + 0.5 * section.length) / arm.length();
    third_of.push_back(std::min<std::size_t>(2, static_cast<std::size_t>(3 * middle)));
    lengths[third_of.back()] += section.length, s += section.length;
  }
  ArmState state = ArmState::straight(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const std::size_t third = third_of[i];
    const double share = arm.sections[i].length / lengths[third];
    Eigen::Vector2d& bend = state.bends[i];
    bend = share * Eigen::Vector2d(pattern[2 * third], pattern[2 * third + 1]);
    if (arm.kind == ArmKind::planar) bend = {bend.x() + 0.5 * bend.y(), 0};
    constexpr double within = 0.9;  // Fraction of the section's bend limit.
    const double most = within * arm.sections[i].max_bend;
    if (bend.norm() > most) bend *= most / bend.norm();
    const auto& [least, longest_stretch] = arm.sections[i].stretch_limits;
    state.stretches[i] = std::clamp(1.0, least, longest_stretch);
  }
  return state;
}

// Returns the markers of the file, from the base on.
std::vector<KnownMarker> known_markers(const ArmConfig& arm) {
  std::vector<KnownMarker> markers;
  for (const Marker& marker : arm.look.markers(arm.arm()))
    markers.push_back({.s = marker.at, .color = vector(marker.color)});
  return markers;
}

}  // namespace

const std::vector<std::string>& names_of(const CalibrateMethod*) {
  static const std::vector<std::string> names = {"bundle",       "bundle-etalon", "etalon",
                                                 "etalon-paper", "arcs",          "arcs-paper"};
  return names;
}

const Table<CalibrateRequiredStd>& fields_of(const CalibrateRequiredStd*) {
  static const auto table =
      Table<CalibrateRequiredStd>("required_std",
                                  "Standard deviations of the calibrated rig. When all are below these "
                                  "values, no more pictures are taken.")
          .field("angle", &CalibrateRequiredStd::angle,
                 {.meaning = "Standard deviation of the angle between the optical axes.",
                  .unit = Unit::radian,
                  .range = above_up_to(0, 1)})
          .field("focal", &CalibrateRequiredStd::focal,
                 {.meaning = "Relative standard deviation of each focal length.", .range = above_up_to(0, 1)})
          .field("zoom_ratio", &CalibrateRequiredStd::zoom_ratio,
                 {.meaning =
                      "Relative standard deviation of the ratio of the arm's image sizes in the two cameras.",
                  .range = above_up_to(0, 1)});
  return table;
}

const Table<CalibrateCameraPrior>& fields_of(const CalibrateCameraPrior*) {
  static const auto table =
      Table<CalibrateCameraPrior>("camera_prior", "Prior standard deviations of the file's camera models.")
          .field("rotation_std", &CalibrateCameraPrior::rotation_std,
                 {.meaning = "Standard deviation of a mount's orientation, about each axis.",
                  .unit = Unit::radian,
                  .range = above_up_to(0, 1)})
          .field("position_std", &CalibrateCameraPrior::position_std,
                 {.meaning = "Standard deviation of a mount's position along each axis, as a fraction of its "
                             "distance from the arm's base, or from the calibration cylinder if used.",
                  .range = above_up_to(0, 1)})
          .field("focal_std", &CalibrateCameraPrior::focal_std,
                 {.meaning = "Relative standard deviation of the focal length.", .range = between(0, 1)})
          .field("principal_point_std", &CalibrateCameraPrior::principal_point_std,
                 {.meaning = "Standard deviation of the principal point along each axis, px.",
                  .range = between(0, 1000)})
          .field("zero_std", &CalibrateCameraPrior::zero_std,
                 {.meaning = "Standard deviation of a head's zero offsets. The zero offset of pan has an "
                             "effect only if the camera's stage moves.",
                  .unit = Unit::radian,
                  .range = between(0, 1)})
          .field("exact_heads", &CalibrateCameraPrior::exact_heads,
                 {.meaning = "Whether heads are exactly at their reported positions. Otherwise a head may be "
                             "half a motor step away from its reported position."})
          .renamed("rotation", "rotation_std")
          .renamed("distance", "position_std")
          .renamed("focal", "focal_std")
          .renamed("principal_point", "principal_point_std")
          .renamed("zero", "zero_std");
  return table;
}

const Table<CalibrateArmPrior>& fields_of(const CalibrateArmPrior*) {
  static const auto table =
      Table<CalibrateArmPrior>("arm_prior", "Prior standard deviations of the file's model of the arm.")
          .field("length_std", &CalibrateArmPrior::length_std,
                 {.meaning = "Relative standard deviation of each section's length. The lengths of the "
                             "sections are the only information about absolute distances.",
                  .range = between(0, 0.1)})
          .field("response_std", &CalibrateArmPrior::response_std,
                 {.meaning = "Standard deviation of the coefficients of the arm's response error, in rad per "
                             "rad. A coefficient is the error of the bend of one section due to a bend of 1 "
                             "rad of the same or another section. A coefficient is the same in all poses.",
                  .range = between(0, 1),
                  .default_text = "0.2 with `arm.model = \"static\"` or `\"dynamic\"`, otherwise 0"})
          .field(
              "pose_response_std", &CalibrateArmPrior::pose_response_std,
              {.meaning =
                   "Standard deviation of additional response coefficients, which differ from pose to pose.",
               .range = between(0, 1),
               .default_text = "a quarter of response_std"});
  return table;
}

const Table<CalibrateLoopConfig>& fields_of(const CalibrateLoopConfig*) {
  static const auto table =
      Table<CalibrateLoopConfig>("loop", "Parameters of the paper's iterative methods.")
          .field("accepted", &CalibrateLoopConfig::accepted,
                 {.meaning = "Largest offset, measured in a picture, at which an iteration ends, px.",
                  .range = above_up_to(0, 1000),
                  .default_text = "0.05 for etalon, 0.5 for arcs, 3 for -paper methods"})
          .field("zoom_accepted", &CalibrateLoopConfig::zoom_accepted,
                 {.meaning = "Largest relative difference between the target's sizes in the two images at "
                             "which an iteration ends.",
                  .range = above_up_to(0, 1),
                  .default_text = "0.001; 0.01 for -paper methods"})
          .field("turn", &CalibrateLoopConfig::turn,
                 {.meaning = "Fixed rotation step of a head, for etalon-paper.",
                  .unit = Unit::radian,
                  .range = above_up_to(0, 1)})
          .field("slide", &CalibrateLoopConfig::slide,
                 {.meaning = "Fixed translation step of a stage, for etalon-paper.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 10)})
          .field("zoom_step", &CalibrateLoopConfig::zoom_step,
                 {.meaning = "Fixed relative step of a zoom, for etalon-paper.", .range = above_up_to(0, 1)})
          .field("arc", &CalibrateLoopConfig::arc,
                 {.meaning = "Bend angle of the whole arm when it forms an arc, for arcs and arcs-paper.",
                  .unit = Unit::radian,
                  .range = between(0.2, 6),
                  .default_text = "90 degrees for arcs, 120 for arcs-paper"});
  return table;
}

const Table<CalibrateTask>& fields_of(const CalibrateTask*) {
  static const auto table =
      Table<CalibrateTask>(
          "calibrate",
          "Calibrates two cameras, then points them at the arm along orthogonal axes with equal zoom. The "
          "arm moves to several poses and returns to its first shape in between. Heads, stages and zooms "
          "also move. The duration depends on the number of pictures that an accurate estimate needs.")
          .field("name", &CalibrateTask::name,
                 {.meaning = "Name of the task in results.", .default_text = "its kind"})
          .field("method", &CalibrateTask::method,
                 {.meaning =
                      "Calibration method. `bundle`: least squares over all parameters, from pictures of the "
                      "arm. `bundle-etalon`: least squares from pictures of the calibration cylinder. "
                      "`etalon`: the paper's iterative method with the cylinder, with corrections. `arcs`: "
                      "the paper's iterative method with arcs of the arm in two planes, with corrections. "
                      "`etalon-paper`, `arcs-paper`: the paper's methods without corrections."})
          .field("cameras", &CalibrateTask::cameras,
                 {.meaning = "Names of two cameras.", .count = {2, 2}, .default_text = "the first two"})
          .field("pose", &CalibrateTask::pose,
                 {.meaning =
                      "Shapes of the arm of which pictures are taken, as `pose = [{ bends = ... }, ...]`.",
                  .count = {1, 100},
                  .default_text = "six poses in which every part of the arm bends to every side"})
          .field("images", &CalibrateTask::images,
                 {.meaning = "Largest number of pictures per camera, not counting a search for the arm. With "
                             "bundle and bundle-etalon, the last picture verifies the result.",
                  .range = between(3, image_limit),
                  .default_text =
                      "12 for bundle and bundle-etalon, 60 for etalon and arcs, 400 for -paper methods"})
          .field("required_std", &CalibrateTask::required_std,
                 {.meaning = "Standard deviations below which the calibration takes no more pictures."})
          .field("camera_prior", &CalibrateTask::camera_prior,
                 {.meaning = "Prior standard deviations of the file's camera models."})
          .field("arm_prior", &CalibrateTask::arm_prior,
                 {.meaning = "Prior standard deviations of the file's arm model, for the method `bundle`."})
          .field("loop", &CalibrateTask::loop, {.meaning = "Parameters of the paper's iterative methods."})
          .field("target", &CalibrateTask::target,
                 {.meaning = "Point at which both cameras look after the calibration.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .default_text = "the middle of the arm in its first pose"})
          .field("stages", &CalibrateTask::stages,
                 {.meaning = "Whether the calibration may move stages, within their travel."})
          .field("zooms", &CalibrateTask::zooms,
                 {.meaning = "Focal lengths for the pictures, as factors on the initial focal length.",
                  .range = between(0.1, 100),
                  .count = {1, 10}})
          .field("move_duration", &CalibrateTask::move_duration,
                 {.meaning = "Duration of each motion of the arm to a pose or back.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field("pause", &CalibrateTask::pause,
                 {.meaning = "Waiting time after each motion of the arm, so that vibrations decay.",
                  .unit = Unit::second,
                  .range = between(0, longest)})
          .field("settle_timeout", &CalibrateTask::settle_timeout,
                 {.meaning = "Longest duration of a motion. A device that takes longer counts as stuck.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field("frame_timeout", &CalibrateTask::frame_timeout,
                 {.meaning = "Longest wait for a picture.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field("save", &CalibrateTask::save,
                 {.meaning =
                      "Name of a .toml file for the calibrated rig, which experiments can include. The rig "
                      "file is written into this file's folder. An existing file with this name is renamed.",
                  .default_text = "not set; the results folder always has the rig as rig.toml"})
          .renamed("wanted", "required_std")
          .renamed("guess", "camera_prior");
  return table;
}

bool is_loop(const CalibrateTask& task) {
  return task.method != CalibrateMethod::bundle && task.method != CalibrateMethod::bundle_etalon;
}

bool is_as_printed(const CalibrateTask& task) {
  return task.method == CalibrateMethod::etalon_paper || task.method == CalibrateMethod::arcs_paper;
}

bool is_before_etalon(const CalibrateTask& task) {
  return task.method == CalibrateMethod::etalon || task.method == CalibrateMethod::etalon_paper ||
         task.method == CalibrateMethod::bundle_etalon;
}

double arc_bend(const CalibrateTask& task) {
  constexpr double printed = 120 * degree;
  return task.loop.arc.value_or(is_as_printed(task) ? printed : LoopConfig{}.arc);
}

std::size_t most_images(const CalibrateTask& task) {
  if (task.images) return static_cast<std::size_t>(*task.images);
  constexpr std::size_t printed = 400;
  if (!is_loop(task)) return RigSessionConfig{}.images;
  return is_as_printed(task) ? printed : LoopConfig{}.images;
}

std::vector<ArmState> calibration_poses(const CalibrateTask& task, const Arm& arm) {
  std::vector<ArmState> poses;
  if (is_before_etalon(task)) return poses;
  if (is_loop(task)) {
    // The sign of the bends depends on where the cameras stand.
    for (const double side : {1.0, -1.0})
      for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitZ().eval()})
        if (auto arc = arc_state(arm, arc_bend(task), side * axis)) poses.push_back(std::move(*arc));
    return poses;
  }
  poses.reserve(std::max(task.pose.size(), patterns.size()));
  for (const ShapeConfig& shape : task.pose) poses.push_back(arm_state(arm, shape));
  if (!poses.empty()) return poses;
  for (const auto& pattern : patterns) poses.push_back(patterned(arm, pattern));
  return poses;
}

std::array<std::size_t, 2> calibrated_cameras(const CalibrateTask& task,
                                              const std::vector<CameraConfig>& cameras) {
  return two_cameras(task.cameras, cameras);
}

RigSessionConfig session_config(const CalibrateTask& task, const ArmConfig& arm,
                                const std::vector<CameraConfig>& cameras, const StandConfig& stand) {
  RigSessionConfig config;
  config.cameras = calibrated_cameras(task, cameras);
  config.poses = calibration_poses(task, arm.arm());
  config.picture.markers = known_markers(arm);
  config.images = most_images(task);
  config.first = std::min<std::size_t>(3, config.images - 1);
  config.fewest = std::min<std::size_t>(5, config.picture.markers.size());
  if (task.method == CalibrateMethod::bundle_etalon) {
    config.etalon = stand.etalon.value_or(EtalonConfig{});
    config.screens = stand.screen.value_or(default_screens(arm.arm().length(), arm.base.position));
    config.poses = {arm_state(arm.arm(), arm.initial)};
    // One picture from the initial head positions is enough, since nothing there moves; a red line is seen at
    // two places.
    config.first = 1, config.fewest = 2;
  }
  config.desired = {task.required_std.angle,
                    {task.required_std.focal, task.required_std.focal},
                    task.required_std.zoom_ratio};
  if (task.target) config.target = vector(*task.target);
  config.may_use_stages = task.stages;
  config.zooms = task.zooms;
  config.move_duration = task.move_duration;
  config.patience = patience_of(task);
  return config;
}

LoopConfig loop_config(const CalibrateTask& task, const ArmConfig& arm,
                       const std::vector<CameraConfig>& cameras, const StandConfig& stand) {
  constexpr std::array<LoopMethod, 6> methods = {LoopMethod::etalon, LoopMethod::etalon,
                                                 LoopMethod::etalon, LoopMethod::etalon_paper,
                                                 LoopMethod::arcs,   LoopMethod::arcs_paper};
  LoopConfig config;
  config.method = methods.at(static_cast<std::size_t>(task.method));
  config.cameras = calibrated_cameras(task, cameras);
  config.images = most_images(task);
  constexpr double printed = 3, printed_zoom = 0.01, of_arcs = 0.5;
  const bool is_printed = is_as_printed(task);
  const double corrected = is_before_etalon(task) ? config.accepted : of_arcs;
  config.accepted = task.loop.accepted.value_or(is_printed ? printed : corrected);
  config.zoom_accepted = task.loop.zoom_accepted.value_or(is_printed ? printed_zoom : config.zoom_accepted);
  config.turn = task.loop.turn, config.slide = task.loop.slide, config.zoom_step = task.loop.zoom_step;
  config.arc = arc_bend(task);
  config.picture.markers = known_markers(arm);
  config.prior = session_prior(task, rig_model(arm.arm(), cameras), stand);
  config.etalon = stand.etalon.value_or(EtalonConfig{});
  config.move_duration = task.move_duration;
  config.patience = patience_of(task);
  return config;
}

RigPrior session_prior(const CalibrateTask& task, const RigModel& nominal, const StandConfig& stand) {
  std::optional<Eigen::Vector3d> seen;
  if (is_before_etalon(task)) seen = EtalonFigure(stand.etalon.value_or(EtalonConfig{})).middle();
  RigPrior prior = rough_prior(nominal, task.camera_prior.position_std, seen);
  // Pictures of the cylinder contain no information about the arm.
  if (is_before_etalon(task)) prior.arm = {.length = 0, .bend_gain = 0, .bend_share = 0, .bend = 0};
  if (task.method == CalibrateMethod::bundle) {
    constexpr double of_rods = 0.2, of_each_pose = 0.25;
    prior.arm.length = task.arm_prior.length_std;
    prior.arm.response = task.arm_prior.response_std.value_or(nominal.actuation.is_linear() ? 0 : of_rods);
    prior.arm.pose_response = task.arm_prior.pose_response_std.value_or(of_each_pose * prior.arm.response);
  }
  for (CameraPrior& camera : prior.cameras) {
    if (camera.pan_zero > 0) camera.pan_zero = task.stages ? task.camera_prior.zero_std : 0;
    camera.tilt_zero = task.camera_prior.zero_std;
    camera.rotation = task.camera_prior.rotation_std, camera.focal = task.camera_prior.focal_std;
    camera.principal_point = task.camera_prior.principal_point_std;
    if (task.camera_prior.exact_heads) camera.steps = 0;
  }
  return prior;
}

}  // namespace flexura
