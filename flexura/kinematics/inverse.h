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
  std::optional<Eigen::Matrix3d> rotation = {};        ///< R_WT; not together with `direction`.
};

/// Target curve of the whole backbone: a polyline. The point at a fraction f of the backbone's length
/// corresponds to the point at the fraction f of the polyline's length.
struct CurveTarget {
  std::vector<Eigen::Vector3d> points;  ///< Vertices in W, m: two or more, not all equal.
};

/// Criterion for the choice among several solutions.
enum class InverseObjective {
  none,           ///< Takes the first solution found.
  least_bending,  ///< Minimizes the sum of squares of all bends (rad) and of all stretches minus 1.
  mid_range,      ///< Minimizes the sum of squares of all bends relative to max_bend (at most pi), and of all
                  ///< stretches' distances from mid-range relative to half the range.
};

/// Returns the largest distance of a polyline from the smooth curve through its vertices, m, estimated from
/// arcs. Each segment of the polyline is the chord of an arc, which turns by as much as the polyline turns at
/// its ends. The result is the largest height of an arc above its chord, plus the total length difference
/// between arcs and chords. The length difference shifts points at a given fraction of the length along the
/// curve. Turns of 60 degrees and more are corners and contribute nothing.
[[nodiscard]] double polyline_error(const std::vector<Eigen::Vector3d>& points);

/// Settings of the search.
struct InverseConfig {
  /// State from which the search starts; default: one arc towards the target.
  std::optional<ArmState> start = {};
  InverseObjective objective = InverseObjective::none;  ///< Criterion for the choice among several solutions.
  /// Position tolerance, m. Default for the tip: 1e-9 of the arm's greatest length. Default for curves: 1e-3
  /// of this length plus twice polyline_error(), but at most 1e-2 of this length. For a coarser polyline the
  /// caller must set a tolerance.
  std::optional<double> position_tolerance = {};
  double angle_tolerance = 1e-9;  ///< Tolerance of direction or rotation, rad.
  /// Largest number of descents, each from a different state, the first from `start`; >= 1.
  int max_starts = 400;
  std::uint64_t seed = 1;  ///< Seed of the random start states, which are all after the first two.
};

/// Outcome of a search.
enum class InverseOutcome {
  converged,      ///< A state within the tolerances was found.
  not_reachable,  ///< The target is out of reach: proven (is_proven), or the nearest state found is a minimum
                  ///< without an active limit.
  at_limit,       ///< At the nearest state found, an active limit prevents the arm from coming nearer.
  no_convergence,  ///< The search did not find whether the target is reachable.
};

/// Returns the name of an outcome in result files: "converged", "not_reachable", "at_limit",
/// "no_convergence".
[[nodiscard]] std::string_view name_of(InverseOutcome outcome);

/// Result of inverse kinematics: the state found and, if it is not a solution, the reason.
struct InverseResult {
  InverseOutcome outcome = InverseOutcome::no_convergence;
  bool is_proven = false;  ///< Whether it is proven that no state within the limits reaches the target.
  ArmState state;          ///< The solution, or the nearest state found; within the limits.
  Eigen::Vector3d tip;     ///< p_WT of `state`, m.
  /// Distance of the tip from the target, m; for a curve the largest distance along the arm.
  double position_error = 0.0;
  /// Angle between `state` and the target's direction or rotation, rad; otherwise 0.
  double angle_error = 0.0;
  double position_tolerance = 0.0;  ///< Tolerance on position_error, m.
  int iterations = 0;               ///< Number of evaluations of the arm and its Jacobian.
  int starts = 0;                   ///< Number of descents made.

  [[nodiscard]] bool converged() const { return outcome == InverseOutcome::converged; }
};

/// Returns a state of `arm` within its limits that reaches the target. If the target is proven out of reach,
/// the result is always not_reachable, with the nearest state found. This state is nearest in position if the
/// position is out of reach. Throws std::invalid_argument if a target or start is not finite, or a tolerance
/// is not positive. Also throws it if the start does not have one bend and one stretch per section. Also
/// throws it for a zero direction, both a direction and a rotation, an invalid rotation matrix, or a curve
/// without length.
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

/// Returns the distinct solutions that config.max_starts descents find, least bent first; empty if there are
/// none. If the target leaves degrees of freedom, each solution is moved to a local minimum of the objective
/// (default: least_bending). Each local minimum is then one solution. Two solutions are equal if their
/// backbones differ by less than 1e-4 of the arm's length everywhere. For a target symmetric about the base's
/// z axis, each solution stands for all its rotations about this axis. Its first bent section bends towards
/// the base's x.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const Arm& arm, const TipTarget& target,
                                                               const InverseConfig& config = {});
/// Returns the distinct commands that reach a target. Two commands are equal if the backbones of single-arc
/// sections with these commands are equal.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const ArmModel& model, const TipTarget& target,
                                                               const InverseConfig& config = {});

}  // namespace flexura
