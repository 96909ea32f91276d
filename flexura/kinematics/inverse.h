#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flexura/model/arm_model.h"

// Inverse kinematics: finds the state that brings the tip, or the whole backbone, to a target
// (docs/inverse-kinematics.md). Equal inputs give equal results, bit for bit.
namespace flexura {

/// Target of the tip, in world axes.
struct TipTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< p_WT, m.
  std::optional<Eigen::Vector3d> direction = {};  ///< Direction of the tip's z axis; not zero, of any length.
  std::optional<Eigen::Matrix3d> rotation = {};   ///< R_WT; excludes `direction`.
};

/// Target curve of the whole backbone, as a polyline in world axes, m. The backbone's point at a share f of
/// its arc length corresponds to the polyline's at a share f of its length.
struct CurveTarget {
  std::vector<Eigen::Vector3d> points;  ///< Two or more, not all equal.
};

/// Preference among the solutions of a target.
enum class InverseObjective {
  none,           ///< Take the first solution found.
  least_bending,  ///< Minimise the sum of squares of the bends (rad) and of the stretches' distances from 1.
  mid_range,      ///< Minimise the same sum relative to the limits: a bend to max_bend (pi without one), a
                  ///< stretch to half its range, about the middle of the range.
};

/// Returns the largest distance of a polyline from the smooth curve through its points, m. It is the largest
/// height of an arc above its chord, plus the total difference in length of arcs and chords. The latter moves
/// points at a share of the length along the curve. Each arc turns by as much as the polyline does at its
/// ends. Turns of 60 degrees and more are corners and contribute nothing.
[[nodiscard]] double polyline_error(const std::vector<Eigen::Vector3d>& points);

/// Start and tolerances of the search.
struct InverseConfig {
  /// Start of the search; by default one arc towards the target.
  std::optional<ArmState> start = {};
  InverseObjective objective = InverseObjective::none;  ///< Preference for redundant freedom.
  /// In m; default 1e-9 of the arm's greatest length. For curves the default is 1e-3 of it plus twice
  /// polyline_error(), together at most 1e-2 of it. A coarser polyline needs a tolerance from the caller.
  std::optional<double> position_tolerance = {};
  double angle_tolerance = 1e-9;  ///< In rad.
  int max_starts = 400;           ///< Number of descents from different states, the first from `start`; >= 1.
  std::uint64_t seed = 1;         ///< Seed of the starts after the first two.
};

/// Result of a search.
enum class InverseOutcome {
  converged,       ///< Within the tolerances.
  not_reachable,   ///< Proven (is_proven), or no limit is active and no state is nearer.
  at_limit,        ///< The best state found is held by a limit, without which the arm would come nearer.
  no_convergence,  ///< Undecided.
};

/// Returns the name in results: "converged", "not_reachable", "at_limit", "no_convergence".
[[nodiscard]] std::string_view name_of(InverseOutcome outcome);

/// The state found, or the reason of the failure.
struct InverseResult {
  InverseOutcome outcome = InverseOutcome::no_convergence;
  bool is_proven = false;       ///< The target is out of reach of every state within the limits.
  ArmState state;               ///< Within the limits: the solution, or the nearest state found.
  Eigen::Vector3d tip;          ///< p_WT of `state`, m.
  double position_error = 0.0;  ///< Distance of the tip, m; for a curve the largest along the arm.
  double angle_error = 0.0;  ///< Error of `state`, rad, from the target's direction or rotation; otherwise 0.
  double position_tolerance = 0.0;  ///< Largest position_error that counts as converged, m.
  int iterations = 0;               ///< Number of evaluations of the arm and its Jacobian.
  int starts = 0;                   ///< Number of descents.

  [[nodiscard]] bool converged() const { return outcome == InverseOutcome::converged; }
};

/// Returns a state of `arm` within its limits for the target. For a target proven out of reach, the result is
/// always not_reachable with the nearest state found; nearest in position if the position is out of reach.
/// Throws std::invalid_argument if a target or start is not finite or does not fit, or a tolerance is not
/// positive. Also throws it for a zero direction, both a direction and a rotation, an invalid rotation
/// matrix, or a curve without length.
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// Returns a command for the target, for an arm whose sections may be several arcs. The command is a state of
/// model.driven() within its limits; the target is for the tip or curve of the resulting shape.
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// Returns the distinct solutions that config.max_starts descents find, least bent first; empty if there are
/// none. If the target leaves freedom, each is first minimised by the preference (least_bending by default),
/// so there is one per local minimum. Two solutions are equal if their backbones differ by less than 1e-4 of
/// the arm's length everywhere. For a target symmetric about the base's axis, each solution represents its
/// rotations about it. Its first bent section bends towards the base's x.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const Arm& arm, const TipTarget& target,
                                                               const InverseConfig& config = {});
/// Returns the distinct commands for a target. Two are equal if the backbones of single-arc arms with these
/// commands are.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const ArmModel& model, const TipTarget& target,
                                                               const InverseConfig& config = {});

}  // namespace flexura
