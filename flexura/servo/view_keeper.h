#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/camera/view.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Keeps an arm in two cameras' pictures by turning their heads.
class ViewKeeper {
 public:
  ViewKeeper(const RigModel& nominal, const std::array<std::size_t, 2>& cameras);

  /// Returns the command for the head of the first or second camera, which is at `stands` and observes the
  /// arm in `state` by `view`. It brings the middle of the arm's image to the picture's middle, with a zoom
  /// that shows all of it. Returns std::nullopt while the arm is well inside. Respects the head's limits.
  [[nodiscard]] std::optional<HeadState> turned(std::size_t i, const ArmState& state, const HeadState& stands,
                                                const View& view) const;

 private:
  Arm arm_;
  std::vector<Camera> cameras_;
};

}  // namespace flexura
