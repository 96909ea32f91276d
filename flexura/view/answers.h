#pragma once

#include <string>

#include "flexura/base/node.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/model/backbone.h"

// What replies hold (docs/viewer-protocol.md).
namespace flexura {

/// {}.
[[nodiscard]] Node nothing();
/// The answer to `point`: the backbone at `s` m along the unstretched arm; a ViewRefusal beyond its ends.
[[nodiscard]] Node point_answer(const Backbone& backbone, double s);
/// The answer to `backbone`.
[[nodiscard]] Node backbone_answer(const Backbone& backbone);
/// The answer to `tip`: what was found, and why the arm does not go there, "" when it does.
[[nodiscard]] Node tip_answer(const InverseResult& found, const std::string& danger);
/// [[bend_x, bend_y], ...], without negative zeros.
[[nodiscard]] Node bends_answer(const ArmState& state);

}  // namespace flexura
