#include "flexura/camera/mount.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "flexura/camera/axis_fields.h"
#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

constexpr NumberRange place_range = {.min = -1e6, .max = 1e6};
constexpr AxisUnits slide_units = {Unit::metre, Unit::metre_per_second, Unit::metre_per_second_squared};

struct Fault {
  std::string path, what;
};

// Returns an error if the mount does not have exactly one valid orientation; otherwise an empty text.
Fault orientation_fault(const MountConfig& mount) {
  if (mount.look_at && mount.rotation)
    return {"rotation", "is given together with look_at: expected one of them"};
  if (!mount.look_at && !mount.rotation) return {"", "has no orientation: expected look_at or rotation"};
  if (mount.rotation) {
    if (std::string problem = quaternion_problem(*mount.rotation); !problem.empty())
      return {"rotation", std::move(problem)};
    if (mount.roll != 0) return {"roll", "is only for look_at: expected the roll to be part of rotation"};
    return {};
  }
  const Eigen::Vector3d forward = vector(*mount.look_at) - vector(mount.position);
  if (!(forward.norm() > 0)) return {"look_at", "is the position of the mount: expected another point"};
  if (!upright(forward))
    return {
        "look_at",
        "is straight above or below the mount, so that the roll is undetermined: expected rotation instead"};
  return {};
}

}  // namespace

SlideConfig::SlideConfig() : AxisConfig{.max_rate = 0.1, .max_acceleration = 0.5} {}

bool StageConfig::can_move() const {
  return std::ranges::any_of(std::array{x, y, z},
                             [](const SlideConfig& axis) { return axis.limits[0] < axis.limits[1]; });
}

const Table<SlideConfig>& fields_of(const SlideConfig*) {
  static const auto table =
      axis_table<SlideConfig>("slide", "One axis of a stage. By default, its limits allow no travel.",
                              slide_units, between(-1e3, 1e3));
  return table;
}

const Table<StageConfig>& fields_of(const StageConfig*) {
  static const auto table =
      Table<StageConfig>("stage", "Linear stage that moves the mount along its own axes.")
          .field("x", &StageConfig::x, {.meaning = "Axis to the right."})
          .field("y", &StageConfig::y, {.meaning = "Axis downwards."})
          .field("z", &StageConfig::z, {.meaning = "Axis forwards."})
          .field("delay", &StageConfig::delay,
                 {.meaning = "Delay from a command to the start of the motion.",
                  .unit = Unit::second,
                  .range = between(0, 1e3)});
  return table;
}

const Table<MountConfig>& fields_of(const MountConfig*) {
  static const auto table =
      Table<MountConfig>("mount",
                         "Position and orientation of the camera's head. Either `look_at` or `rotation` "
                         "gives the orientation.")
          .field("position", &MountConfig::position,
                 {.meaning = "Origin of the mount, on the head's pan axis: X, Y, Z.",
                  .unit = Unit::metre,
                  .range = place_range,
                  .required = true})
          .field("look_at", &MountConfig::look_at,
                 {.meaning =
                      "Point at which the camera looks at pan 0 and tilt 0. +Y is then upright in the image.",
                  .unit = Unit::metre,
                  .range = place_range,
                  .default_text = "not set"})
          .field("roll", &MountConfig::roll,
                 {.meaning = "Rotation of the mount about the viewing direction of `look_at`, clockwise as "
                             "seen from behind the camera.",
                  .unit = Unit::radian,
                  .range = between(-10, 10)})
          .field(
              "rotation", &MountConfig::rotation,
              {.meaning =
                   "Unit quaternion (w, x, y, z) from the mount's axes (right, down, forward) to the world.",
               .range = between(-2, 2),
               .default_text = "not set"})
          .field("stage", &MountConfig::stage, {.meaning = "Linear stage that moves the mount."})
          .check([](const MountConfig& mount, Reader& reader) {
            const Fault fault = orientation_fault(mount);
            if (!fault.what.empty()) reader.problem_at(fault.path, fault.what);
          });
  return table;
}

Pose MountConfig::pose() const {
  const Fault fault = orientation_fault(*this);
  if (!fault.what.empty()) throw std::invalid_argument("a mount's " + fault.path + " " + fault.what);
  Pose X_WM;
  X_WM.position = vector(position);
  if (rotation) {
    X_WM.rotation = rotation_of(*rotation);
  } else {
    X_WM.rotation = *upright(vector(*look_at) - X_WM.position) * so3_exp(Eigen::Vector3d(0, 0, roll));
  }
  return X_WM;
}

std::optional<Eigen::Matrix3d> upright(const Eigen::Vector3d& forward) {
  const Eigen::Vector3d z = forward.stableNormalized();
  const Eigen::Vector3d across = z.cross(Eigen::Vector3d::UnitY());
  // Within 1e-9 rad from the vertical, rounding errors would determine the direction.
  if (!(across.norm() > 1e-9)) return std::nullopt;
  Eigen::Matrix3d R;
  R.col(0) = across.normalized();
  R.col(1) = z.cross(R.col(0));
  R.col(2) = z;
  return R;
}

std::optional<double> roll_of(const Eigen::Matrix3d& R_WC) {
  const auto R = upright(R_WC.col(2));
  if (!R) return std::nullopt;
  const double angle = std::atan2(R_WC.col(0).dot(R->col(1)), R_WC.col(0).dot(R->col(0)));
  return angle <= -std::numbers::pi ? std::numbers::pi : angle;
}

}  // namespace flexura
