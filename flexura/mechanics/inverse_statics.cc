#include "flexura/mechanics/inverse_statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/hash.h"
#include "flexura/mechanics/least_effort.h"
#include "flexura/mechanics/rod_target_problem.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Near buckling a descent creeps towards tensions at which the rod jumps; then another start is better.
constexpr DescentLimits far{.iterations = 200, .slope = 1e-4, .most_slow = 8};
// Limits of the search for the nearest point of an unreachable target.
constexpr DescentLimits slow{.iterations = 400, .slope = 1e-6};
// Accuracy of the searches relative to the tolerance, so that the tolerance does not affect the effort.
constexpr double aim = 0.01;

std::string input_problem(const RodStatics& statics, const RodTarget& target, const std::vector<double>& most,
                          const InverseStaticsConfig& config) {
  const std::size_t count = statics.chain().tendons();
  if (count == 0) return "a rod without tendons";
  if (most.size() != count)
    return fmt::format("{} largest tensions given: expected {}, one per tendon", most.size(), count);
  for (const double each : most)
    if (!std::isfinite(each) || each < 0) return "the largest tension of a tendon is negative or not finite";
  if (!target.position && !target.direction && !target.rotation && target.places.empty())
    return "the target is empty: expected a position, a direction, a rotation or places";
  if (target.position && !target.position->allFinite()) return "the target position must be finite";
  if (target.direction && target.rotation)
    return "both direction and rotation are given: expected only one of them";
  if (target.direction && (!target.direction->allFinite() || target.direction->norm() == 0))
    return "the target direction must be finite and not zero";
  if (target.rotation) {
    const Eigen::Matrix3d& R = *target.rotation;
    if (!R.allFinite() || !((R.transpose() * R).isIdentity(1e-6)) ||
        !(R.col(0).cross(R.col(1)).dot(R.col(2)) > 0))
      return "the target rotation is not a rotation matrix";
  }
  if (!std::isfinite(target.angle_weight) || target.angle_weight <= 0)
    return "the weight of angles must be above 0";
  for (const RodTarget::Place& place : target.places) {
    if (!place.position.allFinite()) return "the target position of a place must be finite";
    if (!node_of(statics.chain(), place.place))
      return fmt::format("the place at {} of section {} is not a node of the rod", place.place.at,
                         place.place.section);
  }
  if (!std::isfinite(config.tolerance) || config.tolerance <= 0) return "the tolerance must be above 0";
  if (config.max_starts < 1) return "no starts";
  if (config.start && (!config.start->converged() || config.start->tensions.size() != count ||
                       config.start->q.size() != statics.chain().size()))
    return "the start is not an equilibrium of this rod";
  if (config.start && std::ranges::any_of(config.start->tensions, [](double t) { return !std::isfinite(t); }))
    return "the tensions of the start must be finite";
  return "";
}

// Searches from different tensions, and the best result so far.
class InverseSearch {
 public:
  InverseSearch(RodStatics& statics, const RodTarget& target, const RodLoads& loads,
                const std::vector<double>& most, const InverseStaticsConfig& config)
      : config_(config),
        target_(target),
        most_(most),
        problem_(statics, target, loads, most, aim * config.tolerance),
        bounds_(most.size()),
        descent_(problem_, bounds_, static_cast<Index>(most.size())),
        x_(static_cast<Index>(most.size())) {
    if (config.start) from_ = *config.start;
  }

  InverseStaticsResult run() {
    InverseStaticsResult result;
    if (!begin(result)) return result;
    for (int start = 0; start < config_.max_starts; ++start) {
      if (!set_start(start)) continue;
      ++result.starts;
      search();
      if (is_reached_ && !config_.all_starts) break;
    }
    if (!is_reached_) come_nearest();
    finish(result);
    return result;
  }

 private:
  // Sets the unit of tensions: what moves the rod by about its length, by its initial derivative.
  bool begin(InverseStaticsResult& result) {
    set_bounds();
    x_.setZero();
    if (config_.start) set_tensions(config_.start->tensions);
    result.equilibrium = problem_.at(x_, from_, descent_.r, descent_.J);
    if (!result.equilibrium.converged()) {
      result.end = result.equilibrium.end == StaticsEnd::bad_input ? InverseStaticsEnd::bad_input
                                                                   : InverseStaticsEnd::no_equilibrium;
      result.problem = result.equilibrium.end == StaticsEnd::bad_input ? result.equilibrium.problem
                                                                       : words(result.equilibrium.end);
      result.evaluations = problem_.evaluations;
      return false;
    }
    const double answer = descent_.J.colwise().norm().maxCoeff(), highest = std::ranges::max(most_);
    problem_.unit = answer * highest > 1 ? 1 / answer : std::max(highest, 1e-300);
    set_bounds();
    return true;
  }
  void set_bounds() {
    for (std::size_t i = 0; i < most_.size(); ++i)
      bounds_[i] = Bound::interval(static_cast<Index>(i), 0, most_[i] / problem_.unit);
  }
  void set_tensions(const std::vector<double>& tensions) {
    for (std::size_t i = 0; i < tensions.size(); ++i) x_[static_cast<Index>(i)] = tensions[i] / problem_.unit;
    project(bounds_, x_);
  }

  // Starts: the robot's state or zero tensions; some tension on all; each tendon alone; at random. Reduces
  // tensions under which the rod has no equilibrium. Returns false if the start is not new.
  bool set_start(int start) {
    const int count = static_cast<int>(most_.size());
    x_.setZero();
    if (start == 0) {
      if (config_.start) set_tensions(config_.start->tensions);
    } else if (start == 1) {
      x_.setConstant(0.3);
    } else if (start < 2 + count) {
      if (most_[static_cast<std::size_t>(start - 2)] == 0) return false;
      x_[start - 2] = 1;
    } else {
      for (int i = 0; i < count; ++i) {
        const std::uint64_t drawn = hash(static_cast<std::uint64_t>(start), static_cast<std::uint64_t>(i));
        if (drawn % 2 == 0) x_[i] = 3 * static_cast<double>(drawn >> 11) * 0x1p-53;
      }
    }
    project(bounds_, x_);
    constexpr int most_halvings = 5;
    for (int i = 0; start > 0 && i < most_halvings; ++i) {
      if (problem_.at(x_, from_, descent_.r, descent_.J).converged()) break;
      x_ *= 0.5;
    }
    return true;
  }

  void search() {
    problem_.begin(from_);
    const bool is_met = descent_.descend(far, x_) == Descent::met;
    const bool is_least = is_met && run_down_to_least(descent_, x_);
    Equilibrium at = problem_.at(x_, from_, descent_.r, descent_.J);
    const double square = descent_.r.squaredNorm();
    // A solution reached only from nearby is another equilibrium than the robot's.
    const bool is_reached = at.stable && is_within();
    const bool is_better = is_reached ? !is_reached_ || x_.squaredNorm() < best_.squaredNorm()
                                      : !is_reached_ && square < best_square_;
    is_current_ = is_better;
    if (!is_better) return;
    best_ = x_, best_square_ = square;
    is_reached_ = is_reached, is_least_ = is_least;
    near_ = std::move(at);
  }

  // For large residuals Gauss and Newton's model of the curvature is wrong.
  void come_nearest() {
    if (best_.size() == 0 || best_square_ == 0) return;
    x_ = best_;
    is_current_ = false;
    problem_.begin(near_);
    const Descent end = descent_.descend_gradient(slow, x_);
    is_stationary_ = end == Descent::stationary;
    const Equilibrium at = problem_.at(x_, from_, descent_.r, descent_.J);
    if (!(descent_.r.squaredNorm() < best_square_)) return;
    best_ = x_;
    is_reached_ = at.stable && is_within();
  }
  [[nodiscard]] bool is_within() const {
    return problem_.position_error(descent_.r) <= config_.tolerance &&
           target_.angle_weight * problem_.angle_error(descent_.r) <= config_.tolerance;
  }

  void finish(InverseStaticsResult& result) {
    x_ = best_.size() > 0 ? best_ : VectorXd::Zero(x_.size());
    result.equilibrium = is_current_ ? near_ : problem_.at(x_, from_, descent_.r, descent_.J);
    result.tensions = result.equilibrium.tensions;
    result.evaluations = problem_.evaluations;
    result.position_error = problem_.position_error(descent_.r);
    result.angle_error = problem_.angle_error(descent_.r);
    for (const double tension : result.tensions) result.effort += tension * tension;
    result.is_least = is_reached_ && is_least_;
    result.end = is_reached_ ? InverseStaticsEnd::reached : InverseStaticsEnd::nearest;
    if (!is_reached_) result.problem = why_not(result.equilibrium);
  }
  [[nodiscard]] std::string why_not(const Equilibrium& at) {
    if (at.converged() && is_within()) return "the equilibrium at the target is not stable";
    if (!is_stationary_) return "the search ended after its largest number of steps";
    descent_.gradient = descent_.J.transpose() * descent_.r;
    const bool is_held = pressure(bounds_, x_, descent_.gradient) > 1e-6 * descent_.r.norm();
    return is_held ? "the bounds of the tensions prevent it: a tendon would have to push, or to exceed its "
                     "largest tension"
                   : "no small change of the tensions reduces the distance from the target";
  }

  const InverseStaticsConfig& config_;
  const RodTarget& target_;
  const std::vector<double>& most_;
  RodTargetProblem problem_;
  Bounds bounds_;
  BoundedDescent descent_;
  Equilibrium from_, near_;
  VectorXd x_, best_;
  double best_square_ = std::numeric_limits<double>::infinity();
  bool is_reached_ = false, is_least_ = false, is_stationary_ = false;
  bool is_current_ = false;  // The statics, r and J are those of the best.
};

}  // namespace

const char* words(InverseStaticsEnd end) {
  switch (end) {
    case InverseStaticsEnd::reached:
      return "reached";
    case InverseStaticsEnd::nearest:
      return "not reached: the nearest";
    case InverseStaticsEnd::bad_input:
      return "bad input";
    case InverseStaticsEnd::no_equilibrium:
      break;
  }
  return "no equilibrium found for the start of the search";
}

InverseStaticsResult solve_inverse_statics(RodStatics& statics, const RodTarget& target,
                                           const RodLoads& loads, const std::vector<double>& most,
                                           const InverseStaticsConfig& config) {
  InverseStaticsResult result;
  result.problem = input_problem(statics, target, most, config);
  if (!result.problem.empty()) return result;
  return InverseSearch(statics, target, loads, most, config).run();
}

}  // namespace flexura
