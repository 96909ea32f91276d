#pragma once

#include <string>

#include "flexura/base/node.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/model/backbone.h"
#include "flexura/serve/server.h"

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
/// Returns the answer for a document that does not exist or cannot be made, with the reason in one line.
[[nodiscard]] HttpAnswer failure_answer(int status, const std::string& why);
/// Returns the answer with a report. The page may run its script, but has no access to this server.
[[nodiscard]] HttpAnswer report_answer(std::string page);

}  // namespace flexura
