#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// How a rod falls: from any shape downhill to rest, as if it were slowed by a viscosity in proportion to its
/// stiffness and had no mass. Each step is one of implicit Euler, which is Newton's method with a share of
/// the stiffness added, little where the energy is convex. Where there is an energy (no friction, no moments
/// or loads that follow) each step lowers it, and saddles are left along the direction in which the energy
/// falls; else each step is as long as its equations stay near to linear.
class RodFall {
 public:
  /// A tendon's input: it pulls with a given tension, or it is held at its base.
  struct Held {
    double tension = 0;  ///< N, where nothing holds it.
    bool is_held = false;
    double length = 0;      ///< At which it begins to pull, m.
    double compliance = 0;  ///< m/N, > 0 of held ones.
    /// How much more it gives while it is being held, m/N; about `tension` (augmented Lagrangian: M.
    /// Hestenes, M. J. D. Powell 1969). What it pulls in the end comes back as `tension`.
    double penalty = 0;
  };

  /// Uses the chain, whose state changes.
  RodFall(RodChain& chain, const RodLoads& loads);

  /// From q to rest, and each tendon's tension there. False: it found no rest, or the rod turns inside out.
  bool fall(Eigen::VectorXd& q, std::vector<Held>& tendons);
  /// Whether it rests where its second derivative says less than that: a direction has no stiffness (nothing
  /// holds the rod against going around, in a world that is the same all around), or tendons that are just
  /// taut hold it, which has been tried by pushes to several sides.
  [[nodiscard]] bool is_neutral() const { return is_neutral_; }
  /// Linear systems solved.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  enum class Step { made, rest, none };
  enum class Saddle { left, neutral, none };
  // Residual, tensions and, where there is one, energy at q. False: not finite, or inside out.
  bool look(const Eigen::VectorXd& q, const std::vector<Held>& tendons);
  // Makes step_ under this share of the stiffness; how many eigenvalues are negative. -1: no solution.
  int solve(double share, const std::vector<Held>& tendons);
  // The same while tendons keep their tensions.
  void solve_untied(Eigen::MatrixXd& columns) const;
  // What a right-hand side, its first columns, becomes by the derivative that solve() has factored.
  void finish_solve(Eigen::MatrixXd& columns) const;
  [[nodiscard]] double measure(const Eigen::VectorXd& change) const;
  Step step(Eigen::VectorXd& q, const std::vector<Held>& tendons);
  Saddle leave_saddle(Eigen::VectorXd& q, const std::vector<Held>& tendons);

  RodChain& chain_;
  const RodLoads& loads_;
  bool has_energy_ = false, has_friction_ = false, is_neutral_ = false;
  double share_ = 0, last_share_ = 0;  // of the stiffness: of the step to come, and of the one made
  int iterations_ = 0, pushes_ = 0;
  double energy_ = 0, scale_ = 0;  // J, and of what its parts are
  std::vector<double> tensions_;
  std::vector<Eigen::Index> taut_;  // held ones that pull
  Eigen::VectorXd residual_, step_;
  Eigen::PartialPivLU<Eigen::MatrixXd> friction_;  // what it makes of that derivative
  Eigen::MatrixXd by_taut_, give_inverse_;         // of the derivative that is factored
};

}  // namespace flexura
