#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"

// Inverse statics: tensions that bring a rod's equilibrium to a target, also under loads (docs/mechanics.md,
// "Inverse statics"). The result is reproducible bit for bit.
namespace flexura {

/// Target of a rod, in the frame of its base. Omitted parts are free. At least one part must be given.
struct RodTarget {
  /// A place of the rod and its target, m.
  struct Place {
    RodPlace place = {};  ///< A node: a place given to the RodStatics, or a section's end.
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };

  std::optional<Eigen::Vector3d> position = {};  ///< Target position of the tip, m.
  /// Target direction of the tip's z axis; any nonzero length.
  std::optional<Eigen::Vector3d> direction = {};
  std::optional<Eigen::Matrix3d> rotation = {};  ///< Target rotation of the tip; excludes `direction`.
  /// Weight of errors of direction or rotation, m per radian; > 0.
  double angle_weight = 0.1;
  std::vector<Place> places = {};  ///< Targets of further places, for a target shape.
};

/// Start and tolerances of the search.
struct InverseStaticsConfig {
  /// The robot's present state. The search starts with the tensions of this state, on the same branch of
  /// equilibria. Default: the undeformed rod without tensions.
  std::optional<Equilibrium> start = {};
  /// Largest accepted error of each place, and of weighted angles, m; > 0.
  double tolerance = 1e-8;
  int max_starts = 12;  ///< Largest number of searches from different tensions; >= 1.
  /// Makes all searches and returns the result with least effort. The effort may have several minima.
  bool all_starts = false;
};

/// How a search for tensions ended.
enum class InverseStaticsEnd {
  reached,         ///< A stable equilibrium meets the target within the tolerance.
  nearest,         ///< No search reached the target; the result is the nearest equilibrium found.
  bad_input,       ///< The input is invalid, as described in `problem`.
  no_equilibrium,  ///< No initial equilibrium was found.
};
/// Returns a description for users.
[[nodiscard]] const char* words(InverseStaticsEnd end);

/// Tensions that bring a rod to a target, or nearest to it.
struct InverseStaticsResult {
  InverseStaticsEnd end = InverseStaticsEnd::bad_input;
  std::string problem;  ///< Why the target was not reached, in words.
  /// Whether the target was reached with a local minimum of the sum of squared tensions.
  bool is_least = false;
  std::vector<double> tensions;  ///< Tensions, N, each from 0 to its maximum; empty for invalid input.
  /// Equilibrium under these tensions. The `displacements` of the equilibrium are the lengths that a drive
  /// must pull in, m.
  Equilibrium equilibrium;
  double position_error = 0;  ///< Largest error of the tip and all places, m.
  double angle_error = 0;     ///< Error of the target direction or rotation, rad; 0 without one.
  double effort = 0;          ///< The sum of squares of the tensions, N^2.
  int evaluations = 0;        ///< Number of equilibria computed.
  int starts = 0;             ///< Number of searches.

  [[nodiscard]] bool reached() const { return end == InverseStaticsEnd::reached; }
};

/// Inverse kinematics under load: finds tensions that bring the equilibrium under `loads` to the target with
/// least effort. Tensions are between 0 and `most` (N, one per tendon, finite). If no tensions reach the
/// target, the function minimises the sum of squared distances and weighted angles. Reports invalid input in
/// the result and does not throw. The last solution of `statics` is the result, so that its slopes() are the
/// derivatives at the result.
///
/// Method: Levenberg and Marquardt within bounds (BoundedDescent), then stabilized sequential quadratic
/// programming (Wright 1998) along the tensions that reach the target. Quadratic programming handles
/// dependent constraints. Such constraints occur where most tendons are slack.
[[nodiscard]] InverseStaticsResult solve_inverse_statics(RodStatics& statics, const RodTarget& target,
                                                         const RodLoads& loads,
                                                         const std::vector<double>& most,
                                                         const InverseStaticsConfig& config = {});

}  // namespace flexura
