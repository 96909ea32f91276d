#include "flexura/calibrate/rig_variables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "flexura/camera/camera.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/arrays.h"
#include "flexura/math/pose.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

constexpr std::array<const char*, 3> directions = {"x", "y", "z"};

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

void check_observations(const RigModel& guess, const RigObservations& seen) {
  for (const ArmState& pose : seen.poses)
    require(pose.bends.size() == guess.sections() && pose.stretches.size() == pose.bends.size(),
            fmt::format("a pose of {} bends does not fit an arm of {} sections", pose.bends.size(),
                        guess.sections()));
  for (std::size_t i = 0; i < seen.stances.size(); ++i) {
    const RigStance& stance = seen.stances[i];
    require(stance.camera < guess.cameras.size(),
            fmt::format("a stance refers to camera {}, but there are only {} cameras", stance.camera,
                        guess.cameras.size()));
    const std::size_t before = stance.turned_as.value_or(i);
    require(!stance.turned_as || (before < i && seen.stances[before].camera == stance.camera),
            fmt::format(
                "stance {} has the head position of stance {}: expected an earlier stance of the same camera",
                i, before));
  }
  for (const RigImage& image : seen.images) {
    for (const SeenMarker& marker : image.markers) (void)material_point(guess.arm, marker.s);
    require(
        image.stance < seen.stances.size() && image.pose < seen.poses.size(),
        fmt::format("an image refers to stance {} and pose {}, but there are only {} stances and {} poses",
                    image.stance, image.pose, seen.stances.size(), seen.poses.size()));
  }
}

}  // namespace

RigVariables::RigVariables(const RigModel& guess, const RigPrior& prior, const RigObservations& seen)
    : guess_(guess), read_(seen.stances) {
  guess_.bend_gains.resize(guess_.arm.sections.size(), 1.0);
  check(prior);
  check_observations(guess_, seen);
  for (const ArmState& pose : seen.poses) commanded_.push_back(guess.actuation.shape(pose));
  if (prior.arm.response > 0 || prior.arm.pose_response > 0) response_ = RigResponse(guess_, seen.poses);
  for (CameraConfig& camera : guess_.cameras) camera.lens = spelled_out(camera);
  for (std::size_t i = 0; i < guess_.cameras.size(); ++i) add_camera(guess_.cameras[i], prior.cameras[i]);
  add_arm(prior.arm);
  globals_ = count_;
  for (std::size_t i = 0; i < commanded_.size(); ++i) add_pose(i, commanded_[i], prior.arm);
  for (std::size_t i = 0; i < read_.size(); ++i) add_stance(i, read_[i], prior.cameras[read_[i].camera]);
}

void RigVariables::check(const RigPrior& prior) const {
  require(prior.cameras.size() == guess_.cameras.size(),
          fmt::format("{} priors for {} cameras", prior.cameras.size(), guess_.cameras.size()));
  const auto each = [](std::initializer_list<double> sigmas) {
    for (const double sigma : sigmas)
      require(sigma >= 0, fmt::format("a standard deviation of {}: expected 0 or more", sigma));
  };
  each({prior.arm.length, prior.arm.bend_gain, prior.arm.bend_share, prior.arm.bend, prior.arm.response,
        prior.arm.pose_response});
  for (const CameraPrior& camera : prior.cameras) {
    each({camera.position, camera.rotation, camera.pan_zero, camera.tilt_zero, camera.tilt_axis, camera.pupil,
          camera.pupil_shift, camera.focal, camera.aspect, camera.principal_point, camera.zoom_row,
          camera.steps});
    for (const double sigma : camera.distortion) each({sigma});
  }
}

void RigVariables::add(std::string name, double sigma, double scale) {
  Variable& variable = slots_.emplace_back();
  variable.name = std::move(name), variable.sigma = sigma;
  variable.scale = std::isfinite(sigma) ? sigma : scale;
  if (!(sigma > 0)) return;
  variable.column = count_++;
  slot_of_.push_back(slots_.size() - 1);
}

void RigVariables::add3(const std::string& name, double sigma, double scale) {
  for (const char* direction : directions) add(fmt::format("{}, {}", name, direction), sigma, scale);
}

void RigVariables::add_camera(const CameraConfig& camera, const CameraPrior& prior) {
  const CameraPrior usual;  // Default sizes for variables without a prior.
  const std::string name = camera.name + ": ";
  cameras_.push_back(slots_.size());
  add3(name + "mount's position", prior.position, usual.position);
  add3(name + "mount's rotation", prior.rotation, usual.rotation);
  add(name + "pan's zero", prior.pan_zero, usual.tilt_zero);
  add(name + "tilt's zero", prior.tilt_zero, usual.tilt_zero);
  add3(name + "tilt axis", prior.tilt_axis, usual.tilt_axis);
  add3(name + "pupil", prior.pupil, usual.pupil);
  add(name + "pupil's shift", prior.pupil_shift, usual.pupil_shift);
  add(name + "focal length", prior.focal, usual.focal);
  add(name + "aspect", prior.aspect, usual.aspect);
  add(name + "principal point, u", prior.principal_point, usual.principal_point);
  add(name + "principal point, v", prior.principal_point, usual.principal_point);
  const std::vector<std::string>& coefficients = coefficient_names(camera.lens.model);
  for (std::size_t i = 0; i < Distortion::most; ++i) {
    const bool is_there = i < coefficients.size();
    add(is_there ? name + coefficients[i] : "", is_there ? prior.distortion[i] : 0, usual.distortion[0]);
  }
  for (std::size_t i = 0; i < camera.lens.zoom.size(); ++i)
    add(fmt::format("{}focal length of zoom row {}", name, i + 1), prior.zoom_row, usual.zoom_row);
}

void RigVariables::add_arm(const ArmPrior& prior) {
  const ArmPrior usual;
  arm_ = slots_.size();
  const std::size_t sections = guess_.arm.sections.size();
  for (std::size_t i = 0; i < sections; ++i)
    add(fmt::format("arm: length of section {}", i + 1), prior.length, usual.length);
  for (std::size_t i = 0; i < sections; ++i)
    add(fmt::format("arm: bend gain of section {}", i + 1), prior.bend_gain, usual.bend_gain);
  for (std::size_t i = 0; i < sections && response_.inputs() > 0; ++i)
    for (std::size_t j = 0; j < response_.inputs(); ++j)
      add(fmt::format("arm: response of section {} to {}", i + 1, response_.name(j)),
          response_.acts(j) ? prior.response : 0, prior.response);
}

void RigVariables::add_pose(std::size_t number, const ArmState& pose, const ArmPrior& prior) {
  if (response_.inputs() > 0 && response_.first_like(number) < number) {
    poses_.push_back(poses_[response_.first_like(number)]);
    return;
  }
  poses_.push_back(slots_.size());
  for (std::size_t i = 0; i < pose.bends.size(); ++i) {
    const double sigma = std::hypot(prior.bend, prior.bend_share * pose.bends[i].norm());
    add_bend(fmt::format("pose {}: bend of section {}", number + 1, i + 1), {sigma, sigma});
  }
  if (response_.inputs() == 0) return;
  const auto& sizes = response_.axes(number).sizes;
  for (std::size_t i = 0; i < response_.sections(); ++i)
    add_bend(fmt::format("pose {}: response of section {}", number + 1, i + 1),
             {prior.pose_response * sizes[0], prior.pose_response * sizes[1]});
}

void RigVariables::add_bend(const std::string& name, const std::array<double, 2>& sigmas) {
  for (std::size_t j = 0; j < 2; ++j) {
    const bool is_held = j == 1 && guess_.arm.kind == ArmKind::planar;
    add(fmt::format("{}, {}", name, directions[j]), is_held ? 0 : sigmas[j], ArmPrior{}.bend);
  }
}

Eigen::Index RigVariables::slots_of_arm() const {
  return static_cast<Eigen::Index>(guess_.arm.sections.size() * (2 + response_.inputs()));
}

Eigen::Index RigVariables::slots_a_pose() const {
  return static_cast<Eigen::Index>(2 * (guess_.arm.sections.size() + response_.sections()));
}

void RigVariables::add_stance(std::size_t number, const RigStance& stance, const CameraPrior& prior) {
  stances_.push_back(slots_.size());
  const Camera camera(guess_.cameras[stance.camera]);
  const auto add_axis = [&](const char* what, const AxisConfig& axis) {
    // Known backlash of the axis: half of it to either side of the count.
    const double sigma = prior.steps > 0 ? std::hypot(prior.steps * axis.resolution, axis.backlash / 2) : 0;
    add(fmt::format("stance {}: {}", number + 1, what), sigma, std::max(axis.resolution, axis.backlash));
  };
  if (stance.turned_as) {
    const std::size_t before = stances_[*stance.turned_as];
    slots_.push_back(slots_[before]), slots_.push_back(slots_[before + 1]);
  } else {
    add_axis("pan", camera.head_axes()[0]);
    add_axis("tilt", camera.head_axes()[1]);
  }
  add_axis("zoom", camera.head_axes()[2]);
  add_axis("stage, x", camera.stage_axes()[0]);
  add_axis("stage, y", camera.stage_axes()[1]);
  add_axis("stage, z", camera.stage_axes()[2]);
}

Eigen::Index RigVariables::slots_a_camera(std::size_t camera) const {
  return zoom_row_slot + static_cast<Eigen::Index>(guess_.cameras.at(camera).lens.zoom.size());
}

bool RigVariables::is_rig(const Eigen::VectorXd& x) const {
  constexpr double far = 1000;
  for (Eigen::Index i = 0; i < count_; ++i)
    if (!(std::abs(x[i]) <= far * variable(i).scale)) return false;
  const std::vector<CameraConfig> cameras = model(x).cameras;
  return std::ranges::none_of(
      cameras, [](const CameraConfig& camera) { return ZoomTable::fault(camera.lens).has_value(); });
}

RigModel RigVariables::model(const Eigen::VectorXd& x) const {
  RigModel model = guess_;
  const std::size_t sections = model.arm.sections.size();
  for (std::size_t i = 0; i < sections; ++i) {
    model.arm.sections[i].length *= std::exp(value(x, arm_ + i));
    model.bend_gains[i] += value(x, arm_ + sections + i);
  }
  for (std::size_t i = 0; i < model.cameras.size(); ++i) model.cameras[i] = camera(x, i);
  return model;
}

CameraConfig RigVariables::camera(const Eigen::VectorXd& x, std::size_t number) const {
  CameraConfig config = guess_.cameras[number];
  const std::size_t first = cameras_[number];
  const auto move3 = [&](std::array<double, 3>& place, std::size_t slot) {
    for (std::size_t i = 0; i < 3; ++i) place[i] += value(x, first + slot + i);
  };
  const Eigen::Vector4d quaternion =
      quaternion_wxyz(so3_exp(value3(x, first + mount_rotation_slot)) * config.mount.pose().rotation);
  move3(config.mount.position, mount_position_slot);
  config.mount.look_at.reset(), config.mount.roll = 0;
  config.mount.rotation = {quaternion[0], quaternion[1], quaternion[2], quaternion[3]};
  config.head.pan.zero += value(x, first + pan_zero_slot);
  config.head.tilt.zero += value(x, first + tilt_zero_slot);
  move3(config.head.tilt_axis, tilt_axis_slot);
  move3(config.head.pupil, pupil_slot);
  config.head.pupil_shift += value(x, first + pupil_shift_slot);
  LensConfig& lens = config.lens;
  const double fx = std::exp(value(x, first + focal_slot));
  const double fy = fx * std::exp(value(x, first + aspect_slot));
  const double cx = value(x, first + principal_point_slot), cy = value(x, first + principal_point_slot + 1);
  const auto distort = [&](Distortion& distortion) {
    for (std::size_t i = 0; i < distortion.size(); ++i)
      distortion[i] += value(x, first + distortion_slot + i);
  };
  lens.fx *= fx, *lens.fy *= fy, *lens.cx += cx, *lens.cy += cy;
  distort(lens.distortion);
  for (std::size_t i = 0; i < lens.zoom.size(); ++i) {
    ZoomRow& row = lens.zoom[i];
    const double own = std::exp(value(x, first + zoom_row_slot + i));
    *row.fx *= fx * own, *row.fy *= fy * own, *row.cx += cx, *row.cy += cy;
    distort(*row.distortion);
  }
  return config;
}

ArmState RigVariables::pose(const Eigen::VectorXd& x, std::size_t pose) const {
  ArmState state = commanded_.at(pose);
  const std::size_t sections = state.bends.size();
  for (std::size_t i = 0; i < sections; ++i) {
    state.bends[i] *= guess_.bend_gains[i] + value(x, arm_ + sections + i);
    state.bends[i] += value2(x, poses_[pose] + 2 * i);
  }
  if (response_.inputs() == 0) return state;
  for (std::size_t i = 0; i < sections; ++i) {
    const std::size_t first = arm_ + 2 * sections + i * response_.inputs();
    for (std::size_t j = 0; j < response_.inputs(); ++j)
      state.bends[i] += value(x, first + j) * response_.input(pose, i, j);
    const std::size_t own = poses_[pose] + 2 * (sections + response_.section_of(i));
    state.bends[i] += response_.share(i) * (response_.axes(pose).directions * value2(x, own));
  }
  return state;
}

RigStance RigVariables::stance(const Eigen::VectorXd& x, std::size_t stance) const {
  RigStance where = read_.at(stance);
  const std::size_t first = stances_[stance];
  where.head.pan += value(x, first), where.head.tilt += value(x, first + 1);
  where.head.zoom += value(x, first + 2);
  where.stage.offset += value3(x, first + 3);
  return where;
}

}  // namespace flexura
