#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "flexura/calibrate/rig_hands.h"
#include "flexura/calibrate/rig_session.h"

namespace flexura {

/// Two cameras and an arm on their way through a session: knows where they stood when it began, bends the arm
/// and brings all of them back, and tells the session's watcher of each command.
class RigTrip {
 public:
  using Trouble = RigHands::Trouble;

  /// `move_duration`: of the arm from one shape to the next, s.
  RigTrip(RigHands& hands, RigSessionWatcher& watcher, const std::array<std::size_t, 2>& cameras,
          double move_duration)
      : hands_(hands), watcher_(watcher), cameras_(cameras), move_duration_(move_duration) {}

  /// Waits for rest, and remembers where everything stands.
  [[nodiscard]] Trouble begin();
  /// The arm to a pose by way of the shape in which it began: these ways are known before anything moves.
  [[nodiscard]] Trouble show(const ArmState& pose);
  /// Sends everything back to where it began, as far as it goes; says how it went.
  [[nodiscard]] std::string retreat();

  /// As they were when it began.
  [[nodiscard]] const ArmState& home() const { return home_; }
  [[nodiscard]] const std::array<RigStance, 2>& start() const { return start_; }

 private:
  Trouble bend(const ArmState& state);

  RigHands& hands_;
  RigSessionWatcher& watcher_;
  std::array<std::size_t, 2> cameras_;
  double move_duration_;
  ArmState home_, shown_;
  std::array<RigStance, 2> start_;
  bool has_begun_ = false;
};

}  // namespace flexura
