#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/log/run_watcher.h"
#include "flexura/model/backbone.h"
#include "flexura/port/rig_ports.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/view/moves.h"
#include "flexura/view/state_message.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// A simulated rig that follows an external clock. Commands are sent through its ports. The viewer shows its
/// true state.
class LiveRig {
 public:
  /// Makes a rig in the initial state of the experiment. `now`: time of the external clock, s.
  LiveRig(ViewedRigPtr rig, double now);

  /// Restores the initial state of the experiment.
  void restart(double now);

  /// Replaces the simulated rig by `rig`, a simulated rig of the same experiment, in the present state of
  /// `rig`. `now`: time of the external clock, s.
  void take_over(std::unique_ptr<SimulatedRig> rig, double now);
  /// Restores the initial state of the experiment, but with the arm's drives at the state `state`.
  void restart(double now, const ArmState& state);

  [[nodiscard]] RigPorts ports() { return simulated_->ports(); }
  [[nodiscard]] double now() { return start_ + simulated_->clock().now(); }
  /// Advances to the time `now` (s), which must not be before the previous time.
  void go_to(double now) { simulated_->clock().wait_until(rig_time(now)); }
  /// Moves the rig to the time `now` (s) without simulation, while no client is connected.
  void rest_until(double now) { start_ += std::max(0.0, now - this->now()); }
  /// Call this function before the rig advances to the time `next` (s). If the arm is a rod, skips all but
  /// the last 0.1 s before `next`, because the simulation of a rod may be too slow to catch up.
  void skip_to(double next);
  /// Returns the recent speed of the rig's time relative to real time, if the simulation is slower than real
  /// time. Otherwise returns std::nullopt.
  [[nodiscard]] std::optional<double> pace() const;

  /// Returns the shape of the arm according to the model.
  [[nodiscard]] ArmState nominal();
  /// Returns the state that the true drives impose at `time` (s). The time may be in the future, for motions
  /// that are already commanded.
  [[nodiscard]] ArmState truth(double time) { return simulated_->arm().truth(rig_time(time)); }
  /// Returns the true backbone at `time` (s). The time may be in the future, for motions that are already
  /// commanded.
  [[nodiscard]] Backbone backbone(double time) { return simulated_->arm().backbone(rig_time(time)); }
  /// Returns the backbone at rest for these bends. If the arm's present bends are equal to these bends,
  /// returns the present backbone. Throws std::runtime_error if a rod has no equilibrium for these bends.
  [[nodiscard]] Backbone at_rest(const ArmState& state);
  /// Returns the backbone of a rod at rest, for pictures; null if the arm is not a rod or has no equilibrium.
  [[nodiscard]] std::shared_ptr<const Backbone> rod_at_rest(const ArmState& state);
  [[nodiscard]] bool is_arm_moving();

  /// Pulls each tendon in to the given displacement, m, in `duration` s (SimulatedArm::pull).
  CommandOutcome pull(const TendonPull& pull, double duration) {
    return simulated_->arm().pull(pull.displacements, duration);
  }
  /// Switches the arm's weight and loads on or off until a restart. If the arm would have no equilibrium,
  /// changes nothing and throws std::runtime_error.
  void weigh(bool on);
  /// Applies a push until a restart; std::nullopt ends the push. If the arm would have no equilibrium,
  /// changes nothing and throws std::runtime_error. Throws std::invalid_argument for an invalid push.
  void push(const std::optional<PlantPush>& push);
  [[nodiscard]] bool is_pushed() { return simulated_->arm().plant().pushed(rig_time(now())).has_value(); }
  /// Returns whether the arm is pushed or oscillates. In both cases the arm's motion differs from the
  /// commanded motion.
  [[nodiscard]] bool is_yielding();
  /// Returns a one-line warning about the present state of the arm, or "".
  [[nodiscard]] std::string warning() { return simulated_->arm().plant().warning(rig_time(now())); }

  /// Returns the current state of everything that moves. The caller must set the sequence number and all
  /// flags except `is_moving`.
  [[nodiscard]] StateMessage state();

  /// Returns the number of a camera's newest frame whose exposure has ended.
  [[nodiscard]] std::int64_t newest_frame(std::size_t camera);
  /// Returns the data from which frame number `frame` of a camera is rendered.
  [[nodiscard]] ValueShot shot(std::size_t camera, std::int64_t frame);

 private:
  [[nodiscard]] double rig_time(double time) const { return time - start_; }
  [[nodiscard]] bool lie_alike(double time, double other);

  ViewedRigPtr rig_;
  double start_ = 0;  // Time at which the simulated rig's time is 0, s.
  std::unique_ptr<SimulatedRig> simulated_;
  int behind_ = 0;  // Number of consecutive advances in which the rig did not reach the clock's time.
  double pace_ = 1;
};

/// Returns the arcs nearest to these tendon displacements. Throws std::logic_error if tendons of the rig
/// cannot be pulled individually.
[[nodiscard]] ArmState nearest_arcs(const ViewedRig& rig, const TendonPull& pull);

/// Converts contacts of a log or a run to contacts in state messages.
[[nodiscard]] std::vector<ContactSample> contact_samples(const ViewedRig& rig,
                                                         const std::vector<ContactMessage>& contacts);

/// Returns the state message of an arm with the command `state` at `time`, s, with the axis positions
/// `stances` of the cameras. If `truth` is not null, it is the shape of the arm.
[[nodiscard]] StateMessage still_state(const ViewedRig& rig, double time, const ArmState& state,
                                       const std::vector<CameraStance>& stances,
                                       const TrueArm* truth = nullptr);

}  // namespace flexura
