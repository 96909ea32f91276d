#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/node.h"
#include "flexura/math/pose.h"
#include "flexura/view/viewed_rig.h"

// Description of a session for a new client (docs/viewer-protocol.md, "From the server, as text").
namespace flexura {

/// A marked time of a recording.
struct Mark {
  double time = 0, end = 0;  ///< Start and end, s.
  std::string level;         ///< "info", "warning" or "error".
  std::string name;
  std::string text;
};

/// A quantity of a recording over time.
struct Quantity {
  std::string name;
  std::string unit;
  std::optional<std::string> group =
      {};  ///< Group in which the quantity is shown; default: derived from the quantity's name.
};

const Table<Mark>& fields_of(const Mark*);
const Table<Quantity>& fields_of(const Quantity*);

/// Returns [x, y, z, qw, qx, qy, qz].
[[nodiscard]] Node flat_pose_node(const Pose& X_WP);

/// Returns SCENE of the protocol (docs/viewer-protocol.md): the description of the true scene.
[[nodiscard]] Node scene_node(const ViewedRig& rig);

/// Returns CONTROLS of the protocol (docs/viewer-protocol.md): the controls with their ranges according to
/// the model, and the tasks. The range of a tendon is computed from the bend limits of its sections. For a
/// section without a bend limit, the range assumes a limit of a full turn.
[[nodiscard]] Node controls_node(const ViewedRig& rig);
/// Returns CONTROLS for a live rig. The answer includes the rig's actuators and switches, if there are any.
/// If there are actuators, the key `tendons` of the answer is null.
[[nodiscard]] Node live_controls_node(const ViewedRig& rig);

}  // namespace flexura
