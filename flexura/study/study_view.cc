#include "flexura/study/study_view.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/math/so3.h"

namespace flexura {
namespace {

using VariedList = VaryConfig::Values VaryConfig::*;
using V = VaryConfig;

constexpr std::array<VariedList, 3> head_parameters{&V::pan, &V::tilt, &V::zoom};
constexpr std::array<VariedList, 3> stage_parameters{&V::stage_x, &V::stage_y, &V::stage_z};
constexpr std::array<VariedList, 3> mount_parameters{&V::mount_x, &V::mount_y, &V::mount_z};
constexpr std::array<VariedList, 3> tilt_axis_parameters{&V::tilt_axis_x, &V::tilt_axis_y, &V::tilt_axis_z};
constexpr std::array<VariedList, 3> pupil_parameters{&V::pupil_x, &V::pupil_y, &V::pupil_z};
constexpr std::array<VariedList, 8> distortion_parameters{&V::k1, &V::k2, &V::p1, &V::p2,
                                                          &V::k3, &V::k4, &V::k5, &V::k6};
constexpr std::array<std::string_view, 8> distortion_names{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};

// Returns the index of a parameter in a list; the list's size if it is missing.
template <std::size_t n>
std::size_t place_in(const std::array<VariedList, n>& list, VariedList parameter) {
  std::size_t i = 0;
  while (i < n && list[i] != parameter) ++i;
  return i;
}

Intrinsics with(Intrinsics lens, VariedList parameter, double value) {
  if (const std::size_t k = place_in(distortion_parameters, parameter); k < distortion_parameters.size()) {
    const std::vector<std::string>& names = coefficient_names(lens.distortion.model());
    const auto at = static_cast<std::size_t>(std::ranges::find(names, distortion_names[k]) - names.begin());
    if (at < names.size()) lens.distortion[at] = value;
  }
  if (parameter == &V::focal_length) lens.fy *= value / lens.fx;
  if (parameter == &V::focal_length || parameter == &V::fx) lens.fx = value;
  if (parameter == &V::fy) lens.fy = value;
  if (parameter == &V::cx) lens.cx = value;
  if (parameter == &V::cy) lens.cy = value;
  return lens;
}

// Returns the camera with one of its fixed offsets changed and its orientation kept.
CameraConfig with_offset(CameraConfig config, VariedList parameter, double value) {
  if (const std::size_t i = place_in(tilt_axis_parameters, parameter); i < 3)
    config.head.tilt_axis[i] = value;
  if (const std::size_t i = place_in(pupil_parameters, parameter); i < 3) config.head.pupil[i] = value;
  if (parameter == &V::pupil_shift) config.head.pupil_shift = value;
  return config;
}

// Returns the camera moved to a distance from the target's centre, along the line through camera and centre.
Pose at_distance(Pose X_WC, const StudyTarget& target, double distance) {
  const Eigen::Vector3d way = X_WC.position - target.center();
  if (!(way.norm() > 0)) throw std::invalid_argument("a camera cannot move away from its own position");
  X_WC.position = target.center() + distance * way.stableNormalized();
  return X_WC;
}

// Returns the camera rotated to look at the target's centre by the shortest rotation, and then rotated about
// the target's horizontal axis.
Pose orbited(const Pose& X_WC, const StudyTarget& target, double angle) {
  const Eigen::Vector3d way = target.center() - X_WC.position;
  if (!(way.norm() > 0)) throw std::invalid_argument("a camera cannot orbit its own position");
  const Eigen::Matrix3d R_aim = X_WC.rotation * rotation_from_z(X_WC.rotation.transpose() * way);
  const Eigen::Matrix3d R_rise = so3_exp(-angle * target.level_axis());
  return {R_rise * R_aim, target.center() - R_rise * way};
}

}  // namespace

View view_with(const Camera& camera, VariedList parameter, double value, const StudyTarget& target) {
  auto [head, stage] = camera.initial_stance();
  if (parameter == &V::pan) head.pan = value;
  if (parameter == &V::tilt) head.tilt = value;
  if (parameter == &V::zoom) head.zoom = value;
  const std::size_t slide = place_in(stage_parameters, parameter);
  if (slide < stage_parameters.size()) stage.offset[static_cast<Eigen::Index>(slide)] = value;

  View view = Camera(with_offset(camera.config(), parameter, value)).view({head, stage});
  if (const std::size_t i = place_in(mount_parameters, parameter); i < 3) {
    const auto axis = static_cast<Eigen::Index>(i);
    view.X_WC.position[axis] += value - camera.mount().position[axis];
  }
  if (parameter == &V::distance) view.X_WC = at_distance(view.X_WC, target, value);
  if (parameter == &V::roll) view.X_WC.rotation *= so3_exp({0, 0, value});
  if (parameter == &V::orbit) view.X_WC = orbited(view.X_WC, target, value);
  view.lens = Lens(with(view.lens.intrinsics(), parameter, value));
  return view;
}

const AxisConfig* moved_axis(const Camera& camera, VariedList parameter) {
  if (const std::size_t i = place_in(head_parameters, parameter); i < 3) return &camera.head_axes()[i];
  if (const std::size_t i = place_in(stage_parameters, parameter); i < 3) return &camera.stage_axes()[i];
  return nullptr;
}

}  // namespace flexura
