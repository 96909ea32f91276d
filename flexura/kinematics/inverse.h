#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flexura/model/arm_model.h"

// Inverse kinematics: the state that puts the tip, or the whole backbone, where it is wanted
// (docs/inverse-kinematics.md). The same question has the same answer, bit for bit.
namespace flexura {

/// Where the tip shall be, in world axes.
struct TipTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< p_WT, m.
  std::optional<Eigen::Vector3d> direction = {};       ///< Of the tip's z axis; not zero, of any length.
  std::optional<Eigen::Matrix3d> rotation = {};        ///< R_WT; with it `direction` must be left out.
};

/// The curve along which the whole backbone shall lie, as a polyline in world axes, m: the backbone's point
/// at a part f of its arc length belongs to the polyline's at a part f of its length.
struct CurveTarget {
  std::vector<Eigen::Vector3d> points;  ///< Two or more, not all the same.
};

/// What to do with freedom that the target leaves.
enum class InverseWish {
  none,           ///< Take the solution first found.
  least_bending,  ///< Make the sum of squares of the bends (rad) and of the stretches' distances from 1
                  ///< small.
  mid_range,      ///< The same, each relative to its limit: a bend to max_bend (pi without one), a stretch to
                  ///< half its range about the middle of it.
};

/// How far a polyline may be from the smooth curve that its points are taken from, m: the largest height of
/// an arc above its chord, and by how much arcs are longer than their chords in all (which moves the points
/// at a part of the length along the curve), each arc turning by as much as the polyline does at its ends.
/// Turns of 60 degrees and more are corners and mean what they say.
[[nodiscard]] double polyline_error(const std::vector<Eigen::Vector3d>& points);

/// Where the search begins, and what counts as found.
struct InverseConfig {
  /// Where the search begins; one arc towards the target when left out.
  std::optional<ArmState> start = {};
  InverseWish wish = InverseWish::none;  ///< For the freedom that the target leaves.
  /// m; when left out 1e-9 of the arm's greatest length, and for curves 1e-3 of it and twice
  /// polyline_error(), together at most 1e-2 of it: what a coarse polyline leaves open beyond that is the
  /// caller's to allow.
  std::optional<double> position_tolerance = {};
  double angle_tolerance = 1e-9;  ///< rad.
  int max_starts = 400;           ///< Descents from different states, the first from `start`; >= 1.
  std::uint64_t seed = 1;         ///< Of the starts after the first two.
};

/// How a search ended.
enum class InverseOutcome {
  converged,       ///< Within the tolerances.
  not_reachable,   ///< Proven so (is_proven), or no limit is in the way and no state comes nearer.
  at_limit,        ///< The best state found is held by a limit: without it the arm would come nearer.
  no_convergence,  ///< Undecided.
};

/// As answers call it: "converged", "not_reachable", "at_limit", "no_convergence".
[[nodiscard]] std::string_view name_of(InverseOutcome outcome);

/// What a search found, or why nothing.
struct InverseResult {
  InverseOutcome outcome = InverseOutcome::no_convergence;
  bool is_proven = false;       ///< The target is out of reach of every state within the limits.
  ArmState state;               ///< Within the limits: the solution, or the nearest found.
  Eigen::Vector3d tip;          ///< p_WT of `state`, m.
  double position_error = 0.0;  ///< Of `state`, m: the tip's distance; the largest along the arm for a curve.
  double angle_error = 0.0;     ///< Of `state`, rad, from the direction or rotation asked for; else 0.
  double position_tolerance = 0.0;  ///< The largest position_error that converges, m.
  int iterations = 0;               ///< Evaluations of the arm and its Jacobian.
  int starts = 0;                   ///< Descents made.

  [[nodiscard]] bool converged() const { return outcome == InverseOutcome::converged; }
};

/// Finds a state of `arm` within its limits for the target. A target that is proven out of reach is always
/// answered by not_reachable and the nearest state found: in position, when the position is out of reach.
/// std::invalid_argument: a target or start that is not finite or does not fit, a direction of zero, both a
/// direction and a rotation, a rotation that is not one, a curve without length, tolerances not positive.
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const Arm& arm, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// The same for an arm whose sections may be several arcs: the state of the result is a command, a state of
/// model.driven() within its limits; the tip and the curve are those of the shape that it makes.
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const TipTarget& target,
                                          const InverseConfig& config = {});
[[nodiscard]] InverseResult solve_inverse(const ArmModel& model, const CurveTarget& target,
                                          const InverseConfig& config = {});

/// The distinct solutions that config.max_starts descents find, least bent first; empty when there is none.
/// Where the target leaves freedom each is first run down to the wish (least_bending when it is none), so
/// that one is found for each valley of the wish. Two are the same when their backbones are nowhere further
/// apart than 1e-4 of the arm's length. Of a target that looks the same from all around the base's axis, each
/// stands for its turns about that: the first section that is bent bends towards the base's x.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const Arm& arm, const TipTarget& target,
                                                               const InverseConfig& config = {});
/// The same of commands: two are the same when the backbones are that arms of single arcs would have of them.
[[nodiscard]] std::vector<InverseResult> all_inverse_solutions(const ArmModel& model, const TipTarget& target,
                                                               const InverseConfig& config = {});

}  // namespace flexura
