#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_element.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A node of a rod: its element, and its index among that element's nodes.
struct RodNode {
  std::size_t element = 0, node = 0;

  bool operator==(const RodNode&) const = default;
};

/// The elements of a rod, joined in a chain: its sections, or their pieces between guide disks (rod_parts.h).
/// Computes the shape for modes q, and the residual r(q) of the balance of all generalized forces. Solves
/// linear systems with r's derivative, at a cost linear in the number of elements. For r = 0 the rod is in
/// equilibrium. If the loads have an energy, r is the gradient of the total energy. All quantities are in the
/// frame of the base.
///
/// Proximal elements affect an element only by the twist of its base, and distal elements only by a wrench.
/// So the modes are eliminated element by element from tip to base, as in the articulated-body algorithm
/// (Featherstone, Rigid Body Dynamics Algorithms, ch. 7).
class RodChain {
 public:
  /// `places` become nodes, so that their poses need no interpolation. Throws std::invalid_argument for an
  /// invalid rod or a place outside the rod.
  explicit RodChain(Rod rod, std::span<const RodPlace> places = {});

  [[nodiscard]] const Rod& rod() const { return rod_; }
  /// Returns the number of modes.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] std::size_t tendons() const { return rod_.tendons.size(); }
  /// Returns for each mode the factor that makes the mode dimensionless. The factor is the section's length
  /// for bends and twists, which become radians, and 1 for stretch and shear.
  [[nodiscard]] const Eigen::VectorXd& scales() const { return scales_; }
  [[nodiscard]] const std::vector<RodElement>& elements() const { return elements_; }
  /// Returns the node at a place. If there is no node at the place, returns the nearest node of the same
  /// element. Throws std::invalid_argument for a place outside the rod.
  [[nodiscard]] RodNode node_of(const RodPlace& place) const;
  /// Returns the section, if any, that has too few modes for the bend between its guide disks at the last
  /// balance().
  [[nodiscard]] std::optional<std::size_t> coarse_section() const;
  /// Returns the index in q of the first mode of element i.
  [[nodiscard]] Eigen::Index first(std::size_t element) const { return first_[element]; }

  /// Multiplies the undeformed length of each section by a factor > 0, for sections with driven lengths. Arc
  /// lengths still refer to the original rod. Throws std::invalid_argument for a wrong number of factors, or
  /// a factor that is not positive.
  void stretch_rest(std::span<const double> factors);

  /// Computes the residual r at q under the tensions at the base, N, and `share` times the loads.
  void balance(const Eigen::VectorXd& q, std::span<const double> tensions, const RodLoads& loads,
               double share);
  /// Returns r at the last balance(), size().
  [[nodiscard]] const Eigen::VectorXd& residual() const { return residual_; }
  /// Returns the tendon lengths at the last balance(), m.
  [[nodiscard]] const Eigen::VectorXd& tendon_lengths() const { return lengths_; }
  /// Returns the derivatives of the tendon lengths with respect to q at the last balance(), size() x
  /// tendons().
  [[nodiscard]] const Eigen::MatrixXd& length_slopes() const { return slopes_; }
  /// Returns the derivative of r with respect to the tensions at the base at the last balance(), size() x
  /// tendons(). Without friction the result equals length_slopes().
  [[nodiscard]] const Eigen::MatrixXd& pull_slopes() const { return pull_slopes_; }
  /// Returns the derivative of r with respect to the share of the loads at the last balance(), size().
  [[nodiscard]] const Eigen::VectorXd& load_slope() const { return load_slope_; }
  [[nodiscard]] double strain_energy() const;
  /// Returns whether a tendon pulled the holes of two guide disks together at the last balance(). Real disks
  /// would touch earlier. Shapes with a larger bend cannot be equilibria.
  [[nodiscard]] bool disks_meet() const;
  /// Returns minus the work of all loads at the last balance, J; it is 0 for loads at the base's origin. The
  /// result is a potential energy if has_energy().
  [[nodiscard]] double load_energy(const RodLoads& loads) const;
  /// Returns whether r is the gradient of an energy under these loads. An energy exists if there are no
  /// moments, follower loads and friction.
  [[nodiscard]] bool has_energy(const RodLoads& loads) const;

  /// Factors the derivative of r at the last balance plus `share` times the rod's stiffness. Returns false if
  /// the factored derivative is singular.
  bool factor(double share = 0);
  /// Returns K dq with the stiffness K, the second derivative of the strain energy; size().
  [[nodiscard]] Eigen::VectorXd stiffness_times(const Eigen::VectorXd& dq) const;
  /// Returns the norm of a residual, J^1/2: the square root of the strain energy that this residual alone
  /// would cause.
  [[nodiscard]] double stiffness_norm(const Eigen::VectorXd& residual) const;
  /// Returns the number of negative eigenvalues of the factored derivative. If the number is 0, the rod is
  /// stable at constant tensions and loads. With moments or follower loads the result is 1 if the determinant
  /// is negative, otherwise 0. This detects static divergence but not flutter, which depends on the mass.
  [[nodiscard]] int negative_count() const { return negative_; }
  /// Returns the number of negative eigenvalues for tendons held at their displacements. `of_give`: number of
  /// negative eigenvalues of the tendons' compliance matrix.
  [[nodiscard]] int negative_count(int of_give) const {
    return is_symmetric_ ? negative_ - of_give : (negative_ + of_give) % 2;
  }
  /// Replaces the right-hand sides rhs by their solutions; size() x columns.
  void solve(Eigen::Ref<Eigen::MatrixXd> rhs);

  /// Returns the derivatives of r at the last balance with respect to each section's five parameters, size()
  /// x 5 sections. Parameters are relative changes of its stiffness against shear, stretch, bends and twist,
  /// and of its mass per length under this gravity. Requires place_with_columns().
  [[nodiscard]] Eigen::MatrixXd parameter_slopes(const Eigen::Vector3d& gravity) const;

  /// Switches tendon friction on or off; initially on.
  void set_rubbing(bool on) { is_rubbing_ = on; }
  /// Returns whether a tendon has friction. If so, the factored derivative neglects the change of friction
  /// with q.
  [[nodiscard]] bool has_friction() const;
  /// Returns the change of the residual along dq that the factored derivative neglects because of friction,
  /// at the last balance under these tensions.
  [[nodiscard]] Eigen::VectorXd friction_change(const Eigen::VectorXd& dq,
                                                std::span<const double> tensions) const;

  /// Returns the part of the derivative of r with respect to all modes that the factored derivative neglects,
  /// size() x size().
  [[nodiscard]] Eigen::MatrixXd friction_form(std::span<const double> tensions) const;

  /// Computes the poses of all nodes at q. balance() computes poses and columns only if loads or chords
  /// depend on poses.
  void place(const Eigen::VectorXd& q);
  /// Computes poses, and columns (the derivatives of node twists with respect to q).
  void place_with_columns(const Eigen::VectorXd& q);
  /// Returns the pose of a node, after place() or place_with_columns().
  [[nodiscard]] const Pose& pose(const RodNode& at) const { return elements_[at.element].poses()[at.node]; }
  [[nodiscard]] const Pose& tip() const { return elements_.back().poses().back(); }
  /// Writes the derivative of a node's twist about the base's origin with respect to q into J, 6 x size().
  /// Requires place_with_columns().
  void columns_at(std::size_t element, std::size_t node, Eigen::Ref<RodElement::Columns> J) const;

 private:
  struct Pivot {
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    bool is_definite = false;
    Eigen::MatrixXd matrix;                            // Condensed.
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_base;  // dq by the twist of the base.
    RodElement::Columns wrench_by_modes;               // Sum over this section and all distal ones.
  };
  void find_stiffness() const;
  static void solve_pivot(const Pivot& pivot, Eigen::Ref<Eigen::MatrixXd> rhs);

  Rod rod_;
  std::vector<RodElement> elements_;
  std::vector<Eigen::Index> first_;
  Eigen::Index size_ = 0;
  Eigen::VectorXd scales_, residual_, load_slope_, lengths_;
  Eigen::MatrixXd slopes_, pull_slopes_;
  bool is_rubbing_ = true, is_loaded_ = false, is_symmetric_ = true, has_chords_ = false;
  int negative_ = 0;
  std::vector<Pivot> pivots_;
  // For each element, on first use.
  mutable std::vector<Eigen::MatrixXd> stiffness_;
  mutable std::vector<Eigen::LLT<Eigen::MatrixXd>> stiffness_factors_;
};

}  // namespace flexura
