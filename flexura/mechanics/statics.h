#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Input of a rod's tendons. Each list has one number per tendon, or is empty.
struct TendonInput {
  std::vector<double> tensions = {};  ///< Tensions at the base, N; >= 0.
  /// Displacement of each tendon at the base, m: positive if pulled in, 0 if the tendon is just taut on the
  /// undeformed rod. A tendon is slack if more of it is let out than the rod takes up.
  std::vector<double> displacements = {};
};

/// How a search for an equilibrium ended.
enum class StaticsEnd {
  converged,
  /// The input is invalid: a number is not finite, a tension is below 0, or a list has a wrong length.
  bad_input,
  /// No equilibrium: the load path diverged before full load, or the rod would be compressed to a negative
  /// length.
  no_equilibrium,
  /// The tendons pull two guide disks together. The rod buckles between the disks, and only their contact,
  /// which is not modelled, could hold it.
  disks_meet,
  /// Within the limit on the number of steps, neither an equilibrium nor the end of the load path was found.
  out_of_steps,
};
/// Returns a description for users.
[[nodiscard]] const char* words(StaticsEnd end);

/// Equilibrium of a rod under tendons and loads, in the frame of its base.
struct Equilibrium {
  StaticsEnd end = StaticsEnd::out_of_steps;
  std::string problem;  ///< Description of bad input.
  /// Whether the effect of a small push decays at constant tensions or displacements.
  bool stable = false;
  /// Whether a real rod jumps: the load had a maximum on the load path, or the path ended and the rod
  /// descended to another equilibrium.
  bool snapped = false;
  /// Whether other equilibria were detected: the path branched or turned, or the rod descended to another
  /// equilibrium.
  bool ambiguous = false;
  /// Section that has too few strain modes for the bend between its guide disks. The error of the tip may
  /// exceed 1e-3 of the rod's length.
  std::optional<std::size_t> coarse_section = {};
  int iterations = 0;                  ///< Number of linear systems solved.
  Eigen::VectorXd q;                   ///< The strain modes (RodChain).
  std::vector<double> tensions;        ///< Tensions at the base, N; 0 for slack tendons.
  std::vector<double> tendon_lengths;  ///< Path lengths through the rod, from base to end, m.
  std::vector<double>
      /// Length pulled in at the base, m; for a slack tendon, the displacement at which it becomes taut.
      displacements;
  double strain_energy = 0;  ///< Strain energy, J.
  Pose tip;                  ///< X_BT

  [[nodiscard]] bool converged() const { return end == StaticsEnd::converged; }
};

/// Derivatives of an equilibrium with respect to its input, loads and parameters. The input is the given
/// tensions or displacements.
struct EquilibriumSlopes {
  Eigen::MatrixXd q_by_input;         ///< size() x tendons. Columns of slack tendons are 0.
  Eigen::MatrixXd tensions_by_input;  ///< Tendons x tendons, N/m; the identity if tensions are given.
  Eigen::MatrixXd lengths_by_input;   ///< Tendons x tendons.
  Eigen::MatrixXd q_by_tip;           ///< size() x 6: by force and moment at the tip, in the base's frame.
  Eigen::MatrixXd
      tip_by_input;  ///< 6 x tendons: change of the tip's position and rotation, in the base's frame.
  /// Compliance: change of the tip's position and rotation with respect to force and moment at the tip.
  Eigen::Matrix<double, 6, 6> tip_by_tip;
  /// Derivative of the tip's position and rotation with respect to parameters, 6 x (5 sections). Each
  /// section's parameters are relative changes of its stiffness against shear, stretch, bends and twist, and
  /// of its mass per length.
  Eigen::MatrixXd tip_by_parameters;
  Eigen::MatrixXd
      q_by_parameters;  ///< Derivatives of q with respect to these parameters, size() x (5 sections).
};

/// Solves rods for equilibrium: minima of their energy in reduced strains (Boyer, Renda et al., geometric
/// variable strain). Newton's method follows the load path from zero load. If the path ends before full load,
/// the rod moves from its last stable shape to a minimum of the energy (RodDescent).
class RodStatics {
 public:
  /// Parameters and exceptions are as for RodChain.
  explicit RodStatics(Rod rod, std::span<const RodPlace> places = {});

  /// Sets length factors as RodChain::stretch_rest, from the next solution on. Displacements still refer to
  /// the original rod.
  void stretch_rest(std::span<const double> factors);
  /// Solves from the undeformed rod.
  [[nodiscard]] Equilibrium solve(const TendonInput& tendons, const RodLoads& loads);
  /// Solves from a nearby equilibrium, or from the undeformed rod if the solution from `near` does not
  /// converge directly.
  [[nodiscard]] Equilibrium solve(const TendonInput& tendons, const RodLoads& loads, const Equilibrium& near);
  /// Returns the equilibrium that a rod with the shape of `near` reaches. If the nearby equilibrium is
  /// stable, the result is this equilibrium. Otherwise the result is the equilibrium at the end of the
  /// descent from `near`. Starts from the undeformed rod if `near` did not converge. Returns an unstable
  /// equilibrium only if no descent from there found a stable equilibrium.
  [[nodiscard]] Equilibrium settle(const TendonInput& tendons, const RodLoads& loads,
                                   const Equilibrium& near);
  /// Does the same as settle(), with the undeformed rod as start.
  [[nodiscard]] Equilibrium settle(const TendonInput& tendons, const RodLoads& loads);

  /// Treatment of slack tendons in slopes(). `hangs`: slack tendons have no effect. `is_taut`: slack tendons
  /// count as just taut and held, and can also push.
  enum class Slack { hangs, is_taut };
  /// Returns the derivatives at the last solution. Throws std::logic_error if the last solution did not
  /// converge.
  [[nodiscard]] EquilibriumSlopes slopes(Slack slack = Slack::hangs);

  /// Returns tendon lengths of the undeformed rod, m.
  [[nodiscard]] const std::vector<double>& rest_lengths() const { return rest_lengths_; }
  /// Returns the rod, placed at the last solution.
  [[nodiscard]] const RodChain& chain() const { return chain_; }

 private:
  // Newton's steps are measured in radians of a section's bend, and parts of its length (RodChain::scales).
  static constexpr double settled_step = 1e-10;
  // Steps that shrink less than by this factor lead to another solution.
  static constexpr double contraction = 0.6;

  struct Unknowns {
    Eigen::VectorXd q, tensions;
  };
  // Result of Newton's method from a start.
  struct Descent {
    bool settled = false;
    int negative = 0;  // Negative eigenvalues of the last derivative, as used for stability.
    // Whether all derivatives were positive definite, that of the start under full load included: no other
    // branch lay between.
    bool always_stable = true;
  };
  [[nodiscard]] std::string input_problem() const;
  // Computes F, and the solutions of F' y = -F and F' y = -dF/dshare.
  bool linearize(const Unknowns& at, double share);
  [[nodiscard]] double measure(const Unknowns& change) const;
  bool find_tensions(const Unknowns& at, double share);
  [[nodiscard]] double compliance(std::size_t tendon) const;
  Descent descend(Unknowns& at, double share);
  bool follow(Equilibrium& result, Unknowns& at, Unknowns& last_stable);
  bool fall(Unknowns& at, Descent& descent);
  bool fall_on(Unknowns& at, Descent& descent);
  [[nodiscard]] bool has_positive_stretch() const;
  // Takes the input and returns its problem, "" if it is valid.
  std::string take(const TendonInput& tendons, const RodLoads& loads);
  [[nodiscard]] bool is_start(const Equilibrium& near) const;
  Unknowns start_at(const Equilibrium& near);
  void finish(Equilibrium& result, const Unknowns& at, const Descent& descent);
  Equilibrium solve_from(const Unknowns& start, bool is_cold);

  RodChain chain_;
  std::vector<double> rest_lengths_;
  double least_compliance_ = 0;  // m/N
  double give_ = 0;              // Compliance of the undeformed rod to its tendons, m/N.
  TendonInput input_;
  RodLoads loads_;
  bool by_displacement_ = false;
  std::vector<char> taut_;     // For displacements, as last found: start of the next search.
  std::vector<double> pulls_;  // Tensions passed to chain_.
  Eigen::MatrixXd solved_;     // Columns: by F, by the share, by each tendon's tension.
  Unknowns newton_, tangent_;
  Eigen::VectorXd at_;  // q of the last solution.
  int negative_ = 0, iterations_ = 0;
  bool is_solved_ = false;
};

}  // namespace flexura
