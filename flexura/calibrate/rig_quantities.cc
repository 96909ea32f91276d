#include "flexura/calibrate/rig_quantities.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/camera/camera.h"
#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Accumulates the derivatives of an axis: each slot rotates the camera about an axis through a point, or
// shifts it.
class AxisMotion3 {
 public:
  AxisMotion3(const RigVariables& variables, OpticalAxis& axis) : variables_(variables), axis_(axis) {
    axis_.pupil_by_x.setZero(3, variables.count());
    axis_.direction_by_x.setZero(3, variables.count());
    axis_.log_focal_by_x.setZero(variables.count());
  }
  void turn(std::size_t slot, const Eigen::Vector3d& about, const Eigen::Vector3d& through) {
    const Eigen::Index column = variables_.column(slot);
    if (column < 0) return;
    axis_.direction_by_x.col(column) += about.cross(axis_.direction);
    axis_.pupil_by_x.col(column) += about.cross(axis_.pupil - through);
  }
  void shift(std::size_t slot, const Eigen::Vector3d& way) {
    const Eigen::Index column = variables_.column(slot);
    if (column >= 0) axis_.pupil_by_x.col(column) += way;
  }
  void shift3(std::size_t slot, const Eigen::Matrix3d& ways) {
    for (Eigen::Index i = 0; i < 3; ++i) shift(slot + static_cast<std::size_t>(i), ways.col(i));
  }
  void focal(std::size_t slot, double slope) {
    const Eigen::Index column = variables_.column(slot);
    if (column >= 0) axis_.log_focal_by_x[column] += slope;
  }

 private:
  const RigVariables& variables_;
  OpticalAxis& axis_;
};

// Adds the derivatives of log sqrt(fx fy).
void add_focal(const CameraConfig& model, const ZoomTable& lens, double zoom, std::size_t camera_slots,
               AxisMotion3& motion) {
  const Intrinsics now = lens.at(zoom);
  motion.focal(camera_slots + focal_slot, 1);
  motion.focal(camera_slots + aspect_slot, 0.5);
  for (std::size_t i = 0; i < model.lens.zoom.size(); ++i) {
    const ZoomRow& row = model.lens.zoom[i];
    const auto by_row = lens.by_row(zoom, i);
    motion.focal(camera_slots + zoom_row_slot + i,
                 0.5 * (by_row[0] * *row.fx / now.fx + by_row[1] * *row.fy / now.fy));
  }
}

}  // namespace

double RigQuantity::sigma(const Eigen::MatrixXd& covariance) const {
  return std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
}

AskedStance observed_stance(const RigVariables& variables, std::size_t stance) {
  return {variables.read().at(stance), stance};
}

OpticalAxis optical_axis(const RigVariables& variables, const Eigen::VectorXd& x, const AskedStance& stance) {
  RigStance where = stance.observed ? variables.stance(x, *stance.observed) : stance.where;
  const CameraConfig model = variables.model(x).cameras.at(where.camera);
  const Camera camera(model);
  const Pose X_WC = camera.pose(where.stance());
  const Intrinsics lens = camera.lens().at(where.head.zoom);
  OpticalAxis axis{
      X_WC.rotation, X_WC.position, X_WC.rotation.col(2), {}, {}, std::sqrt(lens.fx * lens.fy), {}};

  AxisMotion3 motion(variables, axis);
  const std::size_t first = variables.camera_slots(where.camera);
  const Pose& X_WM = camera.mount();
  const Eigen::Vector3d foot = X_WM * where.stage.offset;  // On the pan axis.
  const Eigen::Matrix3d R_WP = X_WM.rotation * pan_rotation(camera.angles(where.head)[0]);
  const Eigen::Vector3d tilt_axis = foot + R_WP * vector(model.head.tilt_axis);
  const Eigen::Matrix3d turns = so3_left_jacobian(variables.value3(x, first + mount_rotation_slot));
  motion.shift3(first + mount_position_slot, Eigen::Matrix3d::Identity());
  for (std::size_t i = 0; i < 3; ++i)
    motion.turn(first + mount_rotation_slot + i, turns.col(static_cast<Eigen::Index>(i)), X_WM.position);
  motion.turn(first + pan_zero_slot, -X_WM.rotation.col(1), foot);
  motion.turn(first + tilt_zero_slot, R_WP.col(0), tilt_axis);
  motion.shift3(first + tilt_axis_slot, R_WP);
  motion.shift3(first + pupil_slot, X_WC.rotation);
  motion.shift(first + pupil_shift_slot, (camera.lens().ratio(where.head.zoom) - 1) * axis.direction);
  add_focal(model, camera.lens(), where.head.zoom, first, motion);
  if (!stance.observed) return axis;
  const std::size_t own = variables.stance_slots_of(*stance.observed);
  motion.turn(own, -X_WM.rotation.col(1), foot);
  motion.turn(own + 1, R_WP.col(0), tilt_axis);
  motion.shift(own + 2, model.head.pupil_shift * camera.lens().ratio_slope(where.head.zoom) * axis.direction);
  const auto slope = camera.lens().slope(where.head.zoom);
  motion.focal(own + 2, 0.5 * (slope[0] / lens.fx + slope[1] / lens.fy));
  motion.shift3(own + 3, X_WM.rotation);
  return axis;
}

RigQuantity axes_angle(const OpticalAxis& a, const OpticalAxis& b) {
  const double cosine = a.direction.dot(b.direction), sine = a.direction.cross(b.direction).norm();
  // For parallel axes the angle has no derivative; use 0.
  const double slope = sine > 0 ? -1 / sine : 0;
  return {"angle between the axes", std::atan2(sine, cosine),
          slope * (a.direction_by_x.transpose() * b.direction + b.direction_by_x.transpose() * a.direction)};
}

std::array<RigQuantity, 2> aim_errors(const OpticalAxis& axis, const Eigen::Vector3d& p_WP) {
  const double depth = axis.direction.dot(p_WP - axis.pupil);
  const Eigen::Vector3d off = axis.pupil + depth * axis.direction - p_WP;
  const auto along = [&](const char* name, const Eigen::Vector3d& way) -> RigQuantity {
    return {name, way.dot(off),
            axis.pupil_by_x.transpose() * way + depth * (axis.direction_by_x.transpose() * way)};
  };
  return {along("aim, right", axis.R_WC.col(0)), along("aim, down", axis.R_WC.col(1))};
}

RigQuantity log_zoom_ratio(const OpticalAxis& a, const OpticalAxis& b, const Eigen::Vector3d& p_WP) {
  const auto scale = [&](const OpticalAxis& axis) -> RigQuantity {
    const Eigen::Vector3d way = p_WP - axis.pupil;
    const double depth = axis.direction.dot(way);
    const Eigen::VectorXd by_depth =
        axis.direction_by_x.transpose() * way - axis.pupil_by_x.transpose() * axis.direction;
    return {"", std::log(axis.focal / depth), axis.log_focal_by_x.transpose() - by_depth / depth};
  };
  const RigQuantity left = scale(a), right = scale(b);
  return {"zoom ratio", left.value - right.value, left.gradient - right.gradient};
}

RigQuantity log_focal(const OpticalAxis& axis) {
  return {"focal length", std::log(axis.focal), axis.log_focal_by_x.transpose()};
}

}  // namespace flexura
