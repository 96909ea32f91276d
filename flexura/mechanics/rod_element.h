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
/// All quantities are in the frame of the rod's base; twists and wrenches are about its origin. So a mode
/// moves all points distal of its section with the same twist, and wrenches can be added.
class RodElement {
 public:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// `at`: places of the part, from 0 to 1, that become nodes.
  RodElement(RodPart part, std::span<const TendonRoute> tendons, std::span<const double> at);

  [[nodiscard]] const RodPart& part() const { return part_; }

  [[nodiscard]] int size() const { return grid_.size; }
  [[nodiscard]] const RodGrid& grid() const { return grid_; }
  [[nodiscard]] double length() const { return length_; }
  /// Returns whether tendons run straight between disks (as chords). The forces of such tendons depend on the
  /// poses of the disks, not only on strains.
  [[nodiscard]] bool has_chords() const { return !grid_.disks.empty(); }

  /// Sets the section's undeformed length to this factor times the original length.
  void stretch_rest(double factor) { grid_.stretch_rest(factor); }
  /// Sets the mode values, `size()`.
  void set_modes(const Eigen::Ref<const Eigen::VectorXd>& q);
  [[nodiscard]] const Eigen::VectorXd& modes() const { return q_; }
  /// Computes node poses for this pose of the section's base.
  void place(const Pose& X_BS);
  /// Computes node poses and their derivatives with respect to the modes (columns()).
  void place_with_columns(const Pose& X_BS);
  /// Strains at the nodes.
  [[nodiscard]] const std::vector<Vector6d>& strains() const { return strain_; }
  /// Poses of the nodes, z along the rod.
  [[nodiscard]] const std::vector<Pose>& poses() const { return X_; }
  /// Derivatives of the twist of each node with respect to the modes, 6 x size().
  [[nodiscard]] const std::vector<Columns>& columns() const { return A_; }

  /// Returns whether the element's modes are too few for its bend between guide disks. An element between two
  /// disks has too few modes if the highest polynomial of a bend is not small. A whole section has too few
  /// modes if the distance between rod and chord is not small relative to the tendons' distance from the
  /// backbone.
  [[nodiscard]] bool is_coarse() const;

  /// Wrap angle of a tendon between its base and the end of an element. `turned`: wrap angle, rad.
  /// `direction`: direction of the tendon in the frame of the element's end. At the base, angle and direction
  /// are zero.
  struct Run {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  };
  /// Derivative of a run with respect to a change of the modes of all sections.
  struct RunChange {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    Vector6d base = Vector6d::Zero();  ///< Twist of the next section's base.
  };
  /// Follows a tendon through the section. On entry `run` refers to the section's base, on return to its end.
  /// Stores for stress() the fraction of the tension that remains at each node because of friction. Sections
  /// with chords require the poses.
  void rub(std::size_t tendon, double friction, Run& run);
  /// Computes the change of the last result of rub() due to a change dq of the modes. Adds the effect of the
  /// change of friction to `residual_change`. `run` is updated as in rub(). Sections with chords require the
  /// columns.
  void rub_change(std::size_t tendon, double friction, double tension, const Eigen::VectorXd& dq, Run& run,
                  RunChange& change, Eigen::Ref<Eigen::VectorXd> residual_change) const;
  /// Computes residual, tangent, tendon lengths and their derivatives from internal and tendon forces.
  /// `tension`: tension of each tendon of the rod at its base, N. Sections with chords require computed
  /// columns. The tangent does not include the change of friction with the turning angle.
  void stress(std::span<const double> tension);
  /// Adds `share` times the loads. `beyond`: wrench of all loads on distal sections. Requires the columns.
  void load(const RodLoads& loads, double share, const Vector6d& beyond);
  /// Adds the geometric stiffness of chords and loads to the tangent. Must be called last.
  void add_bending();

  /// Returns the second derivative of the section's strain energy with respect to its modes, size() x size().
  /// This derivative does not depend on the shape.
  [[nodiscard]] Eigen::MatrixXd stiffness() const;
  /// Returns minus the work of the loads without moments, J; it is 0 for loads at the base's origin. Requires
  /// the poses. Follower loads have no potential and count as dead loads.
  [[nodiscard]] double load_energy(const RodLoads& loads) const;

  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Adds the residual's derivative with respect to relative changes of the section's stiffness against
  /// shear, stretch, bends and twist.
  void add_stiffness_slopes(Eigen::Ref<Eigen::MatrixXd> slopes) const;
  /// Adds to `slope` the residual's derivative with respect to a relative change of the section's mass per
  /// length, and to `all` the wrench of its weight. Requires the columns.
  void add_weight_slope(const Eigen::Vector3d& gravity, Vector6d& all,
                        Eigen::Ref<Eigen::VectorXd> slope) const;
  // NOLINTEND(performance-unnecessary-value-param)

  /// Gradient of the section's energy with respect to its modes, minus the generalized forces of the loads.
  Eigen::VectorXd residual;
  /// Derivative of the residual with respect to the section's modes.
  Eigen::MatrixXd tangent;
  /// Minus the derivative of the residual with respect to a twist of the section's base, size() x 6.
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_base;
  /// Derivative of the residual with respect to the share of the loads.
  Eigen::VectorXd by_share;
  /// Derivative of `wrench`, times the share of the loads, with respect to the section's modes.
  Columns wrench_by_modes;
  /// Derivative of `wrench`, times the share of the loads, with respect to a twist of the section's base.
  Matrix6d wrench_by_base = Matrix6d::Zero();
  /// Wrench of the section's full loads.
  Vector6d wrench = Vector6d::Zero();
  /// `tendon_lengths`: length of each tendon of the rod within the section, m. `length_slopes`: derivative of
  /// these lengths with respect to the modes, size() x tendons. `pull_slopes`: derivative of the residual
  /// with respect to the tensions at the base, equal to `length_slopes` without friction.
  Eigen::VectorXd tendon_lengths;
  Eigen::MatrixXd length_slopes, pull_slopes;
  /// Strain energy, J.
  double strain_energy = 0;
  /// Length of the shortest straight piece of a taut tendon between two disks, as a fraction of the
  /// undeformed length of the rod between these disks. The value is 1 if there is no such piece.
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
  // For each node: the wrench on it, and its derivative with respect to the node's twist.
  std::vector<Vector6d> F_;
  std::vector<Matrix6d> D_;
  Columns step_, moved_, turned_;  // Space for columns.
};

}  // namespace flexura
