#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"

// Laws for the cord angles of a planar arm, independent for each section. A section's bend depends on all
// previous cords (eq. 5), so such a law is not a law of the bends. It is evaluated in cord angles and
// converted to bends at each time.
namespace flexura {

/// Returns a motion between two states of a planar arm. Section i's cord angle changes by `cord_changes[i]`
/// rad, and its stretch linearly, both by its time profile. `to` is the final state. Throws
/// std::invalid_argument unless there are one change and one profile per section, and all profiles have one
/// duration.
[[nodiscard]] MotionPtr cord_point_to_point_motion(ArmState from, ArmState to,
                                                   std::vector<double> cord_changes,
                                                   std::vector<Profile> profiles);

/// Returns cord_i(t) = cord_i(0) + amplitude_i (sin(2 pi t / period + phase_i) - sin(phase_i)) for a planar
/// arm. Throws std::invalid_argument unless there are one amplitude (rad) and one phase (rad) per section.
/// The period, above 0, and the duration are in s.
[[nodiscard]] MotionPtr cord_sine_motion(ArmState from, const std::vector<double>& amplitudes,
                                         const std::vector<double>& phases, double period, double duration);

}  // namespace flexura
