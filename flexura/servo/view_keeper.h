#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/camera/view.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Keeps an arm in the pictures of two cameras by commands to the cameras' heads.
class ViewKeeper {
 public:
  ViewKeeper(const RigModel& nominal, const std::array<std::size_t, 2>& cameras);

  /// Returns the command for the head of camera i (0 or 1), whose position is `stands`. The command moves the
  /// middle of the arm's image to the picture's middle, with a zoom that shows the whole arm. `view`: the
  /// camera's current view. `state`: the shape of the arm. Returns std::nullopt while the arm's image is well
  /// inside the picture. Respects the head's limits.
  [[nodiscard]] std::optional<HeadState> turned(std::size_t i, const ArmState& state, const HeadState& stands,
                                                const View& view) const;

 private:
  Arm arm_;
  std::vector<Camera> cameras_;
};

}  // namespace flexura
