#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>

#include "flexura/calibrate/rig_hands.h"
#include "flexura/calibrate/rig_session.h"

namespace flexura {

/// Two cameras and an arm on their way through a session: sends them, knows where they stand and where they
/// stood when it began, takes pictures, brings all of them back, and lets the session's watcher know of each
/// command. Cameras are counted 0 and 1 here.
class RigTrip {
 public:
  using Trouble = RigHands::Trouble;

  /// `move_duration`: of the arm from one shape to the next, s. std::invalid_argument: ports for other
  /// cameras than the model's, one camera given for both.
  RigTrip(const RigPorts& ports, const RigModel& believed, const std::array<std::size_t, 2>& cameras,
          const RigPatience& patience, double move_duration, RigSessionWatcher& watcher);

  /// Waits for rest, and remembers where everything stands.
  [[nodiscard]] Trouble begin();
  /// The arm to a pose by way of the shape in which it began: these ways are known before anything moves.
  [[nodiscard]] Trouble show(const ArmState& pose);
  /// Sends a camera; settle() waits for it.
  [[nodiscard]] Trouble send(std::size_t i, const RigStance& stance);
  [[nodiscard]] Trouble settle() { return hands_.settle(); }
  /// Sends everything back to where it began, as far as it goes; says how it went.
  [[nodiscard]] std::string retreat();

  /// What a camera sees from now on, and how it stands, in which nothing is measured yet. Or why not.
  [[nodiscard]] std::variant<RigSight, std::string> picture(std::size_t i, std::size_t look) const;
  [[nodiscard]] std::variant<ArmState, std::string> arm() const { return hands_.arm(); }
  [[nodiscard]] double now() const { return hands_.now(); }

  /// As they were when it began, and as they were sent.
  [[nodiscard]] const ArmState& home() const { return home_; }
  [[nodiscard]] const std::array<RigStance, 2>& start() const { return start_; }
  [[nodiscard]] const std::array<RigStance, 2>& stances() const { return stands_; }

 private:
  Trouble bend(const ArmState& state);

  RigHands hands_;
  RigSessionWatcher& watcher_;
  std::array<std::size_t, 2> cameras_;
  double move_duration_;
  ArmState home_, shown_;
  std::array<RigStance, 2> start_, stands_;
  bool has_begun_ = false;
};

}  // namespace flexura
