#include "flexura/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"

namespace flexura {

CameraStance interpolate(const CameraStance& from, const CameraStance& to, double fraction) {
  const auto mixed = [fraction](double a, double b) { return a + fraction * (b - a); };
  CameraStance between;
  between.head = {mixed(from.head.pan, to.head.pan), mixed(from.head.tilt, to.head.tilt),
                  mixed(from.head.zoom, to.head.zoom)};
  between.stage.offset = from.stage.offset + fraction * (to.stage.offset - from.stage.offset);
  return between;
}

Camera::Camera(const CameraConfig& config)
    : config_(config),
      lens_(config.lens, config.sensor.width, config.sensor.height),
      X_WM_(config.mount.pose()),
      head_axes_{static_cast<const AxisConfig&>(config.head.pan),
                 static_cast<const AxisConfig&>(config.head.tilt), config.head.zoom.axis(lens_)},
      stage_axes_{config.mount.stage.x, config.mount.stage.y, config.mount.stage.z} {}

HeadState Camera::initial_head() const {
  const CameraStartConfig& start = config_.initial;
  return {start.pan, start.tilt, start.zoom.value_or(head_axes_[2].limits[0])};
}

StageState Camera::initial_stage() const { return {vector(config_.initial.stage)}; }

HeadGeometry Camera::geometry(double zoom) const {
  const double forward = config_.head.pupil_shift * (lens_.ratio(zoom) - 1);
  return {vector(config_.head.tilt_axis), vector(config_.head.pupil) + Eigen::Vector3d(0, 0, forward)};
}

std::array<double, 2> Camera::angles(const HeadState& head) const {
  return {head.pan + config_.head.pan.zero, head.tilt + config_.head.tilt.zero};
}

Pose Camera::pose(const CameraStance& stance) const {
  const auto& [head, stage] = stance;
  const auto [pan, tilt] = angles(head);
  return X_WM_ * Pose{Eigen::Matrix3d::Identity(), stage.offset} * head_pose(geometry(head.zoom), pan, tilt);
}

HeadState Camera::looking_along(const Eigen::Vector3d& direction, double zoom) const {
  const Eigen::Vector3d u = (X_WM_.rotation.transpose() * direction).normalized();
  // Among pan angles that differ by full turns, the angle nearest to the middle of the pan limits.
  const auto& [least, most] = config_.head.pan.limits;
  const double middle = 0.5 * (least + most), pan = std::atan2(-u.x(), u.z()) - config_.head.pan.zero;
  return {middle + std::remainder(pan - middle, 2 * std::numbers::pi),
          std::asin(std::clamp(-u.y(), -1.0, 1.0)) - config_.head.tilt.zero, zoom};
}

View Camera::view(const CameraStance& stance) const {
  return {Lens(lens_.at(stance.head.zoom)), pose(stance), static_cast<int>(config_.sensor.width),
          static_cast<int>(config_.sensor.height)};
}

std::optional<CameraProjection> Camera::project(const Eigen::Vector3d& p_WP,
                                                const CameraStance& stance) const {
  const auto& [head, stage] = stance;
  const HeadGeometry axes = geometry(head.zoom);
  const auto [pan, tilt] = angles(head);
  const Eigen::Matrix3d R_PM = pan_rotation(pan).transpose();  // P: the panned frame
  const Eigen::Matrix3d R_CP = tilt_rotation(tilt).transpose();
  const Eigen::Matrix3d R_CM = R_CP * R_PM, R_CW = R_CM * X_WM_.rotation.transpose();
  const Eigen::Vector3d from_mount = p_WP - X_WM_.position;
  const Eigen::Vector3d panned = R_PM * (X_WM_.rotation.transpose() * from_mount - stage.offset);
  const Eigen::Vector3d tilted = R_CP * (panned - axes.tilt_axis);
  const auto in_camera = Lens(lens_.at(head.zoom)).project_with_derivatives(tilted - axes.pupil);
  if (!in_camera) return std::nullopt;

  CameraProjection result;
  const Eigen::Matrix<double, 2, 3>& by_C = in_camera->by_point;
  result.pixel = in_camera->pixel;
  result.by_point = by_C * R_CW;
  result.by_mount << -result.by_point, result.by_point * skew(from_mount);
  result.by_stage = -by_C * R_CM;
  // The point rotates opposite to the camera: d/dpan about P's -y, d/dtilt about C's x.
  result.by_pan = by_C * (R_CP * Eigen::Vector3d::UnitY().cross(panned));
  result.by_tilt = -by_C * Eigen::Vector3d::UnitX().cross(tilted);
  result.by_tilt_axis = -by_C * R_CP;
  result.by_pupil = -by_C;
  result.by_pupil_shift = -by_C.col(2) * (lens_.ratio(head.zoom) - 1);
  result.by_intrinsics = in_camera->by_intrinsics;
  result.by_lens = in_camera->by_intrinsics * lens_.by_lens(head.zoom).asDiagonal();
  result.by_zoom = in_camera->by_intrinsics * lens_.slope(head.zoom) -
                   by_C.col(2) * (config_.head.pupil_shift * lens_.ratio_slope(head.zoom));
  return result;
}

}  // namespace flexura
