#include "flexura/experiment/calibrate_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"

namespace flexura {
namespace {

constexpr std::int64_t most_images = 200;
constexpr double longest = 1e4;  // s

// Bends of the arm's lower, middle and upper third, rad: mild ones first, of which rough guesses recognise
// the markers; then such as bend every part to every side.
constexpr std::array<std::array<double, 6>, 6> patterns = {{{0.5, 0, 0.5, 0, 0.5, 0},
                                                            {0, 0.5, 0, 0.5, 0, 0.5},
                                                            {-0.6, 0.3, 0.7, 0.1, 0.5, -0.8},
                                                            {0.4, -0.7, -0.3, -0.4, 0.9, 0.2},
                                                            {1, 0.2, 0.8, -0.3, -1, 0.4},
                                                            {-0.3, 1, 0.2, -1, -0.4, 1}}};

// The bends of a pattern, shared out among the sections of each third by their lengths.
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
    constexpr double within = 0.9;  // Of what the section takes.
    const double most = within * arm.sections[i].max_bend;
    if (bend.norm() > most) bend *= most / bend.norm();
    const auto& [least, longest_stretch] = arm.sections[i].stretch_limits;
    state.stretches[i] = std::clamp(1.0, least, longest_stretch);
  }
  return state;
}

}  // namespace

const std::vector<std::string>& names_of(const CalibrateMethod*) {
  static const std::vector<std::string> names = {"bundle"};
  return names;
}

const Table<CalibrateWantedConfig>& fields_of(const CalibrateWantedConfig*) {
  static const auto table =
      Table<CalibrateWantedConfig>("wanted", "How well the rig shall be known: standard deviations.")
          .field("angle", &CalibrateWantedConfig::angle,
                 {.meaning = "Of the angle between the optical axes.",
                  .unit = Unit::radian,
                  .range = above_up_to(0, 1)})
          .field("focal", &CalibrateWantedConfig::focal,
                 {.meaning = "Of each focal length, a share.", .range = above_up_to(0, 1)})
          .field("zoom_ratio", &CalibrateWantedConfig::zoom_ratio,
                 {.meaning = "Of how much larger one camera shows the arm than the other, a share.",
                  .range = above_up_to(0, 1)});
  return table;
}

const Table<CalibrateGuessConfig>& fields_of(const CalibrateGuessConfig*) {
  static const auto table =
      Table<CalibrateGuessConfig>(
          "guess", "How wrong the file's description of the cameras may be: standard deviations.")
          .field("rotation", &CalibrateGuessConfig::rotation,
                 {.meaning = "Of how a mount is turned, about each axis.",
                  .unit = Unit::radian,
                  .range = above_up_to(0, 1)})
          .field(
              "distance", &CalibrateGuessConfig::distance,
              {.meaning =
                   "Of where a mount is, in each direction, as a share of its distance from the arm's base.",
               .range = above_up_to(0, 1)})
          .field("focal", &CalibrateGuessConfig::focal,
                 {.meaning = "Of the focal length, a share.", .range = between(0, 1)})
          .field("principal_point", &CalibrateGuessConfig::principal_point,
                 {.meaning = "Of the principal point, in each direction, px.", .range = between(0, 1000)})
          .field("exact_heads", &CalibrateGuessConfig::exact_heads,
                 {.meaning = "Heads stand where they count, not somewhere within half a step of it."});
  return table;
}

const Table<CalibrateTask>& fields_of(const CalibrateTask*) {
  static const auto table =
      Table<CalibrateTask>("calibrate",
                           "Two cameras find out how they stand, and are sent to where both look at the arm "
                           "along orthogonal axes "
                           "with equal zoom. The arm shows some poses, going from one to the next by way of "
                           "the shape in which it "
                           "is; heads, stages and zooms are moved as well. It takes as long as it takes.")
          .field("name", &CalibrateTask::name,
                 {.meaning = "What to call the task in results.", .default_text = "its kind"})
          .field("method", &CalibrateTask::method,
                 {.meaning = "How: by least squares over everything at once."})
          .field("cameras", &CalibrateTask::cameras,
                 {.meaning = "The names of two cameras.", .count = {2, 2}, .default_text = "the first two"})
          .field(
              "pose", &CalibrateTask::pose,
              {.meaning =
                   "What the arm shows, as `pose = [{ bends = ... }, ...]`. The cameras are to look at the "
                   "middle of the first one.",
               .count = {1, 100},
               .default_text = "six, that bend every part of the arm to every side"})
          .field("images", &CalibrateTask::images,
                 {.meaning = "Pictures a camera, at most; the last one verifies.",
                  .range = between(3, most_images)})
          .field("wanted", &CalibrateTask::wanted, {.meaning = "When no more pictures are needed."})
          .field("guess", &CalibrateTask::guess, {.meaning = "How rough the file's description is."})
          .field("target", &CalibrateTask::target,
                 {.meaning = "What the cameras shall look at in the end.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .default_text = "the middle of the arm in its first pose"})
          .field("stages", &CalibrateTask::stages, {.meaning = "Stages may be moved, as far as they travel."})
          .field("zooms", &CalibrateTask::zooms,
                 {.meaning = "Focal lengths to look with, as factors on that at the start.",
                  .range = above_up_to(0, 1000),
                  .count = {1, 10}})
          .field("move_duration", &CalibrateTask::move_duration,
                 {.meaning = "Time of the arm's way to a pose, or back.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field("settle_timeout", &CalibrateTask::settle_timeout,
                 {.meaning = "How long motions may take before something is taken to be stuck.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field("frame_timeout", &CalibrateTask::frame_timeout,
                 {.meaning = "How long to wait for a picture.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest)})
          .field(
              "save", &CalibrateTask::save,
              {.meaning = "A file (.toml) in this file's folder for the rig as found, which experiments can "
                          "include. One that is there already is kept, under another name.",
               .default_text = "none; the results have it as rig.toml"});
  return table;
}

std::vector<ArmState> calibration_poses(const CalibrateTask& task, const Arm& arm) {
  std::vector<ArmState> poses;
  poses.reserve(std::max(task.pose.size(), patterns.size()));
  for (const ShapeConfig& shape : task.pose) poses.push_back(arm_state(arm, shape));
  if (!poses.empty()) return poses;
  for (const auto& pattern : patterns) poses.push_back(patterned(arm, pattern));
  return poses;
}

std::array<std::size_t, 2> calibrated_cameras(const CalibrateTask& task,
                                              const std::vector<CameraConfig>& cameras) {
  std::array<std::size_t, 2> places = {0, 1};
  for (std::size_t i = 0; i < task.cameras.size() && i < 2; ++i) {
    const auto found = std::ranges::find(cameras, task.cameras[i], &CameraConfig::name);
    places[i] = static_cast<std::size_t>(found - cameras.begin());
  }
  return places;
}

RigSessionConfig session_config(const CalibrateTask& task, const ArmConfig& arm,
                                const std::vector<CameraConfig>& cameras) {
  RigSessionConfig config;
  config.cameras = calibrated_cameras(task, cameras);
  config.poses = calibration_poses(task, arm.arm());
  for (const Marker& marker : arm.look.markers(arm.arm()))
    config.picture.markers.push_back({.s = marker.at, .color = vector(marker.color)});
  config.images = static_cast<std::size_t>(task.images);
  config.first = std::min<std::size_t>(3, config.images - 1);
  config.fewest = std::min<std::size_t>(5, config.picture.markers.size());
  config.wanted = {task.wanted.angle, {task.wanted.focal, task.wanted.focal}, task.wanted.zoom_ratio};
  if (task.target) config.target = vector(*task.target);
  config.may_use_stages = task.stages;
  config.zooms = task.zooms;
  config.move_duration = task.move_duration;
  config.patience.settle = task.settle_timeout, config.patience.frame = task.frame_timeout;
  return config;
}

RigPrior session_prior(const CalibrateTask& task, const RigModel& believed) {
  RigPrior prior = rough_prior(believed, task.guess.distance);
  for (CameraPrior& camera : prior.cameras) {
    camera.rotation = task.guess.rotation, camera.focal = task.guess.focal;
    camera.principal_point = task.guess.principal_point;
    if (task.guess.exact_heads) camera.steps = 0;
  }
  return prior;
}

namespace {

std::vector<std::string> quoted(const std::vector<CameraConfig>& cameras) {
  std::vector<std::string> names;
  for (const CameraConfig& camera : cameras) names.push_back(Node{camera.name, {}}.brief());
  return names;
}

void check_names(const CalibrateTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                 Reader& reader) {
  if (task.cameras.empty() && cameras.size() < 2)
    reader.problem_at(path, "needs two cameras: expected a second [[camera]]");
  for (std::size_t i = 0; i < task.cameras.size(); ++i) {
    const std::string& name = task.cameras[i];
    if (std::ranges::find(cameras, name, &CameraConfig::name) == cameras.end())
      reader.problem_at(fmt::format("{}.cameras[{}]", path, i),
                        fmt::format("there is no camera {}: expected one of {}", Node{name, {}}.brief(),
                                    fmt::join(quoted(cameras), ", ")));
  }
  if (task.cameras.size() == 2 && task.cameras[0] == task.cameras[1])
    reader.problem_at(path + ".cameras", "names one camera twice: expected two");
}

bool is_plain_file(const std::string& name) {
  const bool is_plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
  return is_plain && name.size() > 5 && name.ends_with(".toml") && name.front() != '.';
}

}  // namespace

void check_calibration(const CalibrateTask& task, const ArmConfig& arm,
                       const std::vector<CameraConfig>& cameras, const std::string& path, Reader& reader) {
  check_names(task, cameras, path, reader);
  for (std::size_t i = 0; i < task.pose.size(); ++i)
    check_shape(task.pose[i], arm.kind, arm.section.size(), fmt::format("{}.pose[{}]", path, i), reader);
  constexpr std::size_t fewest = 4;
  if (arm.look.markers(arm.arm()).size() < fewest)
    reader.problem_at(path,
                      fmt::format("needs at least {} markers to recognise places along the arm: expected "
                                  "arm.look.bands or arm.look.marker",
                                  fewest));
  if (!task.save.empty() && !is_plain_file(task.save))
    reader.problem_at(path + ".save",
                      fmt::format("{}: expected a file's name of letters, digits, -, _ and ., "
                                  "ending in .toml",
                                  Node{task.save, {}}.brief()));
}

}  // namespace flexura
