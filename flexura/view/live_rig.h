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

/// A simulated rig that follows an external clock. Commands go through its ports; the display shows the
/// simulated truth.
class LiveRig {
 public:
  /// Starts in the initial state of the experiment, at `now` s.
  LiveRig(ViewedRigPtr rig, double now);

  /// Restores the initial state of the experiment.
  void restart(double now);

  /// Goes on with another simulated rig of the same experiment, as it stands, at `now` s.
  void take_over(std::unique_ptr<SimulatedRig> rig, double now);
  /// Puts everything back to how the experiment starts, but the arm into `state`, as its drives believe it to
  /// be.
  void restart(double now, const ArmState& state);

  [[nodiscard]] RigPorts ports() { return simulated_->ports(); }
  [[nodiscard]] double now() { return start_ + simulated_->clock().now(); }
  /// Advances to a time, not before the last one.
  void go_to(double now) { simulated_->clock().wait_until(rig_time(now)); }
  /// Lets time pass without it, up to `now` s: nobody looks at it.
  void rest_until(double now) { start_ += std::max(0.0, now - this->now()); }
  /// Before it goes on to a time: a rod is followed step by step, and has no time to make up for what nobody
  /// saw. All but the last 0.1 s up to then pass without it.
  void skip_to(double next);
  /// Returns the recent speed of the rig's time relative to real time, if its steps take longer than real
  /// time. Otherwise returns std::nullopt.
  [[nodiscard]] std::optional<double> pace() const;

  /// Returns the shape of the arm according to the model.
  [[nodiscard]] ArmState nominal();
  /// Returns the state that the drives truly impose, and the true backbone, at `time` s. Future times are
  /// possible as far as commanded.
  [[nodiscard]] ArmState truth(double time) { return simulated_->arm().truth(rig_time(time)); }
  [[nodiscard]] Backbone backbone(double time) { return simulated_->arm().backbone(rig_time(time)); }
  /// Returns the backbone at rest for these bends; the current backbone if the arm has these bends now.
  /// Throws std::runtime_error if a rod has no equilibrium there.
  [[nodiscard]] Backbone at_rest(const ArmState& state);
  /// Returns the rest backbone of a rod for pictures; null if the arm is not a rod or has no equilibrium.
  [[nodiscard]] std::shared_ptr<const Backbone> rod_at_rest(const ArmState& state);
  [[nodiscard]] bool is_arm_moving();

  /// Pulls each tendon in to the given displacement, m (SimulatedArm::pull).
  CommandOutcome pull(const TendonPull& pull, double duration) {
    return simulated_->arm().pull(pull.displacements, duration);
  }
  /// Switches the arm's weight and loads on or off until a restart. Throws std::runtime_error, and changes
  /// nothing, if the arm would have no equilibrium.
  void weigh(bool on);
  /// Applies a push until a restart; std::nullopt ends it. Throws std::runtime_error, and changes nothing, if
  /// the arm would have no equilibrium. Throws std::invalid_argument for an invalid push.
  void push(const std::optional<PlantPush>& push);
  [[nodiscard]] bool is_pushed() { return simulated_->arm().plant().pushed(rig_time(now())).has_value(); }
  /// Returns whether the arm is pushed or swings, so that it may move anywhere.
  [[nodiscard]] bool is_yielding();
  /// Returns a one-line warning about an unusual state of the arm now; "" if there is none.
  [[nodiscard]] std::string warning() { return simulated_->arm().plant().warning(rig_time(now())); }

  /// Returns the current state of everything that moves. The sequence number, and all flags except the arm's
  /// motion, are left for the caller to set.
  [[nodiscard]] StateMessage state();

  /// Returns the number of a camera's newest frame whose exposure is over, and the shot of a frame.
  [[nodiscard]] std::int64_t newest_frame(std::size_t camera);
  [[nodiscard]] ValueShot shot(std::size_t camera, std::int64_t frame);

 private:
  [[nodiscard]] double rig_time(double time) const { return time - start_; }
  [[nodiscard]] bool lie_alike(double time, double other);

  ViewedRigPtr rig_;
  double start_ = 0;  // Time at which the simulated rig's time is 0, s.
  std::unique_ptr<SimulatedRig> simulated_;
  int behind_ = 0;  // Number of consecutive advances that did not catch up completely.
  double pace_ = 1;
};

/// Returns the arcs nearest to these tendon displacements. Throws std::logic_error if tendons of the rig
/// cannot be pulled individually.
[[nodiscard]] ArmState nearest_arcs(const ViewedRig& rig, const TendonPull& pull);

/// Converts contacts of a log or of a run into those of state messages.
[[nodiscard]] std::vector<ContactSample> contact_samples(const ViewedRig& rig,
                                                         const std::vector<ContactMessage>& contacts);

/// Returns the state message of the arm commanded to `state` at `time` s, with the cameras at `stances`. The
/// arm lies as in `truth`, if that is not null.
[[nodiscard]] StateMessage still_state(const ViewedRig& rig, double time, const ArmState& state,
                                       const std::vector<CameraStance>& stances,
                                       const TrueArm* truth = nullptr);

}  // namespace flexura
