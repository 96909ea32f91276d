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

/// Parameter of a study, from the first to the second value. Exactly one is given.
struct VaryConfig {
  using Values = std::optional<std::array<double, 2>>;  ///< From, to.
  Values pan, tilt, roll, orbit;                        ///< In rad.
  Values distance;                                      ///< From the target's centre, m.
  Values mount_x, mount_y, mount_z;     ///< MountConfig::position, m; the camera keeps its orientation.
  Values zoom;                          ///< Position in the lens's table.
  Values stage_x, stage_y, stage_z;     ///< In m.
  Values focal_length, fx, fy, cx, cy;  ///< In px, at the current zoom.
  Values k1, k2, p1, p2, k3;            ///< The lens's distortion at the current zoom.
  Values tilt_axis_x, tilt_axis_y, tilt_axis_z;  ///< HeadConfig::tilt_axis, m.
  Values pupil_x, pupil_y, pupil_z;              ///< HeadConfig::pupil, m.
  Values pupil_shift;                            ///< HeadConfig::pupil_shift, m.
};

/// The parameter of a study.
struct Variation {
  std::string_view name;                                 ///< As in the file: "orbit".
  Unit unit = Unit::none;                                ///< Unit of its values.
  VaryConfig::Values VaryConfig::* parameter = nullptr;  ///< The member that has `values`.
  std::array<double, 2> values = {0, 0};                 ///< First and last, in base units.
};

/// Target of a study: a circle with an inscribed square.
struct StudyTargetConfig {
  std::array<double, 3> center = {0, 0, 0};  ///< In m, in W.
  std::array<double, 3> normal = {0, 0, 1};  ///< Normal of its front, in W; not 0.
  double radius = 0.5;                       ///< In m; at least 1e-6.
};

/// `kind = "study"`: the image of a target while one of a camera's parameters varies. The arm stays at rest,
/// and no time passes.
struct StudyTask {
  std::string name;
  std::string camera;  ///< Its name; if empty, the first camera.
  VaryConfig vary;
  std::int64_t points = 101;  ///< Number of values, evenly from the first to the last.
  bool measure = false;       ///< Measure also in pictures of the square.
  StudyTargetConfig target;
};

const Table<VaryConfig>& fields_of(const VaryConfig*);
const Table<StudyTargetConfig>& fields_of(const StudyTargetConfig*);
const Table<StudyTask>& fields_of(const StudyTask*);

/// Returns the parameters that `vary` gives values to: one, in a checked study.
[[nodiscard]] std::vector<Variation> variations(const VaryConfig& vary);

/// Returns the camera of a study; null if no camera has that name.
[[nodiscard]] const CameraConfig* camera_of(const StudyTask& task, const std::vector<CameraConfig>& cameras);

/// Reports why the study at `path` ("task[2]") is impossible with these cameras.
void check_study(const StudyTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                 Reader& reader);

}  // namespace flexura
