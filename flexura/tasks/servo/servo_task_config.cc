#include "flexura/tasks/servo/servo_task_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/camera/camera.h"
#include "flexura/camera/sensor.h"
#include "flexura/kinematics/shape.h"
#include "flexura/rig/setup.h"
#include "flexura/servo/servo_session.h"
#include "flexura/tasks/camera_names.h"
#include "flexura/tasks/servo/servo_target.h"
#include "flexura/tasks/shape_fields.h"

namespace flexura {
namespace {

constexpr double longest_time = 1e4;                       // s
constexpr double shortest_step = 1e-4, longest_step = 10;  // s
constexpr std::size_t most_targets = 10000, most_points = 10000;

// Checks that the curve covers the whole arm: its length is close to the arm's.
void check_curve(const std::vector<std::array<double, 3>>& curve, const ArmConfig& arm,
                 const std::string& path, Reader& reader) {
  const double length = curve_length(curve);
  double least = 0, most = 0;
  for (const Section& section : arm.section) {
    least += section.length * section.stretch_limits[0];
    most += section.length * section.stretch_limits[1];
  }
  constexpr double about = 0.05;
  if (!(length > 0))
    reader.problem_at(path, "has no length: expected points that differ");
  else if (length < (1 - about) * least || length > (1 + about) * most)
    reader.problem_at(path,
                      fmt::format("is {:.4g} m long: expected the length of the arm within 5 %, {}", length,
                                  least < most ? fmt::format("{:.4g} m to {:.4g} m", least, most)
                                               : fmt::format("{:.4g} m", most)));
}

// Returns a setting as a member of the task.
template <class M>
M ServoTask::* of_task(M ServoSettings::* setting) {
  return setting;
}

}  // namespace

const Table<ServoTargetConfig>& fields_of(const ServoTargetConfig*) {
  using Target = ServoTargetConfig;
  static const auto table =
      with_shape_fields(
          Table<Target>(
              "target",
              "Target shape of the arm. The target is given by exactly one of these: bends, the tip's "
              "position, a backbone curve in space, direction angles, or two pictures of the arm.")
              .field("time", &Target::time,
                     {.meaning = "Time of the target from the task's start. Between targets "
                                 "the reference is interpolated linearly.",
                      .unit = Unit::second,
                      .range = between(0, longest_time)}))
          .field("position", &Target::position,
                 {.meaning = "Position of the tip in the world.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .default_text = "not set"})
          .field("curve", &Target::curve,
                 {.meaning =
                      "Points of the backbone in the world from base to tip. `tolerance` limits the distance "
                      "between the smooth curve through these points and the arm's nearest shape.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .count = {2, most_points},
                  .default_text = "not set"})
          .field("azimuths", &Target::azimuths,
                 {.meaning = "Azimuths of the arm's direction from +Y towards +X, at evenly spaced "
                             "points from base to tip.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .count = {2, most_points},
                  .default_text = "not set"})
          .field("elevations", &Target::elevations,
                 {.meaning = "Elevations of the arm's direction from the plane XOY towards +Z, at the points "
                             "of `azimuths`.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .count = {2, most_points},
                  .default_text = "not set"})
          .field("pictures", &Target::pictures,
                 {.meaning = "Two picture files in this file's folder or below, in the order of the task's "
                             "cameras. When the pictures were taken, the cameras had the same axis positions "
                             "as at the task's start.",
                  .count = {2, 2},
                  .default_text = "not set"});
  return table;
}

const Table<ServoTask>& fields_of(const ServoTask*) {
  using T = ServoTask;
  static const auto table =
      Table<T>("servo",
               "Controls the shape of the arm by feedback from two cameras until it reaches the target. The "
               "duration depends on the convergence.")
          .field("name", &T::name, {.meaning = "Name of the task in results.", .default_text = "its kind"})
          .field(
              "law", of_task(&T::law),
              {.meaning =
                   "Control law, which determines the error that the servo reduces, and how. `shape`: "
                   "difference between the shape estimated from both images and the target shape. `points`, "
                   "`chords`, `moments`: errors of image features. `silhouettes`: errors of the arm's image "
                   "edges. `potential`: the paper's artificial potential on the errors in two image planes "
                   "(XOY of the first camera, ZOY of the second). `predictive`: the shape error, with "
                   "commands planned ahead so that a dynamic arm stops oscillating. `computed_torque` and "
                   "`shape_potential`: the shape error, with forces in the modes of the arm's oscillation."})
          .field(
              "track", of_task(&T::track),
              {.meaning = "How the arm is found in the pictures. `finder`: by its brightness and [[seeing]]. "
                          "`model`: the tube of the predicted shape is fitted to the pictures. This works "
                          "in front of clutter and with hidden parts, but uses no markers. If it fails, "
                          "the arm is found as with `finder`."})
          .field("measure", of_task(&T::measure),
                 {.meaning = "Source of the angles for the laws chords and potential. `picture`: each "
                             "picture alone. `flow`: optical flow since the previous picture; these angles "
                             "are corrected slowly towards the angles from each picture."})
          .field("anchor", of_task(&T::anchor),
                 {.meaning = "Time constant of the correction of angles from optical flow: their errors "
                             "decay as exp(-t/anchor).",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_time)})
          .field("jacobian", of_task(&T::jacobian),
                 {.meaning = "Jacobian of the arm with respect to its drives. `model`: computed from the "
                             "model. `broyden`, `recursive`: estimated during the run by Broyden's update or "
                             "by recursive least squares."})
          .field("cameras", &T::cameras,
                 {.meaning = "Names of two cameras.", .count = {2, 2}, .default_text = "the first two"})
          .field("target", &T::target,
                 {.meaning = "Target shapes in order of time, as `[[task.target]]`.",
                  .count = {1, most_targets},
                  .required = true})
          .field(
              "points", of_task(&T::points),
              {.meaning =
                   "Number of points along the arm, for the laws points, chords, potential and silhouettes.",
               .range = between(1, 200)})
          .field("rate", of_task(&T::rate),
                 {.meaning = "Convergence rate, 1/s: errors decay as exp(-rate t).",
                  .range = above_up_to(0, 1000)})
          .field("damping", of_task(&T::damping),
                 {.meaning = "Damping of the least squares, relative to the root mean square of the "
                             "Jacobian's entries. The law shape does not use the damping.",
                  .range = between(0, 10)})
          .field("predict", of_task(&T::predict),
                 {.meaning = "Whether the servo predicts the effect of commands that were sent after the "
                             "picture was taken."})
          .field(
              "tolerance", of_task(&T::tolerance),
              {.meaning = "Largest shape error at which the target counts as reached. The shape error is the "
                          "root mean square distance between the two shapes over the arm's length, as a "
                          "fraction of this length.",
               .range = above_up_to(0, 1)})
          .field("settle", of_task(&T::settle),
                 {.meaning = "Time for which the error must stay within `tolerance`.",
                  .unit = Unit::second,
                  .range = between(0, longest_time)})
          .field("timeout", of_task(&T::timeout),
                 {.meaning = "Longest duration after the last target's time.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_time)})
          .field("hold_after", of_task(&T::hold_after),
                 {.meaning = "Time without an observation after which the arm stops and waits.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_time)})
          .field("give_up_after", of_task(&T::give_up_after),
                 {.meaning = "Time without an observation after which the task fails.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_time)})
          .field(
              "disturbance", of_task(&T::disturbance),
              {.meaning =
                   "If the arm's shape changes by more than this value without a motion of the drives, the "
                   "servo holds the arm. The change is the root mean square distance between the two "
                   "shapes over the arm's length, as a fraction of this length. The task fails if the change "
                   "lasts for `give_up_after`.",
               .range = above_up_to(0, 1),
               .default_text =
                   "0.05 with the arm's model \"dynamic\" and jacobian \"model\", otherwise no such check"})
          .field("follow", of_task(&T::follow),
                 {.meaning = "Whether the cameras' heads turn and zoom out to keep the arm in view."})
          .field("camera_prior", of_task(&T::camera_prior),
                 {.meaning = "Prior standard deviations of the camera models."})
          .field("step", &T::step,
                 {.meaning = "Time between commands.",
                  .unit = Unit::second,
                  .range = between(shortest_step, longest_step),
                  .default_text = "one frame of the slower camera"})
          .renamed("blind", "hold_after")
          .renamed("lost", "give_up_after")
          .renamed("doubt", "camera_prior");
  return table;
}

std::array<std::size_t, 2> servo_cameras(const ServoTask& task, const std::vector<CameraConfig>& cameras) {
  return two_cameras(task.cameras, cameras);
}

ServoSettings servo_settings(const ServoTask& task, const std::vector<CameraConfig>& cameras) {
  auto settings = static_cast<const ServoSettings&>(task);
  settings.hold_after =
      std::max(task.hold_after, 1.5 / slower_frame_rate(cameras, servo_cameras(task, cameras)));
  settings.give_up_after = std::max(task.give_up_after, 2 * settings.hold_after);
  return settings;
}

namespace {

// Checks the camera planes: the paper's law reads one picture as the plane XOY and the other as ZOY.
void check_planes(const ServoTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                  Reader& reader) {
  if (task.law != ServoLawKind::potential || cameras.size() < 2) return;
  const auto [front, side] = servo_cameras(task, cameras);
  if (front >= cameras.size() || side >= cameras.size()) return;  // Already reported.
  try {
    const Camera one(cameras[front]), other(cameras[side]);
    if (stand_for_planes(one.pose(one.initial_stance()), other.pose(other.initial_stance()))) return;
  } catch (const std::exception&) {
    return;  // An invalid camera is reported elsewhere.
  }
  reader.problem_at(path + ".law", fmt::format("the law potential takes the picture of camera {} as the "
                                               "plane XOY and that of {} as ZOY: expected cameras that "
                                               "look along Z and along X, in this order",
                                               cameras[front].name, cameras[side].name));
}

// Checks that steps follow the cameras, and that pictures arrive before the servo gives up.
void check_frames(const ServoTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                  Reader& reader) {
  if (cameras.size() < 2) return;
  const auto [front, side] = servo_cameras(task, cameras);
  if (front >= cameras.size() || side >= cameras.size()) return;  // Already reported.
  const double frame = 1 / slower_frame_rate(cameras, {front, side});
  if (!task.step && (frame < shortest_step || frame > longest_step))
    reader.problem_at(path + ".step", fmt::format("missing, and the frame of the slower camera, {:.6g} s, "
                                                  "cannot be used instead: expected a step from {} s to {} s",
                                                  frame, shortest_step, longest_step));
  const double given_up = servo_settings(task, cameras).give_up_after;
  for (const std::size_t i : {front, side}) {
    const double late = times_of_frame_at(cameras[i].sensor, 0).received;
    const std::string when =
        fmt::format("the delay of {:.6g} s of camera {}'s pictures", late, cameras[i].name);
    if (late >= given_up) {
      reader.problem_at(path + ".give_up_after",
                        fmt::format("{} s: expected more than {}", task.give_up_after, when));
      return;
    }
    if (late > longest_delay) {
      reader.problem_at(
          path, fmt::format("has pictures that are too old: expected less than {}, at most {} s", when,
                            longest_delay));
      return;
    }
  }
}

void check_target(const ServoTargetConfig& target, const ArmConfig& arm, const std::string& path,
                  Reader& reader) {
  check_shape(target, arm.kind, arm.section.size(), path, reader);
  const bool has_shape = target.cord_angles || target.archings || target.bends || target.stretches;
  const int ways = (has_shape ? 1 : 0) + (target.position ? 1 : 0) + (target.curve ? 1 : 0) +
                   (target.azimuths || target.elevations ? 1 : 0) + (target.pictures.empty() ? 0 : 1);
  if (ways != 1)
    reader.problem_at(
        path,
        fmt::format(
            "has {}: expected exactly one of bends, position, curve, azimuths with elevations, and pictures",
            ways == 0 ? "no shape" : "a shape in more than one way"));
  if (target.azimuths.has_value() != target.elevations.has_value() ||
      (target.azimuths && target.azimuths->size() != target.elevations->size()))
    reader.problem_at(path, "has different numbers of azimuths and elevations: expected equal numbers");
  if (target.curve) check_curve(*target.curve, arm, path + ".curve", reader);
}

// Performs all checks that need no shape of the arm.
void check_servo(const ServoTask& task, const ArmConfig& arm, const std::vector<CameraConfig>& cameras,
                 const std::string& path, Reader& reader) {
  check_two_cameras(task.cameras, cameras, path, reader);
  if (!(task.give_up_after > task.hold_after))
    reader.problem_at(path + ".give_up_after", fmt::format("{} s: expected more than hold_after, {} s",
                                                           task.give_up_after, task.hold_after));
  if (!(task.timeout > task.settle))
    reader.problem_at(path + ".timeout",
                      fmt::format("{} s: expected more than settle, {} s", task.timeout, task.settle));
  check_planes(task, cameras, path, reader);
  check_frames(task, cameras, path, reader);
  if (task.measure == ServoMeasure::flow && !has_chords(task.law))
    reader.problem_at(path + ".measure",
                      "\"flow\" measures the angles of chords: expected the law chords or potential");
  if (task.jacobian != ServoJacobian::model && predicts_motion(task.law))
    reader.problem_at(
        path + ".jacobian",
        "the laws predictive, computed_torque and shape_potential use the arm's model: expected \"model\"");
  for (std::size_t i = 0; i < task.target.size(); ++i) {
    const std::string place = fmt::format("{}.target[{}]", path, i);
    check_target(task.target[i], arm, place, reader);
    if (i > 0 && !(task.target[i].time > task.target[i - 1].time))
      reader.problem_at(place + ".time",
                        fmt::format("{} s: expected more than the time of the previous target, {} s",
                                    task.target[i].time, task.target[i - 1].time));
  }
}

}  // namespace

void check_keys(const ServoTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  const std::size_t before = reader.problems().size();
  check_servo(task, setup.arm, setup.cameras(), path, reader);
  if (reader.problems().size() > before) return;  // The code below requires that shapes fit the arm.
  const Arm arm = setup.arm.arm();
  for (std::size_t i = 0; i < task.target.size(); ++i)
    check_bends(arm, task.target[i], fmt::format("{}.target[{}]", path, i), reader);
}

}  // namespace flexura
