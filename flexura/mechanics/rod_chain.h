#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_element.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A rod's sections joined: what its modes q make of it, the balance r(q) of all that pulls, and linear
/// systems with r's derivative, at a cost that grows with the number of sections alone. For r = 0 the rod is
/// in equilibrium; r is then the gradient of the total energy, if loads have one. In the frame of the base.
///
/// A section feels of those before it only the twist of its base, and of those after it only a wrench; so
/// from the tip to the base each section's modes are eliminated, as in the articulated-body algorithm (R.
/// Featherstone, Rigid Body Dynamics Algorithms, ch. 7).
class RodChain {
 public:
  /// `places` are nodes, so that their poses are known without interpolation. std::invalid_argument: the
  /// problems of the rod, or a place outside it.
  explicit RodChain(Rod rod, std::span<const RodPlace> places = {});

  [[nodiscard]] const Rod& rod() const { return rod_; }
  /// Of q.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] std::size_t tendons() const { return rod_.tendons.size(); }
  /// Of each mode: what makes it a number without a unit. A section's length for bends and twists, which
  /// become radians, 1 for stretch and shear.
  [[nodiscard]] const Eigen::VectorXd& scales() const { return scales_; }
  [[nodiscard]] const std::vector<RodElement>& elements() const { return elements_; }
  /// q of element i starts here.
  [[nodiscard]] Eigen::Index first(std::size_t element) const { return first_[element]; }

  /// Each section's own length at rest becomes a factor of what the rod says, one a section, each > 0: of
  /// sections that something drives longer or shorter. Arc lengths at rest, and what is counted by them, stay
  /// those of the rod. std::invalid_argument: another number of factors, or a factor that is not above 0.
  void stretch_rest(std::span<const double> factors);

  /// Balances the rod at q under tensions, N, and a share of the loads.
  void balance(const Eigen::VectorXd& q, std::span<const double> tensions, const RodLoads& loads,
               double share);
  /// Of the last balance: r, size(); the tendons' lengths, m; these by q, size() x tendons(); r by the
  /// tensions at the base, which is the same where there is no friction.
  [[nodiscard]] const Eigen::VectorXd& residual() const { return residual_; }
  [[nodiscard]] const Eigen::VectorXd& tendon_lengths() const { return lengths_; }
  [[nodiscard]] const Eigen::MatrixXd& length_slopes() const { return slopes_; }
  [[nodiscard]] const Eigen::MatrixXd& pull_slopes() const { return pull_slopes_; }
  /// r by the share of the loads, size().
  [[nodiscard]] const Eigen::VectorXd& load_slope() const { return load_slope_; }
  [[nodiscard]] double strain_energy() const;
  /// Of the last balance: minus the work of all of the loads from the base's origin on, J. It is an energy
  /// where has_energy().
  [[nodiscard]] double load_energy(const RodLoads& loads) const;
  /// Whether r is the gradient of an energy under these loads: no moments, no loads that follow, no friction.
  [[nodiscard]] bool has_energy(const RodLoads& loads) const;

  /// Factors the derivative of r at the last balance, with `share` of the stiffness of the rod itself added.
  /// False: it has no inverse.
  bool factor(double share = 0);
  /// The stiffness of the rod itself, a second derivative of its energy, times dq, size().
  [[nodiscard]] Eigen::VectorXd stiffness_times(const Eigen::VectorXd& dq) const;
  /// How large a residual is: the square root of what the rod's strains would cost if it pulled alone, J^1/2.
  [[nodiscard]] double stiffness_norm(const Eigen::VectorXd& residual) const;
  /// How many negative eigenvalues it has, as the elimination counts them; 0: the rod is stable while
  /// tensions and loads stay. Of loads without an energy (moments, loads that follow) 1 where its determinant
  /// is negative, else 0: the rod does not fall aside slowly; whether it flutters is a matter of its mass.
  [[nodiscard]] int negative_count() const { return negative_; }
  /// The same of the derivative where tendons that are held add what they do: `of_give` is how many negative
  /// eigenvalues the tendons' give has.
  [[nodiscard]] int negative_count(int of_give) const {
    return is_symmetric_ ? negative_ - of_give : (negative_ + of_give) % 2;
  }
  /// rhs becomes what the derivative makes to rhs; size() x columns.
  void solve(Eigen::Ref<Eigen::MatrixXd> rhs);

  /// r at the last balance by each section's parameters, size() x 5 sections: by parts by which its stiffness
  /// against shear, stretch, bends and twist changes, and its mass along its length under this gravity. The
  /// columns are there.
  [[nodiscard]] Eigen::MatrixXd parameter_slopes(const Eigen::Vector3d& gravity) const;

  /// Whether tendons rub, as they do from the beginning.
  void set_rubbing(bool on) { is_rubbing_ = on; }
  /// Whether a tendon rubs: then the derivative that is factored leaves out that friction changes with q.
  [[nodiscard]] bool has_friction() const;
  /// What that is along dq, of the residual at the last balance under these tensions.
  [[nodiscard]] Eigen::VectorXd friction_change(const Eigen::VectorXd& dq,
                                                std::span<const double> tensions) const;

  /// That of every mode: size() x size().
  [[nodiscard]] Eigen::MatrixXd friction_form(std::span<const double> tensions) const;

  /// Poses of all nodes at q. Balance finds them, with columns, only where loads or chords need them.
  void place(const Eigen::VectorXd& q);
  /// The same, with columns.
  void place_with_columns(const Eigen::VectorXd& q);
  [[nodiscard]] const Pose& tip() const { return elements_.back().poses().back(); }
  /// The twist of a node by q, 6 x size(), about the base's origin; after place_with_columns(). An Eigen::Ref
  /// is written through.
  void columns_at(std::size_t element, std::size_t node, Eigen::Ref<RodElement::Columns> J) const;

 private:
  struct Pivot {
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    bool is_definite = false;
    Eigen::MatrixXd matrix;                            // Condensed.
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_base;  // dq by the twist of the base.
    RodElement::Columns wrench_by_modes;               // Of all from this section on.
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
  // Of each element, once somebody asks.
  mutable std::vector<Eigen::MatrixXd> stiffness_;
  mutable std::vector<Eigen::LLT<Eigen::MatrixXd>> stiffness_factors_;
};

}  // namespace flexura
