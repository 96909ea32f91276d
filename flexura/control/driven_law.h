#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/control/distributed_arm.h"

// A law for every point of an arm, and drives for a few numbers of it (docs/control.md, "Finitely many
// drives").
namespace flexura {

/// G, size() rows, 2 columns a section and then one for each length that varies: drives that turn a section
/// as a whole. Column 2k is the torque on theta alike along section k, 2k + 1 that on q (N m a length), all
/// sections; then the forces (N) that change their lengths, where these vary. Its own numbers are y = G^T x:
/// the integrals of the angles over a section.
[[nodiscard]] Eigen::MatrixXd section_torques(const DistributedArm& arm);

/// G of drives that bend: column 2k is the moment (N m) on the change of theta from section k's base to its
/// end, 2k + 1 that of q; then the lengths' forces. Tendons that end with section k and are counted from its
/// base pull so. y = G^T x: what the sections turn by (a clamped base's own angles left out).
[[nodiscard]] Eigen::MatrixXd section_moments(const DistributedArm& arm);

/// What gives an arm a law's forces.
enum class DriveKind : std::uint8_t {
  everywhere,  ///< Each point of the arm is driven by itself.
  torques,     ///< section_torques
  moments,     ///< section_moments
};
/// G of drives of this kind; empty where everything is driven.
[[nodiscard]] Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind);

/// The drives' forces whose effect G f is nearest to generalized forces.
struct ProjectedForce {
  Eigen::VectorXd drives;  ///< f
  Eigen::VectorXd force;   ///< G f
  double left_over = 0;    ///< |Q - G f| / |Q|: 0 where the drives can give it; W falls there.
};
/// The least of |Q - G f|, and of the f that reach it the shortest. std::invalid_argument: a Q of another
/// size than G has rows.
[[nodiscard]] ProjectedForce project_on_drives(const Eigen::MatrixXd& G, const Eigen::VectorXd& Q);

/// The artificial potential on the drives' own numbers y = G^T x alone (docs/control.md, eq. 12):
///   f = f_d - k (y - y_d) - K dy/dt,
/// where the constant f_d holds the arm at the target. Then
///   W = T + V_g + V_e - V(x_d) - f_d . (y - y_d) + 1/2 k |y - y_d|^2
/// falls, dW/dt = -dy/dt K dy/dt - the arm's own damping, whatever the arm has beside y: gravity and
/// elasticity are not compensated but part of W, so they must leave it a minimum at the target.
class DrivenLaw {
 public:
  /// std::invalid_argument: sizes that do not fit, numbers that are not finite.
  DrivenLaw(const DistributedArm& arm, Eigen::MatrixXd G, Eigen::VectorXd target, double stiffness,
            double damping);

  /// Which conditions do not hold, in words: the drives cannot hold the arm there, W has no minimum there, a
  /// damping that is not positive.
  [[nodiscard]] std::vector<std::string> violations() const;

  /// The generalized forces Q = G f in the state (x, v).
  void force(const Eigen::VectorXd& x, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const;
  /// W - T of an arm in the state x, to which it is set, J.
  [[nodiscard]] double potential(const DistributedArm& arm, const Eigen::VectorXd& x) const;
  /// What the law takes, W.
  [[nodiscard]] double dissipation(const Eigen::VectorXd& v) const;
  /// f_d
  [[nodiscard]] const Eigen::VectorXd& holding() const { return holding_; }

 private:
  Eigen::MatrixXd G_;
  Eigen::VectorXd target_, holding_;
  double stiffness_, damping_;
  double energy_at_target_ = 0;
  double not_held_ = 0;         // |dV/dx - G f_d| / |dV/dx| at the target
  double least_curvature_ = 0;  // Of W at the target.
};

}  // namespace flexura
