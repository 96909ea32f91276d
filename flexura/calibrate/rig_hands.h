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

/// How long to wait for what was asked for.
struct RigPatience {
  double settle = 20;  ///< For motions to end, s.
  double frame = 3;    ///< For a frame, s.
  double poll = 0.02;  ///< Between two looks at who still moves, s.
  /// How far the arm's drives may say that a section is from where it was sent, rad.
  double bend = 0.02;
};

/// Moves a rig through its ports and waits until it stands, sees that what was commanded was done, and takes
/// frames of what stands. Whatever goes wrong comes back as a sentence.
class RigHands {
 public:
  using Trouble = std::optional<std::string>;

  /// `believed` tells what heads and stages can do; its cameras are the ports'.
  RigHands(const RigPorts& ports, const RigModel& believed, const RigPatience& patience);

  /// Where everything stands now.
  [[nodiscard]] std::variant<ArmState, std::string> arm() const;
  [[nodiscard]] std::variant<RigStance, std::string> stance(std::size_t camera) const;

  /// Why a camera cannot be moved as the model has it: it has no head, or no stage.
  [[nodiscard]] Trouble must_move(std::size_t camera) const;

  /// Commands, which return at once.
  [[nodiscard]] Trouble bend(const ArmState& state, double duration);
  [[nodiscard]] Trouble go(const RigStance& stance);
  /// Waits until nothing moves; what stands elsewhere than it was sent, or moves on and on, is trouble.
  [[nodiscard]] Trouble settle();

  /// The next frame whose exposure begins at `time` s or later.
  [[nodiscard]] std::variant<Frame, std::string> frame(std::size_t camera, double time) const;
  [[nodiscard]] double now() const { return ports_.clock->now(); }

 private:
  [[nodiscard]] std::variant<bool, std::string> is_moving() const;
  [[nodiscard]] Trouble arm_elsewhere() const;
  [[nodiscard]] Trouble camera_elsewhere(std::size_t camera) const;
  [[nodiscard]] const std::string& name(std::size_t camera) const { return ports_.cameras[camera].name; }

  RigPorts ports_;
  std::size_t sections_;
  std::vector<Camera> cameras_;  // As they are believed to be.
  RigPatience patience_;
  std::optional<ArmState> sent_arm_;
  std::vector<std::optional<RigStance>> sent_;  // By camera.
};

}  // namespace flexura
