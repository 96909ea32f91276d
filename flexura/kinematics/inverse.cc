#include "flexura/kinematics/inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/kinematics/driven_problem.h"
#include "flexura/kinematics/inverse_check.h"
#include "flexura/kinematics/inverse_distinct.h"
#include "flexura/kinematics/inverse_objective.h"
#include "flexura/kinematics/inverse_search.h"
#include "flexura/kinematics/reach.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/kinematics/tip_problem.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

constexpr int nearest_starts = 16;
// The first one or two descents solve most targets, faster than a proof that a target is out of reach takes.
constexpr int starts_before_proof = 2;

// A target in the base's frame, with all data for its solution.
struct Question {
  // `the_arm` is that of the shapes. With a model, commands are varied, otherwise shapes.
  Question(const Arm& the_arm, const TipTarget& the_target, const InverseConfig& the_config,
           const ArmModel* the_model = nullptr)
      : arm(the_arm),
        target(the_target),
        config(the_config),
        model(the_model),
        variables(the_model != nullptr ? the_model->driven() : the_arm),
        length(variables.max_length()) {
    if (model != nullptr) driven.emplace(*model);
    position_tolerance = config.position_tolerance.value_or(1e-9 * length);
    X_BT.position = arm.X_WB.inverse() * target.position;
    if (target.rotation) X_BT.rotation = arm.X_WB.rotation.transpose() * *target.rotation;
    if (target.direction) {
      const Eigen::Vector3d d = arm.X_WB.rotation.transpose() * target.direction->stableNormalized();
      X_BT.rotation = rotation_from_z(d);
    }
    if (config.start) start = variables.pack(*config.start);
  }

  // Limits the iterations for rods. One evaluation with derivatives needs several equilibria, which take a
  // thousand times as long as arcs.
  [[nodiscard]] int most_iterations() const {
    constexpr int of_rods = 400;
    return model != nullptr && !model->actuation().is_linear() ? of_rods : std::numeric_limits<int>::max();
  }
  [[nodiscard]] InverseStarts starts() const { return {variables, X_BT.position, start, config.seed}; }
  [[nodiscard]] bool is_position_out_of_reach() const {
    // Rounding errors of the bounds are a few units in the last place of the arm's length and the target's
    // distance.
    const double rounding = 1e-14 * (length + X_BT.position.norm());
    return least_distance(arm, X_BT.position) > position_tolerance + rounding;
  }
  [[nodiscard]] bool is_orientation_out_of_reach() const {
    constexpr double rounding = 1e-13;
    if (!target.direction && !target.rotation) return false;
    const double angle = target.rotation ? least_angle(arm, X_BT.rotation)
                                         : least_angle(arm, Eigen::Vector3d(X_BT.rotation.col(2)));
    if (angle > config.angle_tolerance + rounding) return true;
    // A small angle error moves the far end by that angle times the arm's length.
    return least_distance_along(arm, X_BT) >
           position_tolerance + (config.angle_tolerance + rounding) * (length + X_BT.position.norm());
  }

  const Arm& arm;
  const TipTarget& target;
  const InverseConfig& config;
  const ArmModel* model;
  std::optional<DrivenVariables> driven;
  ArmVariables variables;
  double length;
  double position_tolerance;
  Pose X_BT;
  std::optional<Eigen::VectorXd> start;
};

TipRows rows_of(const TipTarget& target) {
  if (target.rotation) return TipRows::rotation;
  return target.direction ? TipRows::direction : TipRows::position;
}

// The target as a problem of the variables.
class VariedTip {
 public:
  VariedTip(const Question& q, TipRows rows)
      : of_shape_(rows, q.driven ? q.driven->shaped() : q.variables, q.X_BT, q.length, q.position_tolerance,
                  q.config.angle_tolerance) {
    if (q.driven) driven_.emplace(*q.driven, of_shape_);
  }
  [[nodiscard]] BoundedProblem& problem() {
    return driven_ ? static_cast<BoundedProblem&>(*driven_) : of_shape_;
  }

 private:
  TipProblem of_shape_;
  std::optional<DrivenProblem> driven_;
};

// Returns the result for a state, from the model's forward kinematics.
InverseResult describe(const Question& q, const Found& found) {
  InverseResult result;
  result.state = q.variables.state(found.x);
  const Pose X_WT =
      tip_pose(q.arm, q.model != nullptr ? q.model->actuation().shape(result.state) : result.state);
  result.tip = X_WT.position;
  result.position_error = (X_WT.position - q.target.position).norm();
  const Eigen::Vector3d z = X_WT.rotation.col(2);
  if (q.target.direction) {
    const Eigen::Vector3d d = q.target.direction->stableNormalized();
    result.angle_error = std::atan2(z.cross(d).norm(), z.dot(d));
  }
  if (q.target.rotation) result.angle_error = so3_log(q.target.rotation->transpose() * X_WT.rotation).norm();
  result.starts = found.starts;
  result.position_tolerance = q.position_tolerance;
  return result;
}

InverseResult answer_out_of_reach(const Question& q, TipRows rows) {
  VariedTip problem(q, rows);
  BoundedDescent descent(problem.problem(), q.variables.bounds(), q.variables.size());
  descent.most_iterations = q.most_iterations();
  InverseStarts starts = q.starts();
  const Found found = nearest(descent, starts, std::min(nearest_starts, q.config.max_starts));
  InverseResult result = describe(q, found);
  result.outcome = InverseOutcome::not_reachable;
  result.is_proven = true;
  result.iterations = descent.iterations;
  return result;
}

InverseResult answer(const Question& q) {
  const TipRows rows = rows_of(q.target);
  VariedTip problem(q, rows);
  BoundedDescent descent(problem.problem(), q.variables.bounds(), q.variables.size());
  descent.most_iterations = q.most_iterations();
  InverseStarts starts = q.starts();
  Found found;
  search(descent, starts, std::min(starts_before_proof, q.config.max_starts), found);
  if (!found.is_met()) {
    if (q.is_position_out_of_reach()) return answer_out_of_reach(q, TipRows::position);
    if (q.is_orientation_out_of_reach()) return answer_out_of_reach(q, rows);
    search(descent, starts, q.config.max_starts, found);
  }
  if (!found.is_met()) settle(descent, settling_iterations, found);
  if (found.is_met() && q.config.objective != InverseObjective::none) {
    follow_objective(descent, ObjectiveScale(q.variables, q.config.objective), found.x);
  }
  InverseResult result = describe(q, found);
  result.iterations = descent.iterations;
  result.outcome = found.is_met() ? InverseOutcome::converged : outcome_of_missed(descent, found);
  return result;
}

// Returns true if the target is symmetric about the base's axis: a point on it with at most a direction along
// it. Then each solution is a whole ring of solutions.
bool is_round(const Question& q) {
  constexpr double on_axis = 1e-9;
  if (q.arm.kind != ArmKind::spatial || q.target.rotation) return false;
  if (q.target.direction && q.X_BT.rotation.col(2).head<2>().norm() > on_axis) return false;
  return q.X_BT.position.head<2>().norm() <= on_axis * q.length;
}

/// One of several solutions.
struct Solution {
  Found found;
  double objective = 0.0;
  std::vector<Eigen::Vector3d> points;
};

// Distinct solutions, each a local minimum of its preference.
class SolutionList {
 public:
  SolutionList(const Question& q, BoundedDescent& descent)
      : q_(q),
        descent_(descent),
        scale_(q.variables, q.config.objective == InverseObjective::none ? InverseObjective::least_bending
                                                                         : q.config.objective),
        is_round_(is_round(q)) {}

  void add(Found found) {
    follow_objective(descent_, scale_, found.x);
    // Most starts lead to the same few solutions, which need not be minimised again.
    if (is_known(solution(found))) return;
    run_down_to_minimum(descent_, scale_, found.x);
    Solution lowest = solution(std::move(found));
    if (!is_known(lowest)) solutions_.push_back(std::move(lowest));
  }

  [[nodiscard]] std::vector<Solution> in_order() && {
    std::ranges::stable_sort(solutions_, [](const Solution& a, const Solution& b) {
      return comes_first(a.objective, a.found.x, b.objective, b.found.x);
    });
    return std::move(solutions_);
  }

 private:
  [[nodiscard]] Solution solution(Found found) const {
    if (is_round_) turn_to_x(q_.variables, found.x);
    const double objective = scale_.relative(found.x).squaredNorm();
    std::vector<Eigen::Vector3d> points = backbone_points(q_.variables, found.x);
    return {std::move(found), objective, std::move(points)};
  }
  [[nodiscard]] bool is_known(const Solution& other) const {
    constexpr double same_arm = 1e-4;  // Share of the arm's length.
    return std::ranges::any_of(solutions_, [&](const Solution& known) {
      return backbone_distance(known.points, other.points) < same_arm * q_.length;
    });
  }

  const Question& q_;
  BoundedDescent& descent_;
  ObjectiveScale scale_;
  bool is_round_;
  std::vector<Solution> solutions_;
};

}  // namespace

InverseResult solve_inverse(const Arm& arm, const TipTarget& target, const InverseConfig& config) {
  check_question(target, config);
  return answer({arm, target, config});
}

InverseResult solve_inverse(const ArmModel& model, const TipTarget& target, const InverseConfig& config) {
  if (model.actuation().is_identity()) return solve_inverse(model.shaped(), target, config);
  check_question(target, config);
  return answer({model.shaped(), target, config, &model});
}

namespace {

std::vector<InverseResult> all_solutions(const Question& q) {
  const InverseConfig& config = q.config;
  if (q.is_position_out_of_reach() || q.is_orientation_out_of_reach()) return {};
  VariedTip problem(q, rows_of(q.target));
  BoundedDescent descent(problem.problem(), q.variables.bounds(), q.variables.size());
  descent.most_iterations = q.most_iterations();
  InverseStarts starts = q.starts();
  SolutionList list(q, descent);
  for (int i = 0; i < config.max_starts; ++i) {
    // The i-th start gets as many iterations as in a search for one solution, so that this solution is among
    // the results.
    Found found;
    found.starts = i;
    search(descent, starts, i + 1, found);
    if (found.is_met()) list.add(std::move(found));
  }
  std::vector<InverseResult> results;
  for (const Solution& solution : std::move(list).in_order()) {
    results.push_back(describe(q, solution.found));
    results.back().outcome = InverseOutcome::converged;
  }
  return results;
}

}  // namespace

std::vector<InverseResult> all_inverse_solutions(const Arm& arm, const TipTarget& target,
                                                 const InverseConfig& config) {
  check_question(target, config);
  return all_solutions({arm, target, config});
}

std::vector<InverseResult> all_inverse_solutions(const ArmModel& model, const TipTarget& target,
                                                 const InverseConfig& config) {
  if (model.actuation().is_identity()) return all_inverse_solutions(model.shaped(), target, config);
  check_question(target, config);
  return all_solutions({model.shaped(), target, config, &model});
}

std::string_view name_of(InverseOutcome outcome) {
  switch (outcome) {
    case InverseOutcome::converged:
      return "converged";
    case InverseOutcome::not_reachable:
      return "not_reachable";
    case InverseOutcome::at_limit:
      return "at_limit";
    case InverseOutcome::no_convergence:
      break;
  }
  return "no_convergence";
}

}  // namespace flexura
