#pragma once

#include <cstddef>

#include "flexura/model/arm.h"

namespace flexura {

/// In how many dimensions the tip's position can set out.
struct TipFreedom {
  std::size_t now = 0;    ///< In this state: the rank of the tip's Jacobian.
  std::size_t usual = 0;  ///< In almost every state of the arm.
};

/// Of the arm in `state`, which must be possible. A section stretches where its limits let it.
[[nodiscard]] TipFreedom tip_freedom(const Arm& arm, const ArmState& state);

}  // namespace flexura
