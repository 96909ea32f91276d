#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_observations.h"
#include "flexura/camera/camera.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Deviations of the true rig from the model, uniform within these bounds.
struct RigTrialConfig {
  double turn = 10 * degree;  ///< Rotation of the mounts in pan and in tilt, rad.
  double roll = degree;
  double zero = degree;         ///< Zero errors of the heads' axes, rad.
  double shift = 0.2;           ///< Position of the mounts along each axis, m.
  double focal = 0.1;           ///< Focal length, share.
  double principal_point = 10;  ///< px
  double bend = 0.01, length = 0.005;
  bool are_heads_exact = false;  ///< If false, head positions are uniform within half a step of the readings.
  double noise = 0.2;            ///< px
  std::size_t markers = 9, points = 40;
};

/// Returns the model of a rig: two cameras 2.5 m in front of and beside a three-section arm of 1 m. They have
/// stages, and heads with steps of 0.075 degrees.
inline RigModel nominal_rig() {
  std::vector<CameraConfig> cameras = cameras_at({2.5, 2.5}, {0, 0.5, 0});
  for (CameraConfig& camera : cameras) {
    camera.head.pan.resolution = camera.head.tilt.resolution = 0.075 * degree;
    for (SlideConfig* slide : {&camera.mount.stage.x, &camera.mount.stage.y, &camera.mount.stage.z})
      slide->limits = {-0.5, 0.5};
  }
  return rig_model(three_section_arm(), cameras);
}

/// Returns a true rig that deviates randomly from the model.
inline RigModel true_rig(const RigModel& nominal, const RigTrialConfig& config, TestRandom& random) {
  RigModel rig = nominal;
  for (std::size_t i = 0; i < rig.arm.sections.size(); ++i) {
    rig.arm.sections[i].length *= 1 + config.length * random.uniform(-1, 1);
    rig.bend_gains[i] += config.bend * random.uniform(-1, 1);
  }
  for (CameraConfig& camera : rig.cameras) {
    MountConfig& mount = camera.mount;
    const Eigen::Matrix3d R_WM = mount.pose().rotation *
                                 pan_rotation(random.uniform(-config.turn, config.turn)) *
                                 tilt_rotation(random.uniform(-config.turn, config.turn)) *
                                 so3_exp({0, 0, random.uniform(-config.roll, config.roll)});
    const Eigen::Vector4d q = quaternion_wxyz(R_WM);
    for (double& place : mount.position) place += random.uniform(-config.shift, config.shift);
    mount.look_at.reset(), mount.roll = 0, mount.rotation = {q[0], q[1], q[2], q[3]};
    camera.head.pan.zero += random.uniform(-config.zero, config.zero);
    camera.head.tilt.zero += random.uniform(-config.zero, config.zero);
    LensConfig& lens = camera.lens;
    lens.fx *= 1 + config.focal * random.uniform(-1, 1);
    lens.cx = 319.5 + random.uniform(-config.principal_point, config.principal_point);
    lens.cy = 239.5 + random.uniform(-config.principal_point, config.principal_point);
  }
  return rig;
}

/// A simulated true rig: moves cameras and arm and generates observations from their true positions.
class RigTrial {
 public:
  RigTrial(const RigModel& truth, const RigTrialConfig& config, TestRandom& random)
      : truth_(truth), config_(config), random_(random) {}

  const RigModel& truth() const { return truth_; }
  const RigObservations& seen() const { return seen_; }
  /// Returns the true axis positions of a camera (stance) by number.
  const RigStance& stance(std::size_t number) const { return stances_.at(number); }
  ArmState pose(std::size_t number) const { return truth_.bent(seen_.poses.at(number)); }

  std::size_t add_pose(const ArmState& commanded) {
    seen_.poses.push_back(commanded);
    return seen_.poses.size() - 1;
  }

  /// Adds camera axis positions (a stance), rounded to commandable head positions. Returns their number.
  std::size_t add_stance(RigStance stance) {
    const CameraConfig& camera = truth_.cameras[stance.camera];
    stance.head.pan = commandable(camera.head.pan, stance.head.pan);
    stance.head.tilt = commandable(camera.head.tilt, stance.head.tilt);
    seen_.stances.push_back(stance);
    const double step = config_.are_heads_exact ? 0 : camera.head.pan.resolution;
    Eigen::Vector2d off = step * random_.vector<2>(-0.5, 0.5);
    if (stance.turned_as) {
      const HeadState &truth = stances_[*stance.turned_as].head,
                      &read = seen_.stances[*stance.turned_as].head;
      off = {truth.pan - read.pan, truth.tilt - read.tilt};
    }
    stance.head.pan += off.x(), stance.head.tilt += off.y();
    stances_.push_back(stance);
    return seen_.stances.size() - 1;
  }

  /// Adds an image with the arm points that are inside it. Returns the number of visible markers.
  std::size_t add_image(std::size_t stance, std::size_t pose) {
    const RigStance& where = stances_[stance];
    const View view = Camera(truth_.cameras[where.camera]).view(where.stance());
    const Backbone backbone(truth_.arm, this->pose(pose));
    const double sigma = std::max(config_.noise, 1e-3);
    RigImage image{.stance = stance, .pose = pose};
    for (std::size_t i = 0; i < config_.markers; ++i) {
      const double f = static_cast<double>(i) / static_cast<double>(config_.markers - 1);
      const auto [section, fraction] = material_point(nominal_rig().arm, f * nominal_rig().arm.length());
      const Arc& arc = backbone.arcs()[section];
      const auto pixel = view.project(arc.pose(fraction * arc.length).position);
      const Eigen::Vector2d noise(normal_number(random_), normal_number(random_));
      if (pixel && is_inside(view, *pixel))
        image.markers.push_back({*pixel + config_.noise * noise, f * nominal_rig().arm.length(), sigma});
    }
    for (std::size_t i = 0; i < config_.points; ++i) {
      const double f = (static_cast<double>(i) + 0.5) / static_cast<double>(config_.points);
      const Pose X_WS = backbone.pose(f * backbone.length());
      const auto pixel = view.project(X_WS.position);
      const auto ahead = view.project(X_WS.position + 1e-5 * X_WS.rotation.col(2));
      const double noise = normal_number(random_);
      if (!pixel || !ahead || !is_inside(view, *pixel)) continue;
      const Eigen::Vector2d way = (*ahead - *pixel).normalized();
      image.points.push_back({*pixel + config_.noise * noise * Eigen::Vector2d(-way.y(), way.x()), sigma});
    }
    seen_.images.push_back(image);
    return image.markers.size();
  }

  RigObservations& change_seen() { return seen_; }

 private:
  static bool is_inside(const View& view, const Eigen::Vector2d& pixel) {
    return pixel.x() > 0 && pixel.y() > 0 && pixel.x() < view.width - 1 && pixel.y() < view.height - 1;
  }

  RigModel truth_;
  RigTrialConfig config_;
  TestRandom& random_;
  RigObservations seen_;
  std::vector<RigStance> stances_;
};

/// Takes twelve pictures per camera: six poses with two head orientations each, at two zooms.
inline void take_plan(RigTrial& trial, std::size_t pictures = 12) {
  constexpr std::array<std::array<double, 6>, 6> bends = {{{0.5, 0, 0.5, 0, 0.5, 0},
                                                           {0, 0.5, 0, 0.5, 0, 0.5},
                                                           {-0.6, 0.3, 0.7, 0.1, 0.5, -0.8},
                                                           {0.4, -0.7, -0.3, -0.4, 0.9, 0.2},
                                                           {0.1, 0.2, -0.9, 0.3, -0.4, 0.7},
                                                           {-0.5, -0.5, 0.1, 0.8, 0.2, -0.9}}};
  constexpr std::array<std::array<double, 2>, 12> turns = {{{0, 0},
                                                            {6, 0},
                                                            {0, 4},
                                                            {-6, 0},
                                                            {0, -4},
                                                            {5, 3},
                                                            {-5, 3},
                                                            {5, -3},
                                                            {-5, -3},
                                                            {0, 0},
                                                            {3, 0},
                                                            {-3, 2}}};
  for (std::size_t i = 0; i < pictures; ++i) {
    ArmState pose = ArmState::straight(3);
    for (std::size_t j = 0; j < 3; ++j) pose.bends[j] = {bends[i % 6][2 * j], bends[i % 6][2 * j + 1]};
    const std::size_t number = trial.add_pose(pose);
    for (std::size_t camera = 0; camera < trial.truth().cameras.size(); ++camera) {
      const double zoom = i % 3 == 2 ? 1.5 : 1.0;
      trial.add_image(trial.add_stance({camera, {turns[i][0] * degree, turns[i][1] * degree, zoom}, {}}),
                      number);
    }
  }
}

}  // namespace flexura
