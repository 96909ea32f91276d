#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"

// Inverse statics: the tensions that bring a rod's equilibrium where it is wanted, under loads too
// (docs/mechanics.md, "Inverse statics"). The same question has the same answer, bit for bit.
namespace flexura {

/// Where a rod shall be, in the frame of its base. What is left out is free; something is asked for.
struct RodTarget {
  /// A place of the rod, and where it shall be, m.
  struct Place {
    RodPlace place = {};  ///< A node: one that the RodStatics was given, or a section's end.
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };

  std::optional<Eigen::Vector3d> position = {};   ///< Of the tip, m.
  std::optional<Eigen::Vector3d> direction = {};  ///< Of the tip's z axis; not zero, of any length.
  std::optional<Eigen::Matrix3d> rotation = {};   ///< Of the tip; with it `direction` must be left out.
  /// What an error of direction or rotation counts, m for each radian; > 0.
  double angle_weight = 0.1;
  std::vector<Place> places = {};  ///< A shape.
};

/// Where a search begins, and what counts as found.
struct InverseStaticsConfig {
  /// The robot as it is: the search begins with its tensions, and equilibria are those that are reached from
  /// it. Left out: without tensions, and from rest.
  std::optional<Equilibrium> start = {};
  /// Each place is met within it, m, and angles within it by their weight; > 0.
  double tolerance = 1e-8;
  int max_starts = 12;  ///< Searches from different tensions, until one reaches the target; >= 1.
  /// Makes all of them and takes the one of least effort: it may have several minima.
  bool all_starts = false;
};

/// How a search for tensions ended.
enum class InverseStaticsEnd {
  reached,         ///< Within the tolerance, by a stable equilibrium.
  nearest,         ///< No search reached it; the tensions found are those that come nearest.
  bad_input,       ///< `problem` says what.
  no_equilibrium,  ///< None was found to begin with.
};
/// That, for people.
[[nodiscard]] const char* words(InverseStaticsEnd end);

/// Tensions that bring a rod where it is wanted, or nearest to it.
struct InverseStaticsResult {
  InverseStaticsEnd end = InverseStaticsEnd::bad_input;
  std::string problem;  ///< Of what is not reached, in words.
  /// Reached, and the sum of squares of the tensions has a minimum among all that reach it nearby.
  bool is_least = false;
  std::vector<double> tensions;  ///< N, each from 0 to its most. Empty with bad input.
  /// Under these tensions. Its `displacements` are what a drive pulls in, m.
  Equilibrium equilibrium;
  double position_error = 0;  ///< Of the tip and all places, the largest, m.
  double angle_error = 0;     ///< From the direction or rotation asked for, rad; else 0.
  double effort = 0;          ///< The sum of squares of the tensions, N^2.
  int evaluations = 0;        ///< Equilibria looked for.
  int starts = 0;             ///< Searches made.

  [[nodiscard]] bool reached() const { return end == InverseStaticsEnd::reached; }
};

/// Finds tensions between 0 and `most` (N, one a tendon, finite) that bring the equilibrium under `loads` to
/// the target, and of these those of least effort; where none do, those of the least sum of squares of the
/// distances (and weighted angles). Loads count as they are: it is inverse kinematics under load. Never
/// throws for bad input: the result says what it was. `statics` is afterwards as it was solved with the
/// result's tensions, so that its slopes() are those there.
///
/// By Levenberg and Marquardt within bounds (BoundedDescent), then along the tensions that reach the target
/// by stabilized sequential quadratic programming (S. J. Wright 1998): where most tendons are slack,
/// constraints depend on each other.
[[nodiscard]] InverseStaticsResult solve_inverse_statics(RodStatics& statics, const RodTarget& target,
                                                         const RodLoads& loads,
                                                         const std::vector<double>& most,
                                                         const InverseStaticsConfig& config = {});

}  // namespace flexura
