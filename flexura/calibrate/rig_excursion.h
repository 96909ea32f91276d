#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>

#include "flexura/calibrate/rig_commander.h"
#include "flexura/calibrate/rig_session.h"

namespace flexura {

/// Moves two cameras and an arm during a session. Sends commands and reports them to the session's watcher.
/// Stores the initial and present positions, takes pictures, and returns everything to the start. Cameras
/// have the numbers 0 and 1.
class RigExcursion {
 public:
  using Error = RigCommander::Error;

  /// `move_duration`: duration of a move of the arm from one shape to the next, s. Throws
  /// std::invalid_argument if the ports do not have the cameras of the model, or if both cameras are the
  /// same.
  RigExcursion(const RigPorts& ports, const RigModel& nominal, const std::array<std::size_t, 2>& cameras,
               const RigPatience& patience, double move_duration, RigSessionWatcher& watcher);

  /// Waits until nothing moves, and stores all positions.
  [[nodiscard]] Error begin();
  /// Moves the arm to a pose via its initial shape. All possible paths are therefore known before the
  /// session.
  [[nodiscard]] Error show(const ArmState& pose);
  /// Sends a command to a camera. settle() waits for its execution.
  [[nodiscard]] Error send(std::size_t i, const RigStance& stance);
  [[nodiscard]] Error settle() { return commander_.settle(); }
  /// Moves everything back to the start, as far as possible. Returns a message about the outcome.
  [[nodiscard]] std::string retreat();

  /// Returns a new picture, which is not measured yet, with the camera's position, or an error.
  [[nodiscard]] std::variant<CameraObservation, std::string> picture(std::size_t i, std::size_t look) const;
  [[nodiscard]] std::variant<ArmState, std::string> arm() const { return commander_.arm(); }
  [[nodiscard]] double now() const { return commander_.now(); }

  /// Returns the initial shape of the arm.
  [[nodiscard]] const ArmState& home() const { return home_; }
  /// Returns the initial positions of the cameras.
  [[nodiscard]] const std::array<RigStance, 2>& start() const { return start_; }
  /// Returns the last commanded positions of the cameras.
  [[nodiscard]] const std::array<RigStance, 2>& stances() const { return stands_; }

 private:
  Error bend(const ArmState& state);

  RigCommander commander_;
  RigSessionWatcher& watcher_;
  std::array<std::size_t, 2> cameras_;
  double move_duration_;
  ArmState home_, shown_;
  std::array<RigStance, 2> start_, stands_;
  bool has_begun_ = false;
};

}  // namespace flexura
