#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"

// Laws for the cord angles of a planar arm, each section's on its own. A section's bend depends on all the
// cords before it (eq. 5), so such a law is not one for the bends: it is followed in cord angles, and turned
// into bends at each time.
namespace flexura {

/// From one state of a planar arm to another: section i's cord goes from its angle to `cord_changes[i]` rad
/// more, and its stretch on a straight line, both by its own time profile. `to` is the state where that
/// leads. One change and one profile a section, all profiles of one duration; else std::invalid_argument.
[[nodiscard]] MotionPtr cord_point_to_point_motion(ArmState from, ArmState to,
                                                   std::vector<double> cord_changes,
                                                   std::vector<Profile> profiles);

/// cord_i(t) = cord_i(0) + amplitude_i (sin(2 pi t / period + phase_i) - sin(phase_i)) of a planar arm: one
/// amplitude (rad) and phase (rad) a section, else std::invalid_argument. The period, above 0, and the
/// duration in s.
[[nodiscard]] MotionPtr cord_sine_motion(ArmState from, const std::vector<double>& amplitudes,
                                         const std::vector<double>& phases, double period, double duration);

}  // namespace flexura
