#include "flexura/servo/servo_config.h"

#include <algorithm>
#include <stdexcept>

#include "flexura/base/table.h"

namespace flexura {
namespace {

void require(bool is_so, const char* what) {
  if (!is_so) throw std::invalid_argument(what);
}

}  // namespace

const Table<ServoCameraPrior>& fields_of(const ServoCameraPrior*) {
  static const auto table =
      Table<ServoCameraPrior>(
          "camera_prior",
          "Prior standard deviations of the camera models. The servo estimates errors of the camera models "
          "together with the arm's shape. If a standard deviation is 0, the servo takes the model's value as "
          "exact.")
          .field("rotation_std", static_cast<double ServoCameraPrior::*>(&ServoCameraPrior::rotation_std),
                 {.meaning =
                      "Standard deviation of a camera's orientation, about each axis of the camera frame.",
                  .unit = Unit::radian,
                  .range = between(0, 1)})
          .field("focal_std", static_cast<double ServoCameraPrior::*>(&ServoCameraPrior::focal_std),
                 {.meaning = "Relative standard deviation of the focal length.", .range = between(0, 1)})
          .renamed("turn", "rotation_std")
          .renamed("focal", "focal_std");
  return table;
}

const std::vector<std::string>& names_of(const ServoLawKind*) {
  static const std::vector<std::string> names = {"shape",      "points",          "chords",
                                                 "moments",    "potential",       "silhouettes",
                                                 "predictive", "computed_torque", "shape_potential"};
  return names;
}

const std::vector<std::string>& names_of(const ServoTracking*) {
  static const std::vector<std::string> names = {"finder", "model"};
  return names;
}

const std::vector<std::string>& names_of(const ServoMeasure*) {
  static const std::vector<std::string> names = {"picture", "flow"};
  return names;
}

const std::vector<std::string>& names_of(const ServoJacobian*) {
  static const std::vector<std::string> names = {"model", "broyden", "recursive"};
  return names;
}

void check_servo(const ServoConfig& config) {
  require(!config.goals.empty(), "a servo needs at least one target");
  double before = 0;
  for (const ServoGoal& goal : config.goals) {
    require(&goal == &config.goals.front() ? goal.time >= 0 : goal.time > before,
            "the times of a servo's targets must increase from 0");
    before = goal.time;
  }
  require(config.measure == ServoMeasure::picture || has_chords(config.law),
          "only the laws chords and potential can use measure = flow");
  require(config.jacobian == ServoJacobian::model || !predicts_motion(config.law),
          "the laws predictive, computed_torque and shape_potential need jacobian = model");
  require(config.anchor > 0, "a servo's anchor must be above 0");
  require(config.settle >= 0 && config.hold_after > 0 && config.give_up_after > config.hold_after &&
              config.timeout > config.settle,
          "a servo needs 0 <= settle < timeout and hold_after < give_up_after");
  require(!config.disturbance || *config.disturbance > 0, "a servo's disturbance must be above 0");
  require(config.points >= 1 && config.rate > 0 && config.tolerance > 0 && config.step > 0,
          "a servo's points, rate, tolerance and step must be above 0");
}

double slower_frame_rate(const std::vector<CameraConfig>& cameras, const std::array<std::size_t, 2>& two) {
  return std::min(cameras[two[0]].sensor.frame_rate, cameras[two[1]].sensor.frame_rate);
}

LimiterConfig limiter_config(const ServoConfig& config) {
  LimiterConfig limiter;
  limiter.step = config.step, limiter.drive = config.drive, limiter.list_step = config.list_step;
  limiter.obstacles = config.obstacles;
  return limiter;
}

}  // namespace flexura
