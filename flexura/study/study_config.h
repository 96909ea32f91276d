#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"

namespace flexura {

/// Camera parameter that a study varies, as first and last value. Exactly one member must be given.
struct VaryConfig {
  using Values = std::optional<std::array<double, 2>>;  ///< First and last value.
  Values pan, tilt, roll, orbit;                        ///< Angles, rad.
  Values distance;  ///< Distance of the camera from the target's centre, m.
  /// Coordinates of MountConfig::position, m; the camera keeps its orientation.
  Values mount_x, mount_y, mount_z;
  Values zoom;                       ///< Zoom position.
  Values stage_x, stage_y, stage_z;  ///< Stage offset, m.
  /// Intrinsics at the initial zoom, px. `focal_length` sets fx and fy.
  Values focal_length, fx, fy, cx, cy;
  /// Distortion of the lens at the initial zoom. The lens model must have the coefficient.
  Values k1, k2, p1, p2, k3, k4, k5, k6;
  Values tilt_axis_x, tilt_axis_y, tilt_axis_z;  ///< Coordinates of HeadConfig::tilt_axis, m.
  Values pupil_x, pupil_y, pupil_z;              ///< Coordinates of HeadConfig::pupil, m.
  Values pupil_shift;                            ///< HeadConfig::pupil_shift, m.
};

/// The parameter of a study.
struct Variation {
  std::string_view name;                                 ///< Key in the file, such as "orbit".
  Unit unit = Unit::none;                                ///< Unit of the values.
  VaryConfig::Values VaryConfig::* parameter = nullptr;  ///< Member of VaryConfig with the values.
  std::array<double, 2> values = {0, 0};                 ///< First and last value, in base units.
};

/// Target of a study: a circle with an inscribed square.
struct StudyTargetConfig {
  std::array<double, 3> center = {0, 0, 0};  ///< Centre in W, m.
  /// Normal of the target's front, in W. The length of the normal must be above 0.
  std::array<double, 3> normal = {0, 0, 1};
  double radius = 0.5;  ///< Radius of the circle, m; at least 1e-6.
};

/// A task with `kind = "study"`: computes the image of a target for different values of one camera parameter.
/// The arm is at rest, and no time passes.
struct StudyTask {
  std::string name;
  std::string camera;  ///< Name of the camera; "" for the first camera.
  VaryConfig vary;
  std::int64_t points = 101;  ///< Number of evenly spaced values, including both ends.
  bool measure = false;       ///< Whether features are also measured in rendered pictures of the square.
  StudyTargetConfig target;
};

const Table<VaryConfig>& fields_of(const VaryConfig*);
const Table<StudyTargetConfig>& fields_of(const StudyTargetConfig*);
const Table<StudyTask>& fields_of(const StudyTask*);

/// Returns the parameters for which `vary` has values. A valid study has exactly one parameter.
[[nodiscard]] std::vector<Variation> variations(const VaryConfig& vary);

/// Returns the camera of a study; null if no camera has the study's camera name.
[[nodiscard]] const CameraConfig* camera_of(const StudyTask& task, const std::vector<CameraConfig>& cameras);

/// Reports to `reader` why a study is impossible with the given cameras. `path`: path of the study in the
/// document, such as "task[2]".
void check_study(const StudyTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                 Reader& reader);

}  // namespace flexura
