#pragma once

#include <string>

#include "flexura/base/node.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/model/backbone.h"

// Contents of replies (docs/viewer-protocol.md).
namespace flexura {

/// Returns an empty table, {}.
[[nodiscard]] Node nothing();
/// Returns the answer to the request `point`: the pose of the backbone at `s` (m along the unstretched arm).
/// Throws ViewRefusal if `s` is not on the arm.
[[nodiscard]] Node point_answer(const Backbone& backbone, double s);
/// Returns the answer to the request `backbone`.
[[nodiscard]] Node backbone_answer(const Backbone& backbone);
/// Returns the answer to the request `tip`: the solution, and the reason why the arm does not move to the
/// solution, or "".
[[nodiscard]] Node tip_answer(const InverseResult& found, const std::string& danger);
/// Returns [[bend_x, bend_y], ...] without negative zeros.
[[nodiscard]] Node bends_answer(const ArmState& state);

}  // namespace flexura
