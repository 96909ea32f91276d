#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Viscous descent of a rod's potential energy from any shape to an equilibrium, as if the rod had no mass
/// and a viscosity in proportion to its stiffness. Each step is implicit Euler: Newton's method with a share
/// of the stiffness added, small where the energy is convex. With an energy (no friction, moments or follower
/// loads) each step lowers it, and saddles are left along the direction in which it falls. Otherwise each
/// step is as long as its equations stay nearly linear.
class RodDescent {
 public:
  /// Input of a tendon: a given tension, or held at its base.
  struct Held {
    double tension = 0;  ///< N, if it is not held.
    bool is_held = false;
    double length = 0;      ///< Length above which it pulls, m.
    double compliance = 0;  ///< m/N, > 0 for held ones.
    /// Additional compliance while held, m/N, about `tension` (augmented Lagrangian: M. Hestenes, M. J. D.
    /// Powell 1969). The final tension is returned as `tension`.
    double penalty = 0;
  };

  /// Uses the chain and changes its state.
  RodDescent(RodChain& chain, const RodLoads& loads);

  /// Moves q to an equilibrium and returns each tendon's tension there. Returns false if it found none or the
  /// rod turns inside out.
  bool fall(Eigen::VectorXd& q, std::vector<Held>& tendons);
  /// Whether the second derivative does not decide stability. Either a direction has no stiffness (free
  /// rotation in a rotationally symmetric world), or tendons that are just taut hold the rod, as tested by
  /// pushes to several sides.
  [[nodiscard]] bool is_neutral() const { return is_neutral_; }
  /// Number of linear systems solved.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  enum class Step { made, rest, none };
  enum class Saddle { left, neutral, none };
  // Computes residual, tensions and, if there is one, energy at q. Returns false if not finite or inside out.
  bool look(const Eigen::VectorXd& q, const std::vector<Held>& tendons);
  // Computes step_ with this share of the stiffness. Returns the number of negative eigenvalues, or -1
  // without a solution.
  int solve(double share, const std::vector<Held>& tendons);
  // Solves with constant tendon tensions.
  void solve_untied(Eigen::MatrixXd& columns) const;
  // Completes a solution of right-hand sides (first columns) with the derivative factored by solve().
  void finish_solve(Eigen::MatrixXd& columns) const;
  [[nodiscard]] double measure(const Eigen::VectorXd& change) const;
  Step step(Eigen::VectorXd& q, const std::vector<Held>& tendons);
  Saddle leave_saddle(Eigen::VectorXd& q, const std::vector<Held>& tendons);

  RodChain& chain_;
  const RodLoads& loads_;
  bool has_energy_ = false, has_friction_ = false, is_neutral_ = false;
  double share_ = 0, last_share_ = 0;  // added stiffness of the next step and of the last one
  int iterations_ = 0, pushes_ = 0;
  double energy_ = 0, scale_ = 0;  // J, and the magnitude of its terms
  std::vector<double> tensions_;
  std::vector<Eigen::Index> taut_;  // held tendons that pull
  Eigen::VectorXd residual_, step_;
  Eigen::PartialPivLU<Eigen::MatrixXd> friction_;  // correction of the factored derivative
  Eigen::MatrixXd by_taut_, give_inverse_;         // of the factored derivative
};

}  // namespace flexura
