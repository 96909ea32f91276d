#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flexura/model/arm_model.h"

// Inverse kinematics: finds the state that brings the tip, or the whole backbone, to a target
// (docs/inverse-kinematics.md). Equal inputs give bitwise equal results.
namespace flexura {

/// Target of the tip, in world axes.
struct TipTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< p_WT, m.
  std::optional<Eigen::Vector3d> direction = {};       ///< Direction of the tip's z axis; any length above 0.
  std::optional<Eigen::Matrix3d> rotation = {};  ///< Rotation R_WT of the tip; not together with `direction`.
};

/// Target curve of the whole backbone: a polyline. The point at a fraction f of the backbone's length
/// corresponds to the point at the fraction f of the polyline's length.
struct CurveTarget {
  std::vector<Eigen::Vector3d> points;  ///< At least two vertices in W, m, not all equal.
};

/// Criterion for the choice among several solutions.
enum class InverseObjective {
  none,           ///< Returns the first solution that the search finds.
  least_bending,  ///< Minimizes the sum of squares of all bends (rad) and of all stretches minus 1.
  /// Minimises the sum of squares of all bends divided by max_bend (at most pi), and of all stretches'
  /// distances from mid-range divided by half the range.
  mid_range,
};

/// Returns an estimate of the largest distance between a polyline and the smooth curve through its vertices,
/// m. Each segment of the polyline is considered as the chord of an arc, whose angle follows from the turns
/// of the polyline at the segment's ends. The result is the largest height of an arc above its chord, plus
/// the total length difference between arcs and chords. The length difference shifts points at a given
/// fraction of the length along the curve. Turns of at least 60 degrees count as corners and are ignored.
[[nodiscard]] double polyline_error(const std::vector<Eigen::Vector3d>& points);

/// Settings of the search.
struct InverseConfig {
  /// State from which the search starts; default: one arc towards the target.
  std::optional<ArmState> start = {};
  InverseObjective objective = InverseObjective::none;  ///< Criterion for the choice among several solutions.
  /// Position tolerance, m. Default for the tip: 1e-9 of the arm's greatest length. Default for curves: 1e-3
  /// of this length plus twice polyline_error(), but at most 1e-2 of this length. For a coarser polyline, the
  /// caller must set a tolerance.
  std::optional<double> position_tolerance = {};
  double angle_tolerance = 1e-9;  ///< Tolerance of direction or rotation, rad.
  /// Largest number of descents; >= 1. The first descent starts at `start`, the others at different states.
  int max_starts = 400;
  /// Seed of the random start states. All start states except the first two are random.
  std::uint64_t seed = 1;
};

/// Outcome of a search.
enum class InverseOutcome {
  converged,  ///< A state within the tolerances was found.
  /// The target is out of reach. Either this is proven (is_proven), or the nearest state found is a minimum
  /// without an active limit.
  not_reachable,
  at_limit,        ///< At the nearest state found, an active limit prevents the arm from coming nearer.
  no_convergence,  ///< The search did not find whether the target is reachable.
};

/// Returns the name of an outcome in result files: "converged", "not_reachable", "at_limit",
/// "no_convergence".
[[nodiscard]] std::string_view name_of(InverseOutcome outcome);

/// Result of inverse kinematics: a state and, if it is not a solution, the reason.
struct InverseResult {
  InverseOutcome outcome = InverseOutcome::no_convergence;
  bool is_proven =
      false;            ///< Whether the search has proven that no state within the limits reaches the target.
  ArmState state;       ///< The solution, or the nearest state found. This state is within the limits.
  Eigen::Vector3d tip;  ///< p_WT of `state`, m.
  /// Distance of the tip from the target, m; for a curve, the largest distance along the arm.
  double position_error = 0.0;
  /// Angle between the direction or rotation of the tip and of the target, rad; 0 for targets without
  /// direction and rotation.
  double angle_error = 0.0;
  double position_tolerance = 0.0;  ///< Tolerance on position_error, m.
  int iterations = 0;               ///< Number of evaluations of the arm and its Jacobian.
  int starts = 0;                   ///< Number of descents made.

  [[nodiscard]] bool converged() const { return outcome == InverseOutcome::converged; }
};

/// Returns a state of `arm` within its limits that reaches the target. If the target is proven to be out of
/// reach, the outcome is not_reachable, and the state is the nearest state found. If the target's position is
/// out of reach, this state is nearest in position. Throws std::invalid_argument if a target or start is not
/// finite, or a tolerance is not positive. Also throws std::invalid_argument if the start does not have one
/// bend and one stretch per section. Further reasons for this exception are a zero direction, both a
/// direction and a rotation, an invalid rotation matrix, or a curve without length.
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// Returns a command whose shape reaches the target, for an arm whose sections may be several arcs. The
/// command is a state of model.driven() within its limits. The target is for the tip or the curve of the
/// resulting shape.
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// Returns the distinct solutions that config.max_starts descents find, the least bent first; empty if there
/// are none. If the target does not determine all degrees of freedom, each solution is moved to a local
/// minimum of the objective (default: least_bending), and each local minimum is one solution. Two solutions
/// count as equal if their backbones differ by less than 1e-4 of the arm's length everywhere. For a target
/// that is symmetric about the base's z axis, one solution represents all its rotations about this axis. The
/// first bent section of this solution bends towards the base's x.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const Arm& arm, const TipTarget& target,
                                                               const InverseConfig& config = {});
/// Returns the distinct commands that reach a target. Two commands count as equal if an arm of single-arc
/// sections would have equal backbones for these commands.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const ArmModel& model, const TipTarget& target,
                                                               const InverseConfig& config = {});

}  // namespace flexura
