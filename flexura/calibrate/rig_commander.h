#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"

namespace flexura {

/// Time limits and tolerances for motions and frames.
struct RigPatience {
  double settle = 20;  ///< Time limit for motions to end, s.
  double frame = 3;    ///< Time limit for a frame, s.
  double pause = 0;    ///< Time to wait after each motion of the arm, until its oscillation has decayed, s.
  double poll = 0.02;  ///< Interval between checks for motion, s.
  /// Largest deviation between measured and commanded bend of a section, rad.
  double bend = 0.02;
};

/// Commander of a rig. The commander moves the rig through its ports, waits until nothing moves, checks that
/// commands were executed, and takes frames at rest. Errors are returned as sentences.
class RigCommander {
 public:
  using Error = std::optional<std::string>;

  /// `nominal` has the ranges and resolutions of heads and stages. The cameras of `nominal` and of `ports`
  /// must correspond one to one.
  RigCommander(const RigPorts& ports, const RigModel& nominal, const RigPatience& patience);

  /// Returns the present position of the arm, or an error.
  [[nodiscard]] std::variant<ArmState, std::string> arm() const;
  /// Returns the present position of a camera, or an error.
  [[nodiscard]] std::variant<RigStance, std::string> stance(std::size_t camera) const;

  /// Returns an error if the port of a camera lacks a head or stage that the model has.
  [[nodiscard]] Error must_move(std::size_t camera) const;

  /// Commands the arm to reach a state in `duration` s. Does not wait for the execution.
  [[nodiscard]] Error bend(const ArmState& state, double duration);
  /// Commands a camera to a stance. Does not wait for the execution.
  [[nodiscard]] Error go(const RigStance& stance);
  /// Waits until nothing moves. If the arm moved, waits for RigPatience::pause afterwards. Returns an error
  /// if a device does not come to rest or is not at its commanded position.
  [[nodiscard]] Error settle();

  /// Returns the next frame whose exposure begins at `time` (s) or later, or an error.
  [[nodiscard]] std::variant<Frame, std::string> frame(std::size_t camera, double time) const;
  [[nodiscard]] double now() const { return ports_.clock->now(); }

 private:
  [[nodiscard]] std::variant<bool, std::string> is_moving() const;
  [[nodiscard]] Error arm_elsewhere() const;
  [[nodiscard]] Error camera_elsewhere(std::size_t camera) const;
  [[nodiscard]] const std::string& name(std::size_t camera) const { return ports_.cameras[camera].name; }

  RigPorts ports_;
  std::size_t sections_;
  std::vector<Camera> cameras_;  // Modelled cameras.
  RigPatience patience_;
  std::optional<ArmState> sent_arm_;
  bool has_bent_ = false;                       // The arm was commanded since the last settle().
  std::vector<std::optional<RigStance>> sent_;  // Last commanded stance of each camera.
};

}  // namespace flexura
