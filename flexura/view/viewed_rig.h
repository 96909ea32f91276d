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

/// Interpolates between two poses at the fraction `part`.
[[nodiscard]] Pose interpolate(const Pose& from, const Pose& to, double part);

/// State of the arm and a camera at one time, for a picture.
struct Instant {
  double time = 0;  ///< Time, s.
  ArmState arm;     ///< State that the drives impose.
  CameraStance stance;
  /// Backbone of a rod; null: the arcs of the true arm in the state `arm`.
  std::shared_ptr<const Backbone> shape = {};
};

/// Scales for pushes that move the arm visibly but not too far.
struct PushScale {
  double length = 0;  ///< Length of the arm at rest, m.
  /// Stiffness of the push spring, N/m: five times the stiffness of the arm's tip at the start.
  double stiffness = 0;
  double most = 0;  ///< Largest force of a push, N: the force that would move the tip of a linear arm by the
                    ///< arm's length.
};

/// A rig of an experiment, prepared for viewing. A ViewedRig is immutable, so that threads can share it.
class ViewedRig {
 public:
  explicit ViewedRig(Experiment read);

  Experiment experiment;
  ArmModel model, truth;  ///< Model and truth of the arm.
  ArmState initial;       ///< Initial state of the true arm.
  /// Whether the true arm is a rod. The backbone of a rod is computed by the simulated plant instead of
  /// `truth`.
  bool is_rod;
  std::vector<PulledTendon> actuators;  ///< Tendons that can be pulled individually.
  bool has_weight = false;              ///< Whether weight or loads act on the true arm.
  std::optional<PushScale> push = {};   ///< Scales for pushes; missing if forces do not move the arm.
  bool touches = false;                 ///< Whether obstacles exert forces on the true arm.
  bool has_inertia = false;             ///< Whether the true arm has inertia and can oscillate.
  std::vector<Obstacle> obstacles;
  std::vector<Obstacle> forbidden;  ///< Obstacles that the arm must not touch.
  std::optional<Drive> drive;       ///< Drive of the model.
  std::vector<Camera> cameras;      ///< True cameras.
  std::vector<Camera> nominal;      ///< Camera models.
  std::vector<SensorConfig> sensors;

  /// Returns the index of the camera with this name; std::nullopt if there is none.
  [[nodiscard]] std::optional<std::size_t> camera(std::string_view name) const;

  /// Returns the measured positions of a camera's head and stage at the start.
  [[nodiscard]] CameraReading first_reading(std::size_t camera) const;
  /// Returns the true positions of a camera's head and stage at the start.
  [[nodiscard]] CameraStance first_stance(std::size_t camera) const;
  /// Returns the true positions of a camera's head and stage for measured positions, without backlash and
  /// quantisation. Initial differences between the true rig and its model do not change.
  [[nodiscard]] CameraStance stance(std::size_t camera, const CameraReading& reading) const;
  /// Returns the positions that a camera's head and stage report at the true axis positions `stance`. This
  /// function is the inverse of stance().
  [[nodiscard]] CameraReading reading(std::size_t camera, const CameraStance& stance) const;
  /// Returns the camera's view according to its model and measured positions.
  [[nodiscard]] View nominal_view(std::size_t camera, const CameraReading& reading) const;
};

using ViewedRigPtr = std::shared_ptr<const ViewedRig>;

/// Returns the sample of a camera with the true axis positions `stance`. The commanded positions in the
/// sample are the positions that the head and stage report.
[[nodiscard]] CameraSample camera_sample(const ViewedRig& rig, std::size_t camera,
                                         const CameraStance& stance);

/// A frame that can be rendered on any thread, because its data do not change.
struct ValueShot {
  Shot shot;
  std::shared_ptr<const std::vector<Instant>> instants;  ///< States that the frame shows.
};

/// Returns the data that are needed to render a frame. `instants`: at least one state in ascending order of
/// time; the frame interpolates between them. The exposure starts at `start` (s).
[[nodiscard]] ValueShot value_shot(const ViewedRigPtr& rig, std::size_t camera, std::int64_t frame,
                                   double start, std::vector<Instant> instants);

/// Returns the shot with the lens covered if the sensor's configuration covers the lens at `time` (s since a
/// run's start).
[[nodiscard]] ValueShot with_covers(ValueShot shot, double time);

/// Returns the axis positions of the camera at mid-exposure of the frame.
[[nodiscard]] CameraStance stance_in(const ValueShot& shot);

/// Returns true if the pictures of two frames are certainly equal: everything is at rest in equal positions,
/// and the noise is equal.
[[nodiscard]] bool show_the_same(const ValueShot& a, const ValueShot& b);

/// Returns the times of the instants that value_shot() needs for a frame that starts at `start` (s). For an
/// instantaneous exposure, there is one time. For a longer exposure, the times are so close that the motion
/// between them is nearly linear.
[[nodiscard]] std::vector<double> times_of_instants(const SensorConfig& sensor, double start);

}  // namespace flexura
