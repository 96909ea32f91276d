#include "flexura/study/study_config.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

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
      {"pan", &V::pan, Unit::radian, turn_range, "The head's pan, to the camera's left."},
      {"tilt", &V::tilt, Unit::radian, turn_range, "The head's tilt, upwards."},
      {"roll", &V::roll, Unit::radian, turn_range,
       "A turn of the camera about its optical axis, beside what it has; clockwise seen from behind it."},
      {"orbit", &V::orbit, Unit::radian, turn_range,
       "The camera rises around the target's horizontal axis and looks at its centre: the paper's tilt, seen "
       "as the plane tilting its top towards the camera. At 0 it is where it stands."},
      {"distance",
       &V::distance,
       Unit::metre,
       {.min = 1e-6, .max = 1e6},
       "The camera's distance from the target's centre, along the line on which it stands; it keeps its "
       "orientation."},
      {"mount_x", &V::mount_x, Unit::metre, place_range,
       "The mount's position along X; the camera keeps its orientation."},
      {"mount_y", &V::mount_y, Unit::metre, place_range, "The same along Y."},
      {"mount_z", &V::mount_z, Unit::metre, place_range, "The same along Z."},
      {"zoom", &V::zoom, Unit::none, {.min = -1e9, .max = 1e9}, "The zoom: a ratio or a motor count."},
      {"stage_x", &V::stage_x, Unit::metre, slide_range, "The stage's offset to the right."},
      {"stage_y", &V::stage_y, Unit::metre, slide_range, "The stage's offset downwards."},
      {"stage_z", &V::stage_z, Unit::metre, slide_range, "The stage's offset forwards."},
      {"focal_length", &V::focal_length, Unit::none, focal_length_range,
       "The focal length in px as the zoom stands; fy keeps its proportion to fx."},
      {"fx", &V::fx, Unit::none, focal_length_range, "The horizontal focal length alone, px."},
      {"fy", &V::fy, Unit::none, focal_length_range, "The vertical focal length alone, px."},
      {"cx", &V::cx, Unit::none, principal_point_range, "The principal point's column, px."},
      {"cy", &V::cy, Unit::none, principal_point_range, "The principal point's row, px."},
      {"k1", &V::k1, Unit::none, distortion_range, "Radial distortion, by the second power of the radius."},
      {"k2", &V::k2, Unit::none, distortion_range, "Radial distortion, by the fourth power."},
      {"p1", &V::p1, Unit::none, distortion_range, "Tangential distortion, vertical."},
      {"p2", &V::p2, Unit::none, distortion_range, "Tangential distortion, horizontal."},
      {"k3", &V::k3, Unit::none, distortion_range, "Radial distortion, by the sixth power."},
      {"tilt_axis_x", &V::tilt_axis_x, Unit::metre, slide_range, "The tilt axis, right of the pan axis."},
      {"tilt_axis_y", &V::tilt_axis_y, Unit::metre, slide_range, "The tilt axis, below the mount's origin."},
      {"tilt_axis_z", &V::tilt_axis_z, Unit::metre, slide_range, "The tilt axis, before the pan axis."},
      {"pupil_x", &V::pupil_x, Unit::metre, slide_range, "The entrance pupil, right of the tilt axis."},
      {"pupil_y", &V::pupil_y, Unit::metre, slide_range, "The entrance pupil, below the tilt axis."},
      {"pupil_z", &V::pupil_z, Unit::metre, slide_range, "The entrance pupil, before the tilt axis."},
      {"pupil_shift", &V::pupil_shift, Unit::metre, slide_range,
       "How far the entrance pupil moves forward for each 1 of zoom ratio."}};
  return all;
}

void check_values(const Variation& variation, const Camera& camera, const std::string& path, Reader& reader) {
  if (variation.values[0] == variation.values[1])
    reader.problem_at(path, "has the same value twice: expected a first and a last one");
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
    Table<VaryConfig> made("vary",
                           "What is varied: one of these parameters of the camera, as [first, last].");
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
                               "A circle, and in it the square whose edges are level and upright: in the "
                               "XOY plane parallel to OX and OY.")
          .field("center", &StudyTargetConfig::center,
                 {.meaning = "Its centre.", .unit = Unit::metre, .range = between(-1e6, 1e6)})
          .field("normal", &StudyTargetConfig::normal,
                 {.meaning = "The way its plane faces; of any length but 0.", .range = between(-1e6, 1e6)})
          .field("radius", &StudyTargetConfig::radius,
                 {.meaning = "The circle's radius.", .unit = Unit::metre, .range = between(1e-6, 1e6)})
          .check([](const StudyTargetConfig& target, Reader& reader) {
            if (!(Eigen::Vector3d(target.normal.data()).stableNorm() > 1e-100))
              reader.problem_at("normal", "has no direction: expected a length above 0");
          });
  return table;
}

const Table<StudyTask>& fields_of(const StudyTask*) {
  static const auto table =
      Table<StudyTask>("study",
                       "How the image of a target changes when one of a camera's parameters is varied: "
                       "distances in the image as tables and plots. The arm stays as it is, and no time "
                       "passes.")
          .field("name", &StudyTask::name,
                 {.meaning = "What to call the task, its table and its figures.", .default_text = "its kind"})
          .field("camera", &StudyTask::camera,
                 {.meaning = "The camera's name.", .default_text = "the first camera"})
          .field("vary", &StudyTask::vary,
                 {.meaning = "What is varied, as `vary.orbit_deg = [-60, 60]`.", .required = true})
          .field(
              "points", &StudyTask::points,
              {.meaning = "Number of values, evenly from the first to the last.", .range = between(2, 10000)})
          .field(
              "measure", &StudyTask::measure,
              {.meaning = "Also in pictures of the square, found and measured as a camera's: a third column. "
                          "Takes a tenth of a second a value."})
          .field("target", &StudyTask::target, {.meaning = "What the camera looks at."});
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
    reader.problem_at(path + ".vary", "names no parameter: expected one, such as orbit_deg = [-60, 60]");
    return;
  }
  for (std::size_t i = 1; i < varied.size(); ++i) {
    reader.problem_at(fmt::format("{}.vary.{}", path, varied[i].name),
                      fmt::format("stands beside vary.{}: expected one parameter", varied[0].name));
  }
  if (varied.size() > 1) return;
  const CameraConfig* config = camera_of(task, cameras);
  if (config == nullptr) {
    reader.problem_at(path + ".camera", fmt::format("there is no camera \"{}\": expected one of {}",
                                                    task.camera, camera_names(cameras)));
    return;
  }
  const Camera camera(*config);
  check_values(varied.front(), camera, fmt::format("{}.vary.{}", path, varied.front().name), reader);
  const Eigen::Vector3d eye = camera.pose(camera.initial_stance()).position;
  const bool needs_distance =
      varied.front().parameter == &VaryConfig::orbit || varied.front().parameter == &VaryConfig::distance;
  if (needs_distance && eye == Eigen::Vector3d(task.target.center.data())) {
    reader.problem_at(path + ".target.center",
                      "is where the camera stands: it cannot orbit there, nor move away from it");
  }
}

}  // namespace flexura
