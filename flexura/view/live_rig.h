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

/// A simulated rig that goes with a clock of others. Commands go through its ports; what is shown is the
/// truth of the simulated world.
class LiveRig {
 public:
  /// Everything stands as the experiment starts, at `now` s.
  LiveRig(ViewedRigPtr rig, double now);

  /// Puts everything back to how the experiment starts.
  void restart(double now);

  /// Goes on with another simulated rig of the same experiment, as it stands, at `now` s.
  void take_over(std::unique_ptr<SimulatedRig> rig, double now);
  /// Puts everything back to how the experiment starts, but the arm into `state`, as its drives believe it to
  /// be.
  void restart(double now, const ArmState& state);

  [[nodiscard]] RigPorts ports() { return simulated_->ports(); }
  [[nodiscard]] double now() { return start_ + simulated_->clock().now(); }
  /// Goes on to a time, not before the last one.
  void go_to(double now) { simulated_->clock().wait_until(rig_time(now)); }
  /// Lets time pass without it, up to `now` s: nobody looks at it.
  void rest_until(double now) { start_ += std::max(0.0, now - this->now()); }
  /// Before it goes on to a time: a rod is followed step by step, and has no time to make up for what nobody
  /// saw. All but the last 0.1 s up to then pass without it.
  void skip_to(double next);
  /// How fast its time goes of late, of real time, where its steps take longer than they last; else none.
  [[nodiscard]] std::optional<double> pace() const;

  /// The shape that the arm is believed to be in.
  [[nodiscard]] ArmState believed();
  /// What its drives truly bend it to, and how it lies: now, or in what is to come as far as it was
  /// commanded, s.
  [[nodiscard]] ArmState truth(double time) { return simulated_->arm().truth(rig_time(time)); }
  [[nodiscard]] Backbone backbone(double time) { return simulated_->arm().backbone(rig_time(time)); }
  /// How it would lie at rest, bent to this: where it is bent so now, as it lies. std::runtime_error: a rod
  /// finds no rest there.
  [[nodiscard]] Backbone at_rest(const ArmState& state);
  /// The same of a rod, for pictures; null where the arm is none, or finds no rest.
  [[nodiscard]] std::shared_ptr<const Backbone> rod_at_rest(const ArmState& state);
  [[nodiscard]] bool is_arm_moving();

  /// Sends each tendon to be pulled in so far, m (SimulatedArm::pull).
  CommandOutcome pull(const TendonPull& pull, double duration) {
    return simulated_->arm().pull(pull.displacements, duration);
  }
  /// From now on the arm is with or without its weight and loads, until a restart. std::runtime_error: then
  /// it would find no rest; all stays as it was.
  void weigh(bool on);
  /// From now on something pushes the arm so, until a restart; none: nothing does. std::runtime_error: then
  /// it would find no rest; all stays as it was. std::invalid_argument: a push that cannot be.
  void push(const std::optional<PlantPush>& push);
  [[nodiscard]] bool is_pushed() { return simulated_->arm().plant().pushed(rig_time(now())).has_value(); }
  /// Whether it is pushed, or swings: then it may come anywhere.
  [[nodiscard]] bool is_yielding();
  /// What is out of the ordinary in how the arm rests now, one line; "": nothing.
  [[nodiscard]] std::string warning() { return simulated_->arm().plant().warning(rig_time(now())); }

  /// All that moves, as it stands now; its flags but for the arm's motion, and its sequence, are others' to
  /// fill.
  [[nodiscard]] StateMessage state();

  /// The newest frame of a camera whose exposure is over now, and its number.
  [[nodiscard]] std::int64_t newest_frame(std::size_t camera);
  [[nodiscard]] ValueShot shot(std::size_t camera, std::int64_t frame);

 private:
  [[nodiscard]] double rig_time(double time) const { return time - start_; }
  [[nodiscard]] bool lie_alike(double time, double other);

  ViewedRigPtr rig_;
  double start_ = 0;  // when the simulated rig's time is 0, s
  std::unique_ptr<SimulatedRig> simulated_;
  int behind_ = 0;  // How many times in a row it did not make up for all of the time.
  double pace_ = 1;
};

/// The shape of arcs that comes nearest to tendons that are pulled in so. std::logic_error: the rig has none
/// that are pulled one by one.
[[nodiscard]] ArmState nearest_arcs(const ViewedRig& rig, const TendonPull& pull);

/// Contacts of a log or of a run, as state messages have them.
[[nodiscard]] std::vector<ContactSample> contact_samples(const ViewedRig& rig,
                                                         const std::vector<ContactMessage>& contacts);

/// The state message of the arm as tasks command it: in `state` at `time` s, with the cameras at their
/// `stances`; lying as `truth` says, where that is not null.
[[nodiscard]] StateMessage still_state(const ViewedRig& rig, double time, const ArmState& state,
                                       const std::vector<CameraStance>& stances,
                                       const TrueArm* truth = nullptr);

}  // namespace flexura
