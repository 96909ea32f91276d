#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/magnus.h"
#include "flexura/math/pose.h"
#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_grid.h"
#include "flexura/mechanics/rod_parts.h"

namespace flexura {

/// Evaluation of one part of a rod, which is a section or a piece of it: its shape, and the balance of its
/// internal forces with the loads. Allocates only in the constructor.
///
/// All in the frame of the rod's base. Twists and wrenches are about its origin. So a Jacobian column is
/// constant distal of what it moves, and wrenches add up directly.
class RodElement {
 public:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// `at`: places of the part, from 0 to 1, that become nodes.
  RodElement(RodPart part, std::span<const TendonRoute> tendons, std::span<const double> at);

  [[nodiscard]] const RodPart& part() const { return part_; }

  [[nodiscard]] int size() const { return grid_.size; }
  [[nodiscard]] const RodGrid& grid() const { return grid_; }
  [[nodiscard]] double length() const { return length_; }
  /// Whether its tendons' forces depend on the relative poses of its parts, not on strains only.
  [[nodiscard]] bool has_chords() const { return !grid_.disks.empty(); }

  /// Sets the section's undeformed length to this factor times the original one.
  void stretch_rest(double factor) { grid_.stretch_rest(factor); }
  /// Sets the mode values, `size()`.
  void set_modes(const Eigen::Ref<const Eigen::VectorXd>& q);
  [[nodiscard]] const Eigen::VectorXd& modes() const { return q_; }
  /// Computes node poses for a pose of its base.
  void place(const Pose& X_BS);
  /// Computes node poses and their derivatives by the modes (columns()).
  void place_with_columns(const Pose& X_BS);
  /// Strains at the nodes.
  [[nodiscard]] const std::vector<Vector6d>& strains() const { return strain_; }
  /// Poses of the nodes, z along the rod.
  [[nodiscard]] const std::vector<Pose>& poses() const { return X_; }
  /// Twist of each node by each mode, 6 x size().
  [[nodiscard]] const std::vector<Columns>& columns() const { return A_; }

  /// Whether its modes are too few for its bend between guide disks: with a piece of its own, the highest
  /// polynomial of a bend is not small; else the rod lies beside the chord by a part of the tendons'
  /// distance.
  [[nodiscard]] bool is_coarse() const;

  /// Path of a tendon since its base: the turning angle, rad, and its direction in the frame of a section's
  /// end; zero at the base.
  struct Run {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  };
  /// Derivative of a run by a change of the modes of all sections.
  struct RunChange {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    Vector6d base = Vector6d::Zero();  ///< Twist of the next section's base.
  };
  /// Follows a tendon of the rod through the section, from its run at the base to that at the end. Keeps the
  /// part of its tension that friction leaves at each node for stress(). Chords need the poses.
  void rub(std::size_t tendon, double friction, Run& run);
  /// Follows the effect of a change dq of the modes on the last result of rub(), and adds the change of
  /// friction to the residual's change. `run`: at the base, advanced as in rub(). Chords need the columns.
  void rub_change(std::size_t tendon, double friction, double tension, const Eigen::VectorXd& dq, Run& run,
                  RunChange& change, Eigen::Ref<Eigen::VectorXd> residual_change) const;
  /// Balances internal and tendon forces: residual, tangent, tendon lengths and their derivatives. `tension`:
  /// at the base, N, one a tendon of the rod. Chords need the columns. Friction is frozen: its change with
  /// the turning angle is not in the tangent.
  void stress(std::span<const double> tension);
  /// Adds `share` of the loads, where `beyond` is the wrench of all loads on distal sections. Requires the
  /// columns.
  void load(const RodLoads& loads, double share, const Vector6d& beyond);
  /// To be called last: adds the effect of chords and loads on the intervals' twists to the tangent.
  void add_bending();

  /// Returns the second derivative of its strain energy by its modes, size() x size(); equal in all shapes.
  [[nodiscard]] Eigen::MatrixXd stiffness() const;
  /// Returns minus the work of loads without moments from the base's origin on, J. Requires the poses.
  /// Follower loads have no potential and count as dead loads.
  [[nodiscard]] double load_energy(const RodLoads& loads) const;

  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Adds the residual's derivative by relative changes of its stiffness against shear, stretch, bends and
  /// twist.
  void add_stiffness_slopes(Eigen::Ref<Eigen::MatrixXd> slopes) const;
  /// Adds the derivative by a relative change of its mass per length, and the total wrench of that mass.
  /// Requires the columns.
  void add_weight_slope(const Eigen::Vector3d& gravity, Vector6d& all,
                        Eigen::Ref<Eigen::VectorXd> slope) const;
  // NOLINTEND(performance-unnecessary-value-param)

  /// Gradient of its energy by its modes, minus the loads.
  Eigen::VectorXd residual;
  /// Derivative of the residual by its modes.
  Eigen::MatrixXd tangent;
  /// Derivative of the residual by a twist of its base, size() x 6, negated.
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_base;
  /// Derivative of the residual by the share of the loads.
  Eigen::VectorXd by_share;
  /// Derivative of the wrench of the given share of its loads, by its modes and by a twist of its base.
  Columns wrench_by_modes;
  Matrix6d wrench_by_base = Matrix6d::Zero();
  /// Wrench of all of its loads.
  Vector6d wrench = Vector6d::Zero();
  /// Length of each tendon of the rod in it, m, and its derivative by the modes, size() x tendons. The
  /// residual's derivative by the tensions at the base (`pull_slopes`) equals it without friction.
  Eigen::VectorXd tendon_lengths;
  Eigen::MatrixXd length_slopes, pull_slopes;
  /// Strain energy, J.
  double strain_energy = 0;
  /// Shortest straight piece of a taut tendon between two disks, as a part of the undeformed length of the
  /// rod between them; 1 without any.
  double least_chord = 1;

 private:
  // Passage of a tendon at a node.
  struct Passage {
    Eigen::Vector3d offset, slope, second;
    double left = 1;  // Remaining part of the tension at the tendon's base; for a chord that begins here.
  };
  [[nodiscard]] static Eigen::Vector3d way(const Passage& passage, const Vector6d& strain);
  [[nodiscard]] static Eigen::Vector3d path_slope(const Passage& passage, const Vector6d& strain,
                                                  const Vector6d& slope);
  [[nodiscard]] Vector6d strain_slope(std::size_t node) const;
  [[nodiscard]] const std::vector<Passage>* passages_of(std::size_t tendon) const;
  // Adds the geometric stiffness of a wrench, by which intervals turn each other.
  void add_geometry(std::size_t interval, const Vector6d& W, std::size_t from, double factor);
  void add_chords(std::size_t from, std::size_t to, std::span<const double> tensions);
  void find_forces(const RodLoads& loads);
  void add_block(const Matrix6d& block, const Eigen::MatrixXd& left, const Eigen::MatrixXd& right,
                 std::size_t column, double factor);
  [[nodiscard]] MagnusStep::Moments moments_of(std::size_t interval) const;

  RodPart part_;
  RodGrid grid_;
  double length_;
  // Tendons through this section: their indices in the rod's list, and their passages at the nodes.
  std::vector<std::size_t> tendons_;
  std::vector<std::vector<Passage>> passages_;

  Eigen::VectorXd q_, rates_, by_place_;
  std::vector<Vector6d> strain_;  // At the nodes.
  std::vector<Pose> X_;
  std::vector<Columns> A_;
  // For each interval: its twist by the moments of its strain, and exp of the twist.
  std::vector<MagnusStep> twist_;
  std::vector<MagnusStep::Slopes> by_moments_;
  std::vector<TwistExponential> exp_;
  std::vector<Vector6d> across_;  // Wrench of chords and loads on everything beyond the interval.
  // For each node: the wrench on it, and its derivative by the node's twist.
  std::vector<Vector6d> F_;
  std::vector<Matrix6d> D_;
  Columns step_, moved_, turned_;  // Space for columns.
};

}  // namespace flexura
