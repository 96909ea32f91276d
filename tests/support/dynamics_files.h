#pragma once

#include <string>

namespace flexura {

/// Returns the head of a file: a spatial arm of three sections or a planar one, 1 m long.
inline std::string dynamics_arm(const std::string& kind = "spatial") {
  return "[arm]\nkind = \"" + kind +
         "\"\n[[arm.section]]\nlength = 0.35\n[[arm.section]]\nlength = 0.35\n[[arm.section]]\nlength = "
         "0.3\n";
}

/// Returns a dynamics task with these additional lines, which include `target`.
inline std::string dynamics_task(const std::string& lines) {
  return "[[task]]\nkind = \"dynamics\"\ndensity = 0.5\nbending_stiffness = 0.2\ndamping = 0.05\n" + lines;
}

inline const std::string bent_target = "target.bends = [[0.5, -0.3], [0.4, 0.2], [0.3, -0.2]]\n";

}  // namespace flexura
