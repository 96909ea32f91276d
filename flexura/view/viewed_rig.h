#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/run_watcher.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/backbone.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/sim/simulated_camera.h"
#include "flexura/sim/tendon_pull.h"
#include "flexura/view/state_message.h"

namespace flexura {

/// What lies `part` of the way from one pose to another.
[[nodiscard]] Pose interpolate(const Pose& from, const Pose& to, double part);

/// What is seen at one instant.
struct Instant {
  double time = 0;  ///< s
  ArmState arm;     ///< What its drives bend it to.
  CameraStance stance;
  std::shared_ptr<const Backbone> shape = {};  ///< How a rod lies; null: the true arm's arcs, so bent.
};

/// What a hand needs to push an arm: forces that move it visibly, and no more than it bears.
struct PushScale {
  double length = 0;     ///< Of the arm at rest, m.
  double stiffness = 0;  ///< Of a hand's spring, N/m: five times as stiff as the arm's tip at the start.
  double most = 0;       ///< N: what would draw that tip as far away as the arm is long, were it linear.
};

/// A rig as an experiment describes it, ready to be shown. A value that does not change: threads share it.
class ViewedRig {
 public:
  explicit ViewedRig(Experiment read);

  Experiment experiment;
  ArmModel model, truth;  ///< The arm as it is believed to be, and as it is.
  ArmState initial;       ///< As it is.
  bool is_rod;            ///< The arm as it is: it lies as its plant says, which `truth` does not know.
  std::vector<PulledTendon> actuators;  ///< Tendons that can be pulled in one by one.
  bool has_weight = false;              ///< Weight or loads pull at the arm as it is.
  std::optional<PushScale> push = {};   ///< Of an arm that yields to forces.
  bool touches = false;                 ///< The arm as it is meets obstacles, which push back.
  bool has_inertia = false;             ///< The arm as it is moves by itself, and swings.
  std::vector<Obstacle> obstacles;
  std::vector<Obstacle> forbidden;  ///< Those that the arm must not touch.
  std::optional<Drive> drive;       ///< As it is believed to be.
  std::vector<Camera> cameras;      ///< As they are.
  std::vector<Camera> believed;     ///< As they are believed to be.
  std::vector<SensorConfig> sensors;

  /// The place of the camera of this name; none when there is none.
  [[nodiscard]] std::optional<std::size_t> camera(std::string_view name) const;

  /// What a camera's head and stage say at the start, and where they stand then.
  [[nodiscard]] CameraReading first_reading(std::size_t camera) const;
  [[nodiscard]] CameraStance first_stance(std::size_t camera) const;
  /// Where they stand when they say this, and what they say when they stand there, but for play and steps:
  /// they count from where they are believed to start.
  [[nodiscard]] CameraStance stance(std::size_t camera, const CameraReading& reading) const;
  [[nodiscard]] CameraReading reading(std::size_t camera, const CameraStance& stance) const;
  /// What the camera sees, as far as one knows who has its readings.
  [[nodiscard]] View believed_view(std::size_t camera, const CameraReading& reading) const;
};

using ViewedRigPtr = std::shared_ptr<const ViewedRig>;

/// How a camera of the rig stands; as what it says of itself, its readings there.
[[nodiscard]] CameraSample camera_sample(const ViewedRig& rig, std::size_t camera,
                                         const CameraStance& stance);

/// A frame that can be taken without anything else that stays.
struct ValueShot {
  Shot shot;
  std::shared_ptr<const std::vector<Instant>> instants;  ///< What it shows.
};

/// The frame that shows `instants` (one or more, by rising time), and between two of them what lies between.
/// It starts at `start` s.
[[nodiscard]] ValueShot value_shot(const ViewedRigPtr& rig, std::size_t camera, std::int64_t frame,
                                   double start, std::vector<Instant> instants);

/// The same with the lens covered where the sensor is at `time`, s since a run's start. (The page's own time
/// covers none.)
[[nodiscard]] ValueShot with_covers(ValueShot shot, double time);

/// How the camera stands in the middle of the frame's exposure.
[[nodiscard]] CameraStance stance_in(const ValueShot& shot);

/// Whether two frames are sure to be the same picture: everything stands still, in the same way, and no noise
/// tells them apart.
[[nodiscard]] bool show_the_same(const ValueShot& a, const ValueShot& b);

/// When `value_shot` should know of a frame that starts at `start` s: once, where it is exposed in an
/// instant, else so often that motion in between is as good as straight.
[[nodiscard]] std::vector<double> times_of_instants(const SensorConfig& sensor, double start);

}  // namespace flexura
