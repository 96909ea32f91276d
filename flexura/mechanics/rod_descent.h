#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Viscous descent of a rod's potential energy from any shape to an equilibrium. The rod moves as if it had
/// no mass and a viscosity proportional to its stiffness. Each step is an implicit Euler step: a Newton step
/// with a share of the stiffness added to the derivative. The share is small where the energy is convex. If
/// the forces have a potential (no friction, moments or follower loads), each step reduces the energy. From
/// saddle points the descent continues in a direction in which the energy decreases. If the forces have no
/// potential, steps are limited to lengths for which the equations are nearly linear.
class RodDescent {
 public:
  /// Input of a tendon: a given tension, or a base that is held in place.
  struct Held {
    double tension = 0;  ///< Tension, N, of a tendon that is not held.
    bool is_held = false;
    double length = 0;      ///< Path length above which a held tendon pulls, m.
    double compliance = 0;  ///< Compliance, m/N; > 0 for a held tendon.
    /// Additional compliance of a held tendon around the value `tension`, m/N (augmented Lagrangian:
    /// Hestenes, Powell 1969). The final tension is returned as `tension`.
    double penalty = 0;
  };

  /// Keeps a reference to the chain, and changes the state of the chain.
  RodDescent(RodChain& chain, const RodLoads& loads);

  /// Moves q to an equilibrium, and sets the tension of each tendon to its value there. Returns false if no
  /// equilibrium was found, or if the rod is compressed to a negative length.
  bool fall(Eigen::VectorXd& q, std::vector<Held>& tendons);
  /// Whether the second derivative of the energy does not determine stability. One cause is a direction
  /// without stiffness, such as free rotation in a rotationally symmetric world. Another cause is tendons
  /// that are just taut and hold the rod. Stability is then tested with pushes in several directions.
  [[nodiscard]] bool is_neutral() const { return is_neutral_; }
  /// Number of linear systems solved.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  enum class Step { made, rest, none };
  enum class Saddle { left, neutral, none };
  // Computes residual, tensions and (if there is one) energy at q. Returns false if these are not finite or a
  // length is negative.
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
