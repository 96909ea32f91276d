#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// What holds a rod's tendons. Either list has one number a tendon, or is empty.
struct TendonInput {
  std::vector<double> tensions = {};  ///< N, at the base; >= 0.
  /// How far each is pulled in at the base, m, from where it is taut without tension on the rod as it is at
  /// rest. A tendon that is let out further than the rod takes hangs slack.
  std::vector<double> displacements = {};
};

/// How a search for an equilibrium ended.
enum class StaticsEnd {
  converged,
  bad_input,  ///< A number that is not finite, a tension below 0, a list of another length.
  /// Or the rod would have to pass through itself.
  no_equilibrium,  ///< The way from no load on led past every bound before all of the load was there.
  out_of_steps,    ///< Nor was an end of it seen.
};
/// That, for people.
[[nodiscard]] const char* words(StaticsEnd end);

/// A rod at rest under what pulls at it, in the frame of its base.
struct Equilibrium {
  StaticsEnd end = StaticsEnd::out_of_steps;
  std::string problem;  ///< Of bad input, in words.
  /// Stays where it is after a small push, under tensions or displacements as they are given.
  bool stable = false;
  /// On the way from no load it came to a greatest load and passed to another branch: a real rod jumps.
  bool snapped = false;
  /// More than one equilibrium was met: a branch left the way, or it turned.
  bool ambiguous = false;
  int iterations = 0;                  ///< Linear systems solved.
  Eigen::VectorXd q;                   ///< The strain modes (RodChain).
  std::vector<double> tensions;        ///< N, at the base; 0 of slack ones.
  std::vector<double> tendon_lengths;  ///< Of their ways through the rod, from base to end, m.
  std::vector<double>
      displacements;         ///< Pulled in at the base, m; of slack ones that at which they were taut.
  double strain_energy = 0;  ///< J
  Pose tip;                  ///< X_BT

  [[nodiscard]] bool converged() const { return end == StaticsEnd::converged; }
};

/// Changes of an equilibrium by what pulls at it, with all else kept: by tensions where these are given, by
/// displacements where those are.
struct EquilibriumSlopes {
  Eigen::MatrixXd q_by_input;         ///< size() x tendons. Columns of slack tendons are 0.
  Eigen::MatrixXd tensions_by_input;  ///< Tendons x tendons, N/m; the identity where tensions are given.
  Eigen::MatrixXd lengths_by_input;   ///< Tendons x tendons.
  Eigen::MatrixXd q_by_tip;  ///< size() x 6: by a force and a moment at the tip, in the base's frame.
  Eigen::MatrixXd
      tip_by_input;  ///< 6 x tendons: velocity of the tip's origin and angular velocity, base's frame.
  Eigen::Matrix<double, 6, 6> tip_by_tip;  ///< Compliance: the same by a force and a moment at the tip.
  /// The same by each section's parameters, 6 x 5 sections: by parts by which its stiffness against shear,
  /// stretch, bends and twist changes, and its mass along its length.
  Eigen::MatrixXd tip_by_parameters;
  Eigen::MatrixXd q_by_parameters;  ///< size() x 5 sections: likewise.
};

/// Solves rods for equilibrium: minima of their energy in reduced strains (F. Boyer, F. Renda et al.,
/// geometric variable strain), by Newton's method from no load on along a growing share of it.
class RodStatics {
 public:
  /// As RodChain.
  explicit RodStatics(Rod rod, std::span<const RodPlace> places = {});

  /// As RodChain::stretch_rest, of what is solved from now on. Displacements go on counting from the rod as
  /// it was.
  void stretch_rest(std::span<const double> factors);
  /// From the rod at rest.
  [[nodiscard]] Equilibrium solve(const TendonInput& tendons, const RodLoads& loads);
  /// From an equilibrium nearby, or from rest where that does not lead there directly.
  [[nodiscard]] Equilibrium solve(const TendonInput& tendons, const RodLoads& loads, const Equilibrium& near);

  /// At what was last solved, which converged. std::logic_error: nothing was.
  [[nodiscard]] EquilibriumSlopes slopes();

  /// Of the rod at rest, m.
  [[nodiscard]] const std::vector<double>& rest_lengths() const { return rest_lengths_; }
  /// The rod, placed as it was last solved.
  [[nodiscard]] const RodChain& chain() const { return chain_; }

 private:
  struct Unknowns {
    Eigen::VectorXd q, tensions;
  };
  // What Newton's method made of a start.
  struct Descent {
    bool settled = false;
    int negative = 0;  // Of the last derivative, as stability counts them.
    // So were all on the way, the start under all of the load among them: no other branch lay between.
    bool always_stable = true;
  };
  [[nodiscard]] std::string input_problem() const;
  // F, and the solutions of F' y = -F and F' y = -dF/dshare.
  bool linearize(const Unknowns& at, double share);
  [[nodiscard]] double measure(const Unknowns& change) const;
  bool find_tensions(const Unknowns& at, double share);
  [[nodiscard]] double compliance(std::size_t tendon) const;
  Descent descend(Unknowns& at, double share);
  bool follow(Equilibrium& result, Unknowns& at);
  [[nodiscard]] bool has_positive_stretch() const;
  void finish(Equilibrium& result, const Unknowns& at);
  Equilibrium solve_from(const Unknowns& start, bool is_cold);
  void solve_with_friction(Eigen::MatrixXd& rhs);

  RodChain chain_;
  std::vector<double> rest_lengths_;
  double least_compliance_ = 0;  // m/N
  TendonInput input_;
  RodLoads loads_;
  bool by_displacement_ = false;
  std::vector<char> taut_;     // Of displacement input, as last found: where the next search begins.
  std::vector<double> pulls_;  // Tensions as chain_ takes them.
  Eigen::MatrixXd solved_;     // Columns: by F, by the share, by each tendon's tension.
  Unknowns newton_, tangent_;
  Eigen::VectorXd at_;  // q of what was last solved.
  int negative_ = 0, iterations_ = 0;
  bool is_solved_ = false;
};

}  // namespace flexura
