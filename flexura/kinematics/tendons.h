#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// Converts bends to tendon lengths and back (docs/drives.md). Every function throws std::invalid_argument for
// a tendon that ends at a section that the arm does not have. Every function also throws
// std::invalid_argument for a state that does not have one bend and one stretch per section. The formulas
// assume inextensible tendons, and that no tendon is beyond the centre of a bend (curvature times radius
// below 1).
namespace flexura {

/// Returns the displacement of each tendon, m: the tendon's length along the straight, unstretched arm minus
/// its length in `state`. In a continuous channel, the length of a tendon within a section is exactly length
/// * stretch - offset . bend. With guide disks that divide the section into n pieces, the length is
/// sinc(|bend| / 2n) times as large. Includes the wraps if the drive loses travel by friction.
[[nodiscard]] TendonDisplacements tendon_displacements(const Arm& arm, const Drive& drive,
                                                       const ArmState& state);

/// Returns the angle by which each tendon turns between the arm's base and its end, rad: the sum of |bend| of
/// the sections that it passes.
[[nodiscard]] std::vector<double> tendon_wraps(const Arm& arm, const Drive& drive, const ArmState& state);

/// Returns the Jacobian of the displacements with respect to (bend_x, bend_y, stretch) of every section: one
/// row per tendon, three columns per section. In a continuous channel, the Jacobian is equal in all states,
/// because displacements are linear in bends and stretches.
[[nodiscard]] Eigen::MatrixXd tendon_jacobian(const Arm& arm, const Drive& drive, const ArmState& state);

/// State of the arm that fits tendon displacements best.
struct TendonFit {
  ArmState state;  ///< Fitted state of the arm.
  /// Displacement of each tendon minus its displacement in `state`, m. A tendon with a positive residual
  /// pulls against the others. A tendon with a negative residual is slack. The residuals are zero if the
  /// displacements are consistent.
  TendonDisplacements residual;
  /// Whether a fit was found. The value can be false only with guide disks; then `state` is the last iterate.
  bool converged = true;
};

/// Returns the state for tendon displacements: bends, and stretches of stretchable sections. The fit is exact
/// if an exactly fitting state exists. If no state fits exactly, the result is a least-squares fit, section
/// by section from the base. In a continuous channel, this equals the least-squares fit to all tendons.
/// bend_y of planar arms is 0. If the tendons do not determine a section, the result is the solution nearest
/// to straight.
[[nodiscard]] TendonFit fit_state(const Arm& arm, const Drive& drive,
                                  const TendonDisplacements& displacements);

/// Returns an upper bound on the speed |d displacement/dt| of each tendon, m/s. The bounds hold in every
/// state within the stretch limits if no section changes faster than `rates` (one per section).
[[nodiscard]] std::vector<double> tendon_speed_bounds(const Arm& arm, const Drive& drive,
                                                      std::span<const SectionRates> rates);

}  // namespace flexura
