#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/kinematics/curve_problem.h"
#include "flexura/kinematics/driven_problem.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/inverse_check.h"
#include "flexura/kinematics/inverse_search.h"
#include "flexura/kinematics/reach.h"
#include "flexura/kinematics/spatial.h"

namespace flexura {
namespace {

// A curve determines much of the arm, so a few starts suffice. Each iteration evaluates the whole backbone.
constexpr int most_starts = 8;
constexpr int most_iterations = 100;  // From one start.
// Share of the arm's length: a larger error would be visible.
constexpr double most_allowance = 1e-2;

std::vector<Eigen::Vector3d> in_base(const Arm& arm, const std::vector<Eigen::Vector3d>& points) {
  const Pose X_BW = arm.X_WB.inverse();
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& p_WP : points) result.push_back(X_BW * p_WP);
  return result;
}

// Returns the largest number of iterations for all starts together. One iteration for hundreds of sections
// takes a considerable part of a second, and the result no_convergence is better than no result.
int affordable_iterations(const CurveProblem& problem, const ArmVariables& variables, int most) {
  constexpr double most_products = 5e9;
  const auto size = static_cast<double>(variables.size());
  const double products = static_cast<double>(problem.row_count()) * size * size;
  return static_cast<int>(std::clamp(most_products / products, 40.0, static_cast<double>(most)));
}

// Returns true if the curve is out of reach because one of its ends is.
bool is_out_of_reach(const Arm& arm, const std::vector<Eigen::Vector3d>& points, double tolerance) {
  const double rounding = 1e-14 * points.back().norm();
  return points.front().norm() > tolerance + 1e-14 * points.front().norm() ||
         least_distance(arm, points.back()) > tolerance + rounding;
}

}  // namespace

// A polyline turns at its points. The smooth curve turns by the same angle from the middle of one piece to
// that of the next.
double polyline_error(const std::vector<Eigen::Vector3d>& points) {
  constexpr double corner = std::numbers::pi / 3;
  std::vector<Eigen::Vector3d> pieces;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i] != points[i - 1]) pieces.emplace_back(points[i] - points[i - 1]);
  }
  const auto turn = [&](std::size_t i) {  // Between the pieces i - 1 and i.
    if (i == 0 || i >= pieces.size()) return 0.0;
    const double angle = std::atan2(pieces[i - 1].cross(pieces[i]).norm(), pieces[i - 1].dot(pieces[i]));
    return angle < corner ? angle : 0.0;
  };
  double bulge = 0.0;
  double missing = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double angle = std::max(turn(i), turn(i + 1));
    const double chord = pieces[i].norm();
    bulge = std::max(bulge, 0.5 * chord * std::tan(angle / 4));
    missing += angle > 0.0 ? chord * (0.5 * angle / std::sin(0.5 * angle) - 1.0) : 0.0;
  }
  return bulge + missing;
}

namespace {

// A curve's problem in the variables: commands of a model, otherwise shapes.
class VariedCurve {
 public:
  VariedCurve(const Arm& arm, const ArmModel* model, const std::vector<Eigen::Vector3d>& points)
      : driven_(model != nullptr ? std::optional<DrivenVariables>(*model) : std::nullopt),
        variables_(model != nullptr ? model->driven() : arm),
        length_(variables_.max_length()),
        of_shape_(driven_ ? driven_->shaped() : variables_, points, length_) {
    if (driven_) of_command_.emplace(*driven_, of_shape_);
  }
  VariedCurve(const VariedCurve&) = delete;
  VariedCurve& operator=(const VariedCurve&) = delete;
  ~VariedCurve() = default;

  [[nodiscard]] const ArmVariables& variables() const { return variables_; }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const CurveProblem& of_shape() const { return of_shape_; }
  [[nodiscard]] BoundedProblem& problem() {
    return of_command_ ? static_cast<BoundedProblem&>(*of_command_) : of_shape_;
  }
  [[nodiscard]] double largest_distance(const Eigen::VectorXd& x) {
    return of_shape_.largest_distance(driven_ ? driven_->shape(x) : x);
  }
  [[nodiscard]] Eigen::VectorXd start_along_tangents() const {
    const Eigen::VectorXd shape = of_shape_.start_along_tangents();
    return driven_ ? driven_->command(shape) : shape;
  }

 private:
  std::optional<DrivenVariables> driven_;
  ArmVariables variables_;
  double length_;
  CurveProblem of_shape_;
  std::optional<DrivenProblem> of_command_;
};

// `arm` is that of the shapes.
InverseResult answer(const Arm& arm, const ArmModel* model, const CurveTarget& target,
                     const InverseConfig& config) {
  check_question(target, config);
  const std::vector<Eigen::Vector3d> points = in_base(arm, target.points);
  VariedCurve curve(arm, model, points);
  const ArmVariables& variables = curve.variables();
  const double length = curve.length();
  const double allowance = std::min(1e-3 * length + 2.0 * polyline_error(points), most_allowance * length);
  const double tolerance = config.position_tolerance.value_or(allowance);
  BoundedDescent descent(curve.problem(), variables.bounds(), variables.size());
  // Limits iterations for rods, as for tips.
  if (model != nullptr && !model->actuation().is_linear()) descent.most_iterations = 400;
  std::optional<Eigen::VectorXd> first = curve.start_along_tangents();
  if (config.start) first = variables.pack(*config.start);
  InverseStarts starts(variables, curve.of_shape().end(), first, config.seed);

  Found found;
  Eigen::VectorXd x(variables.size());
  double error = 0.0;
  const int affordable = affordable_iterations(curve.of_shape(), variables, most_starts * most_iterations);
  while (found.starts < std::min(config.max_starts, most_starts) && descent.iterations < affordable) {
    if (config.start && found.starts == 1) {
      x = curve.start_along_tangents();
    } else {
      starts.next(x);
    }
    const DescentLimits limits{.iterations = std::min(most_iterations, affordable - descent.iterations),
                               .slope = 1e-7};
    const Descent ended = descent.descend(limits, x);
    found.keep_better(x, descent.square, ended);
    ++found.starts;
    error = curve.largest_distance(found.x);
    if (error <= tolerance) break;
  }

  if (error > tolerance && found.ended == Descent::exhausted) {
    const int settling = affordable_iterations(curve.of_shape(), variables, settling_iterations);
    settle(descent, settling, found);
    error = curve.largest_distance(found.x);
  }
  InverseResult result;
  result.state = variables.state(found.x);
  result.tip =
      tip_pose(arm, model != nullptr ? model->actuation().shape(result.state) : result.state).position;
  result.position_error = error;
  result.position_tolerance = tolerance;
  result.iterations = descent.iterations;
  result.starts = found.starts;
  if (error <= tolerance) {
    result.outcome = InverseOutcome::converged;
  } else if (is_out_of_reach(arm, points, tolerance)) {
    result.outcome = InverseOutcome::not_reachable;
    result.is_proven = true;
  } else {
    result.outcome = outcome_of_missed(descent, found);
  }
  return result;
}

}  // namespace

InverseResult solve_inverse(const Arm& arm, const CurveTarget& target, const InverseConfig& config) {
  return answer(arm, nullptr, target, config);
}

InverseResult solve_inverse(const ArmModel& model, const CurveTarget& target, const InverseConfig& config) {
  const bool is_plain = model.actuation().is_identity();
  return answer(model.shaped(), is_plain ? nullptr : &model, target, config);
}

}  // namespace flexura
