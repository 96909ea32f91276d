#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"

// Motions of a planar arm that are given as chord angles, independently for each section. A section's bend
// depends on the chord angles of all previous sections (eq. 5). Hence these motions are evaluated as chord
// angles and converted to bends at each time.
namespace flexura {

/// Returns a motion between two states of a planar arm. The chord angle of section i changes by
/// `cord_changes[i]` rad, and the section's stretch changes linearly. Angle and stretch of section i follow
/// the time profile `profiles[i]`. `to` is the final state. Throws std::invalid_argument unless there are one
/// change and one profile per section, and all profiles have equal durations.
[[nodiscard]] MotionPtr cord_point_to_point_motion(ArmState from, ArmState to,
                                                   std::vector<double> cord_changes,
                                                   std::vector<Profile> profiles);

/// Returns a sinusoidal motion of a planar arm. The chord angle of section i is cord_i(0) + amplitude_i
/// (sin(2 pi t / period + phase_i) - sin(phase_i)). Amplitudes and phases are in rad. The period, which must
/// be above 0, and the duration are in s. Throws std::invalid_argument unless there are one amplitude and one
/// phase per section.
[[nodiscard]] MotionPtr cord_sine_motion(ArmState from, const std::vector<double>& amplitudes,
                                         const std::vector<double>& phases, double period, double duration);

}  // namespace flexura
