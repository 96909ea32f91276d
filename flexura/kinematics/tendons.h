#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// Bends to tendon lengths and back (docs/drives.md). Every function throws std::invalid_argument for a state
// that does not fit the arm or a tendon that ends at none of its sections. Tendons follow the bends without
// stretching, as long as no tendon lies beyond the centre of a bend (curvature times radius below 1).
namespace flexura {

/// How far each tendon is pulled in, m: its length from base to end on the straight, unstretched arm less
/// that in `state`. In a continuous channel a section adds length * stretch - offset . bend to it, exactly;
/// between guide disks that cut it into n pieces, sinc(|bend| / 2n) times as much.
[[nodiscard]] TendonDisplacements tendon_displacements(const Arm& arm, const Drive& drive,
                                                       const ArmState& state);

/// Derivative of the displacements by every section's (bend_x, bend_y, stretch): one row a tendon, 3 columns
/// a section. In a continuous channel it is the same in every state: the linear map itself.
[[nodiscard]] Eigen::MatrixXd tendon_jacobian(const Arm& arm, const Drive& drive, const ArmState& state);

/// The state that fits displacements best.
struct TendonFit {
  ArmState state;  ///< One bend and one stretch a section.
  /// What each tendon is pulled in beyond what the state asks for, m: where positive it pulls against the
  /// others, where negative it hangs slack. Zero when the displacements agree with each other.
  TendonDisplacements residual;
  bool converged = true;  ///< false: no fit was found (guide disks only); `state` is the last one tried.
};

/// The bends, and the stretch of sections whose limits let them stretch, that make these displacements: exact
/// when there is such a state, otherwise the one whose displacements are nearest by least squares, section by
/// section from the base (in a continuous channel that is the least over all tendons at once). bend_y of
/// planar arms is 0. Where the tendons do not determine a section, the least step from straight.
[[nodiscard]] TendonFit fit_state(const Arm& arm, const Drive& drive,
                                  const TendonDisplacements& displacements);

/// Upper bounds on each tendon's speed |d displacement/dt|, m/s, in any state within the stretch limits whose
/// sections change no faster than `rates` (one a section).
[[nodiscard]] std::vector<double> tendon_speed_bounds(const Arm& arm, const Drive& drive,
                                                      std::span<const SectionRates> rates);

}  // namespace flexura
