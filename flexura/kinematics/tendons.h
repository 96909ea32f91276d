#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// Converts bends to tendon lengths and back (docs/drives.md). Every function throws std::invalid_argument for
// a state that does not fit the arm or a tendon that ends at none of its sections. Tendons follow the bends
// without stretching, if no tendon is beyond the centre of a bend (curvature times radius below 1).
namespace flexura {

/// Returns the displacement of each tendon, m: its length from base to end on the straight, unstretched arm
/// minus that in `state`. In a continuous channel, a section contributes exactly length * stretch - offset .
/// bend to its length. Between guide disks that cut the section into n pieces, it contributes sinc(|bend| /
/// 2n) times as much.
[[nodiscard]] TendonDisplacements tendon_displacements(const Arm& arm, const Drive& drive,
                                                       const ArmState& state);

/// Returns the derivative of the displacements by every section's (bend_x, bend_y, stretch): one row per
/// tendon, 3 columns per section. In a continuous channel it is the same in every state: the linear map
/// itself.
[[nodiscard]] Eigen::MatrixXd tendon_jacobian(const Arm& arm, const Drive& drive, const ArmState& state);

/// State that fits displacements best.
struct TendonFit {
  ArmState state;  ///< One bend and one stretch per section.
  /// Displacement of each tendon minus that of the state, m. If positive the tendon pulls against the others;
  /// if negative it is slack. Zero if the displacements are consistent.
  TendonDisplacements residual;
  bool converged = true;  ///< False: no fit was found (guide disks only); `state` is the last one tried.
};

/// Returns the bends, and the stretch of stretchable sections, for these displacements. Exact if such a state
/// exists, otherwise the least-squares fit, section by section from the base. In a continuous channel that is
/// the least-squares fit over all tendons at once. bend_y of planar arms is 0. Where the tendons do not
/// determine a section, takes the least step from straight.
[[nodiscard]] TendonFit fit_state(const Arm& arm, const Drive& drive,
                                  const TendonDisplacements& displacements);

/// Returns upper bounds on each tendon's speed |d displacement/dt|, m/s. They hold in any state within the
/// stretch limits if its sections change no faster than `rates` (one per section).
[[nodiscard]] std::vector<double> tendon_speed_bounds(const Arm& arm, const Drive& drive,
                                                      std::span<const SectionRates> rates);

}  // namespace flexura
