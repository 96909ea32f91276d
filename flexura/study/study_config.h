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

/// What a study varies, from the first to the second value. One of these.
struct VaryConfig {
  using Values = std::optional<std::array<double, 2>>;  ///< From, to.
  Values pan, tilt, roll, orbit;                        ///< rad
  Values distance;                                      ///< From the target's centre, m.
  Values mount_x, mount_y, mount_z;     ///< MountConfig::position, m; the camera keeps its orientation.
  Values zoom;                          ///< A position of the lens's table.
  Values stage_x, stage_y, stage_z;     ///< m
  Values focal_length, fx, fy, cx, cy;  ///< px, at the zoom as it stands.
  Values k1, k2, p1, p2, k3;            ///< The lens's distortion at the zoom as it stands.
  Values tilt_axis_x, tilt_axis_y, tilt_axis_z;  ///< HeadConfig::tilt_axis, m.
  Values pupil_x, pupil_y, pupil_z;              ///< HeadConfig::pupil, m.
  Values pupil_shift;                            ///< HeadConfig::pupil_shift, m.
};

/// The one parameter that a study varies.
struct Variation {
  std::string_view name;                                 ///< As in the file: "orbit".
  Unit unit = Unit::none;                                ///< Of its values.
  VaryConfig::Values VaryConfig::* parameter = nullptr;  ///< The member that has `values`.
  std::array<double, 2> values = {0, 0};                 ///< First and last, in base units.
};

/// What a study looks at: a circle with the square inscribed in it.
struct StudyTargetConfig {
  std::array<double, 3> center = {0, 0, 0};  ///< m, in W.
  std::array<double, 3> normal = {0, 0, 1};  ///< The way it faces, in W; not 0.
  double radius = 0.5;                       ///< m; at least 1e-6.
};

/// `kind = "study"`: how the image of a target changes with one of a camera's parameters. The arm stays as it
/// is, and no time passes.
struct StudyTask {
  std::string name;
  std::string camera;  ///< Its name; the first one when empty.
  VaryConfig vary;
  std::int64_t points = 101;  ///< Values, evenly from the first to the last.
  bool measure = false;       ///< In pictures of the square too.
  StudyTargetConfig target;
};

const Table<VaryConfig>& fields_of(const VaryConfig*);
const Table<StudyTargetConfig>& fields_of(const StudyTargetConfig*);
const Table<StudyTask>& fields_of(const StudyTask*);

/// The parameters that `vary` gives values to: one, in a study that was checked.
[[nodiscard]] std::vector<Variation> variations(const VaryConfig& vary);

/// The camera that a study looks through; null when there is none of that name.
[[nodiscard]] const CameraConfig* camera_of(const StudyTask& task, const std::vector<CameraConfig>& cameras);

/// Reports what keeps the study at `path` ("task[2]") from being made with these cameras.
void check_study(const StudyTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                 Reader& reader);

}  // namespace flexura
