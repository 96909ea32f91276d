#include "flexura/camera/camera_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>

#include "flexura/base/table.h"
#include "flexura/camera/axis_fields.h"

namespace flexura {
namespace {

void check_start(const AxisConfig& axis, double start, const std::string& path, Reader& reader) {
  if (start >= axis.limits[0] && start <= axis.limits[1]) return;
  reader.problem_at(path, fmt::format("{:.6g} is outside the axis's limits {:.6g} to {:.6g}", start,
                                      axis.limits[0], axis.limits[1]));
}

// Checks a camera's name, which is used in names of files and log topics.
void check_name(const std::string& name, Reader& reader) {
  constexpr std::size_t longest = 100;
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.' || c == ' ';
  };
  if (name.empty()) {
    reader.problem_at("name", "is empty: expected a name");
  } else if (!std::ranges::all_of(name, is_plain) || name.front() == '.' || name.size() > longest) {
    reader.problem_at("name", fmt::format("{} cannot be a file name: expected at most {} letters, digits, -, "
                                          "_, spaces and points, not beginning with a point",
                                          Node{name, {}}.brief(), longest));
  }
}

void check_camera(const CameraConfig& camera, Reader& reader) {
  const ZoomTable lens(camera.lens, camera.sensor.width, camera.sensor.height);
  const AxisConfig zoom = camera.head.zoom.axis(lens);
  if (zoom.limits[0] < lens.first() || zoom.limits[1] > lens.last()) {
    reader.problem_at("head.zoom.limits",
                      lens.is_linear()
                          ? "reach to 0 or below: expected zoom ratios above 0"
                          : fmt::format("leave the lens's table: expected {:.9g} to {:.9g} or a part of it",
                                        lens.first(), lens.last()));
    return;
  }
  const CameraStartConfig& start = camera.initial;
  check_start(camera.head.pan, start.pan, "initial.pan", reader);
  check_start(camera.head.tilt, start.tilt, "initial.tilt", reader);
  if (start.zoom) check_start(zoom, *start.zoom, "initial.zoom", reader);
  const StageConfig& stage = camera.mount.stage;
  check_start(stage.x, start.stage[0], "initial.stage[0]", reader);
  check_start(stage.y, start.stage[1], "initial.stage[1]", reader);
  check_start(stage.z, start.stage[2], "initial.stage[2]", reader);
}

}  // namespace

const Table<CameraStartConfig>& fields_of(const CameraStartConfig*) {
  static const auto table =
      Table<CameraStartConfig>("initial", "Positions of the camera's axes at the start of the run.")
          .field("pan", &CameraStartConfig::pan,
                 {.meaning = "Pan angle, positive to the camera's left.",
                  .unit = Unit::radian,
                  .range = turn_range})
          .field("tilt", &CameraStartConfig::tilt,
                 {.meaning = "Tilt angle, positive upwards.", .unit = Unit::radian, .range = turn_range})
          .field("zoom", &CameraStartConfig::zoom,
                 {.meaning = "Zoom ratio, or motor position if the lens table has counts.",
                  .range = {.min = -1e9, .max = 1e9},
                  .default_text = "the lower limit"})
          .field("stage", &CameraStartConfig::stage,
                 {.meaning = "Stage position: right, down, forward.",
                  .unit = Unit::metre,
                  .range = between(-1e3, 1e3)});
  return table;
}

const Table<CameraConfig>& fields_of(const CameraConfig*) {
  static const auto table =
      Table<CameraConfig>("camera", "A camera on a pan/tilt/zoom head.")
          .field("name", &CameraConfig::name,
                 {.meaning = "Name of the camera in tasks and files: letters, digits, -, _, spaces and "
                             "points, not beginning with a point.",
                  .required = true})
          .field("mount", &CameraConfig::mount,
                 {.meaning = "Position and orientation of the head.", .required = true})
          .field("head", &CameraConfig::head, {.meaning = "Pan/tilt/zoom head."})
          .field("lens", &CameraConfig::lens, {.meaning = "Lens."})
          .field("sensor", &CameraConfig::sensor, {.meaning = "Sensor."})
          .field("initial", &CameraConfig::initial, {.meaning = "Axis positions at the start of the run."})
          .check([](const CameraConfig& camera, Reader& reader) {
            check_name(camera.name, reader);
            check_camera(camera, reader);
          });
  return table;
}

void check_cameras(const std::vector<CameraConfig>& cameras, const std::string& path, Reader& reader) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (names.insert(cameras[i].name).second) continue;
    reader.problem_at(fmt::format("{}[{}].name", path, i),
                      fmt::format("\"{}\" is the name of another camera", cameras[i].name));
  }
}

std::vector<CameraConfig> cameras_at(const std::array<double, 2>& distances,
                                     const std::array<double, 3>& center) {
  std::vector<CameraConfig> cameras(2);
  const std::array<const char*, 2> names = {"front", "side"};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::isfinite(distances[i]) || distances[i] <= 0)
      throw std::invalid_argument("a camera's distance must be a positive number");
    cameras[i].name = names[i];
    cameras[i].mount.position = center;
    cameras[i].mount.look_at = center;
  }
  cameras[0].mount.position[2] += distances[0];
  cameras[1].mount.position[0] -= distances[1];
  return cameras;
}

std::vector<CameraConfig> default_cameras(double reach, const std::array<double, 3>& center) {
  const CameraConfig camera;
  // The edge of the sphere is seen at the angle asin(reach / distance) from the optical axis.
  const double half_size = 0.5 * static_cast<double>(std::min(camera.sensor.width, camera.sensor.height));
  constexpr double margin = 0.95;
  const double distance = reach * std::hypot(camera.lens.fx, margin * half_size) / (margin * half_size);
  return cameras_at({distance, distance}, center);
}

LensConfig spelled_out(const CameraConfig& camera) {
  const ZoomTable table(camera.lens, camera.sensor.width, camera.sensor.height);
  LensConfig lens = camera.lens;
  lens.fy = lens.fy.value_or(lens.fx);
  lens.cx = lens.cx.value_or(0.5 * static_cast<double>(camera.sensor.width - 1));
  lens.cy = lens.cy.value_or(0.5 * static_cast<double>(camera.sensor.height - 1));
  lens.distortion = distortion_of(lens.model, lens.distortion);
  for (ZoomRow& row : lens.zoom) {
    const Intrinsics there = table.at(row.count.value_or(row.ratio));
    row.fx = there.fx, row.fy = there.fy, row.cx = there.cx, row.cy = there.cy;
    row.distortion = there.distortion;
  }
  return lens;
}

CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by) {
  camera.lens = spelled_out(camera);
  *camera.lens.cx += by.x(), *camera.lens.cy += by.y();
  for (ZoomRow& row : camera.lens.zoom) *row.cx += by.x(), *row.cy += by.y();
  return camera;
}

}  // namespace flexura
