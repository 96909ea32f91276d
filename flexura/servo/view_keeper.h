#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/camera/view.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Keeps an arm in two cameras' pictures: where their heads are to turn.
class ViewKeeper {
 public:
  ViewKeeper(const RigModel& believed, const std::array<std::size_t, 2>& cameras);

  /// Where to send the head of the first or second camera, which stands so and sees the arm in `state` by
  /// `view`: so that the middle of what is seen of the arm is the picture's middle, and at a zoom with which
  /// the arm fits into it. None while the arm is well inside. Within the head's limits.
  [[nodiscard]] std::optional<HeadState> turned(std::size_t i, const ArmState& state, const HeadState& stands,
                                                const View& view) const;

 private:
  Arm arm_;
  std::vector<Camera> cameras_;
};

}  // namespace flexura
