#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/node.h"
#include "flexura/math/pose.h"
#include "flexura/view/viewed_rig.h"

// What a client is told of a session when it comes (docs/viewer-protocol.md, "From the server, as text").
namespace flexura {

/// Something at a time of a recording.
struct Mark {
  double time = 0, end = 0;  ///< s
  std::string level;         ///< "info", "warning", "error"
  std::string name;
  std::string text;
};

/// Something that a recording knows over time.
struct Quantity {
  std::string name;
  std::string unit;
  std::optional<std::string> group = {};  ///< What it is shown together with; none: what its name says.
};

const Table<Mark>& fields_of(const Mark*);
const Table<Quantity>& fields_of(const Quantity*);

/// [x, y, z, qw, qx, qy, qz].
[[nodiscard]] Node flat_pose_node(const Pose& X_WP);

/// SCENE: what stands there, as it is.
[[nodiscard]] Node scene_node(const ViewedRig& rig);

/// CONTROLS: what can be moved how far, as it is believed to be, and the tasks. The range of a tendon is what
/// its sections' limits let it have, where a section without a limit bends by a whole turn.
[[nodiscard]] Node controls_node(const ViewedRig& rig);
/// The same of a live rig: with what a client can move one by one and switch, where there is such a thing,
/// and then without tendons that hang together.
[[nodiscard]] Node live_controls_node(const ViewedRig& rig);

}  // namespace flexura
