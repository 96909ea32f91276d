#include "flexura/study/study_config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/camera/camera.h"
#include "flexura/camera/lens_ranges.h"
#include "flexura/study/study_view.h"

namespace flexura {
namespace {

constexpr NumberRange turn_range = {.min = -10, .max = 10};
constexpr NumberRange slide_range = {.min = -1e3, .max = 1e3};
constexpr NumberRange place_range = {.min = -1e6, .max = 1e6};

struct Parameter {
  const char* name;
  VaryConfig::Values VaryConfig::* member;
  Unit unit;
  NumberRange range;
  const char* meaning;
};

const std::vector<Parameter>& parameters() {
  using V = VaryConfig;
  static const std::vector<Parameter> all{
      {"pan", &V::pan, Unit::radian, turn_range, "Pan angle of the head, positive to the camera's left."},
      {"tilt", &V::tilt, Unit::radian, turn_range, "Tilt angle of the head, positive upwards."},
      {"roll", &V::roll, Unit::radian, turn_range,
       "Additional rotation of the camera about its optical axis, clockwise seen from behind."},
      {"orbit", &V::orbit, Unit::radian, turn_range,
       "Rotation of the camera upwards about the target's horizontal axis, with the camera looking at the "
       "target's centre: the paper's tilt. At 0, the camera is at its initial pose."},
      {"distance",
       &V::distance,
       Unit::metre,
       {.min = 1e-6, .max = 1e6},
       "Distance of the camera from the target's centre. The direction from the target to the camera and the "
       "orientation of the camera are constant."},
      {"mount_x", &V::mount_x, Unit::metre, place_range,
       "Position of the mount along X, at constant orientation."},
      {"mount_y", &V::mount_y, Unit::metre, place_range,
       "Position of the mount along Y, at constant orientation."},
      {"mount_z", &V::mount_z, Unit::metre, place_range,
       "Position of the mount along Z, at constant orientation."},
      {"zoom",
       &V::zoom,
       Unit::none,
       {.min = -1e9, .max = 1e9},
       "Zoom ratio, or motor position if the lens table has counts."},
      {"stage_x", &V::stage_x, Unit::metre, slide_range, "Stage position to the right."},
      {"stage_y", &V::stage_y, Unit::metre, slide_range, "Stage position downwards."},
      {"stage_z", &V::stage_z, Unit::metre, slide_range, "Stage position forwards."},
      {"focal_length", &V::focal_length, Unit::none, focal_length_range,
       "Focal length fx at the current zoom, px. The ratio fy/fx is constant."},
      {"fx", &V::fx, Unit::none, focal_length_range,
       "Horizontal focal length, px. The vertical focal length is constant."},
      {"fy", &V::fy, Unit::none, focal_length_range,
       "Vertical focal length, px. The horizontal focal length is constant."},
      {"cx", &V::cx, Unit::none, principal_point_range, "Column of the principal point, px."},
      {"cy", &V::cy, Unit::none, principal_point_range, "Row of the principal point, px."},
      {"k1", &V::k1, Unit::none, distortion_range, "Coefficient k1 of the lens model (docs/cameras.md)."},
      {"k2", &V::k2, Unit::none, distortion_range, "Coefficient k2 of the lens model."},
      {"p1", &V::p1, Unit::none, distortion_range, "Coefficient of vertical tangential distortion."},
      {"p2", &V::p2, Unit::none, distortion_range, "Coefficient of horizontal tangential distortion."},
      {"k3", &V::k3, Unit::none, distortion_range, "Coefficient k3 of the lens model."},
      {"k4", &V::k4, Unit::none, distortion_range, "Coefficient k4 of the lens model."},
      {"k5", &V::k5, Unit::none, distortion_range, "Coefficient k5 of the lens model."},
      {"k6", &V::k6, Unit::none, distortion_range, "Coefficient k6 of the lens model."},
      {"tilt_axis_x", &V::tilt_axis_x, Unit::metre, slide_range,
       "Distance of the tilt axis to the right of the pan axis."},
      {"tilt_axis_y", &V::tilt_axis_y, Unit::metre, slide_range,
       "Distance of the tilt axis below the mount's origin."},
      {"tilt_axis_z", &V::tilt_axis_z, Unit::metre, slide_range,
       "Distance of the tilt axis in front of the pan axis."},
      {"pupil_x", &V::pupil_x, Unit::metre, slide_range,
       "Distance of the entrance pupil to the right of `tilt_axis`."},
      {"pupil_y", &V::pupil_y, Unit::metre, slide_range,
       "Distance of the entrance pupil below the tilt axis."},
      {"pupil_z", &V::pupil_z, Unit::metre, slide_range,
       "Distance of the entrance pupil in front of the tilt axis."},
      {"pupil_shift", &V::pupil_shift, Unit::metre, slide_range,
       "Forward shift of the entrance pupil per unit of zoom ratio."}};
  return all;
}

void check_values(const Variation& variation, const Camera& camera, const std::string& path, Reader& reader) {
  if (variation.values[0] == variation.values[1])
    reader.problem_at(path, "has two equal values: expected different first and last values");
  const AxisConfig* axis = moved_axis(camera, variation.parameter);
  if (axis == nullptr) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const double value = variation.values[i];
    if (value >= axis->limits[0] && value <= axis->limits[1]) continue;
    reader.problem_at(fmt::format("{}[{}]", path, i),
                      fmt::format("{:.6g} is outside the axis's limits {:.6g} to {:.6g}", value,
                                  axis->limits[0], axis->limits[1]));
  }
}

std::string camera_names(const std::vector<CameraConfig>& cameras) {
  std::string names;
  for (const CameraConfig& camera : cameras)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", camera.name);
  return names;
}

}  // namespace

const Table<VaryConfig>& fields_of(const VaryConfig*) {
  static const auto table = [] {
    Table<VaryConfig> made(
        "vary", "Varied parameter of the camera. Exactly one of these keys has a value [first, last].");
    for (const Parameter& one : parameters())
      made.field(
          one.name, one.member,
          {.meaning = one.meaning, .unit = one.unit, .range = one.range, .default_text = "not varied"});
    return made;
  }();
  return table;
}

const Table<StudyTargetConfig>& fields_of(const StudyTargetConfig*) {
  static const auto table =
      Table<StudyTargetConfig>("target",
                               "A circle and its inscribed square, whose edges are horizontal and vertical. "
                               "In the XOY plane the edges are parallel to OX and OY.")
          .field("center", &StudyTargetConfig::center,
                 {.meaning = "Centre.", .unit = Unit::metre, .range = between(-1e6, 1e6)})
          .field("normal", &StudyTargetConfig::normal,
                 {.meaning = "Normal of the target's plane. The length of the normal must be above 0.",
                  .range = between(-1e6, 1e6)})
          .field("radius", &StudyTargetConfig::radius,
                 {.meaning = "Radius of the circle.", .unit = Unit::metre, .range = between(1e-6, 1e6)})
          .check([](const StudyTargetConfig& target, Reader& reader) {
            if (!(Eigen::Vector3d(target.normal.data()).stableNorm() > 1e-100))
              reader.problem_at("normal", "has no direction: expected a length above 0");
          });
  return table;
}

const Table<StudyTask>& fields_of(const StudyTask*) {
  static const auto table =
      Table<StudyTask>("study",
                       "Computes distances in the image of a target while one camera parameter varies. "
                       "Results are tables and plots. The arm keeps its shape, and no time passes.")
          .field("name", &StudyTask::name,
                 {.meaning = "Name of the task in results.", .default_text = "its kind"})
          .field("camera", &StudyTask::camera,
                 {.meaning = "Name of the camera.", .default_text = "the first camera"})
          .field("vary", &StudyTask::vary,
                 {.meaning = "Varied parameter, as `vary.orbit_deg = [-60, 60]`.", .required = true})
          .field("points", &StudyTask::points,
                 {.meaning = "Number of values of the varied parameter, equally spaced from the first to the "
                             "last value.",
                  .range = between(2, 10000)})
          .field("measure", &StudyTask::measure,
                 {.meaning =
                      "Whether the target's square is also rendered and measured in pictures. The "
                      "result is a third column. The measurement takes 0.1 s of computing time per value."})
          .field("target", &StudyTask::target, {.meaning = "Target that the camera sees."});
  return table;
}

std::vector<Variation> variations(const VaryConfig& vary) {
  std::vector<Variation> found;
  for (const Parameter& one : parameters())
    if (vary.*one.member) found.push_back({one.name, one.unit, one.member, *(vary.*one.member)});
  return found;
}

const CameraConfig* camera_of(const StudyTask& task, const std::vector<CameraConfig>& cameras) {
  if (task.camera.empty()) return cameras.empty() ? nullptr : &cameras.front();
  const auto found = std::ranges::find(cameras, task.camera, &CameraConfig::name);
  return found == cameras.end() ? nullptr : &*found;
}

void check_study(const StudyTask& task, const std::vector<CameraConfig>& cameras, const std::string& path,
                 Reader& reader) {
  const std::vector<Variation> varied = variations(task.vary);
  if (varied.empty()) {
    reader.problem_at(path + ".vary",
                      "has no parameter: expected one parameter, such as orbit_deg = [-60, 60]");
    return;
  }
  for (std::size_t i = 1; i < varied.size(); ++i) {
    reader.problem_at(fmt::format("{}.vary.{}", path, varied[i].name),
                      fmt::format("is given together with vary.{}: expected one parameter", varied[0].name));
  }
  if (varied.size() > 1) return;
  const CameraConfig* config = camera_of(task, cameras);
  if (config == nullptr) {
    reader.problem_at(path + ".camera", fmt::format("there is no camera \"{}\": expected one of {}",
                                                    task.camera, camera_names(cameras)));
    return;
  }
  constexpr std::array<std::string_view, 8> coefficients = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  const std::vector<std::string>& names = coefficient_names(config->lens.model);
  if (std::ranges::count(coefficients, varied[0].name) > 0 &&
      std::ranges::count(names, varied[0].name) == 0) {
    reader.problem_at(fmt::format("{}.vary.{}", path, varied[0].name),
                      fmt::format("is no coefficient of the lens model {}: expected one of {}",
                                  name_of(config->lens.model), fmt::join(names, ", ")));
    return;
  }
  const Camera camera(*config);
  check_values(varied.front(), camera, fmt::format("{}.vary.{}", path, varied.front().name), reader);
  const Eigen::Vector3d eye = camera.pose(camera.initial_stance()).position;
  const bool needs_distance =
      varied.front().parameter == &VaryConfig::orbit || varied.front().parameter == &VaryConfig::distance;
  if (needs_distance && eye == Eigen::Vector3d(task.target.center.data())) {
    reader.problem_at(path + ".target.center",
                      "is the camera's position: the camera cannot orbit this point or move away from it");
  }
}

}  // namespace flexura
