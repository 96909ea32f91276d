#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"

namespace flexura {

/// Settings of the predictive law.
struct PredictiveLawConfig {
  double step = 1.0 / 30;  ///< Time between commands, s; > 0.
  int horizon = 18;        ///< Number of predicted steps; >= 1.
  /// Approximate decay rate of errors while no limit is active, 1/s; > 0.
  double rate = 6;
  int most_iterations = 60;  ///< Largest number of iterations of the quadratic program's solver.
};

/// A linear limit on all commands u of the horizon: by_command (u - sent) <= room.
struct PredictiveLimit {
  Eigen::RowVectorXd by_command;  ///< Derivatives with respect to bend_x, bend_y and stretch of each section.
  /// Distance of the present command `sent` from the limit; negative if `sent` violates the limit.
  double room = 0;
  std::string name = {};  ///< What is limited, for messages.
};

/// Input of a step of the law: the state of an arm, and its target from now on.
struct PredictiveState {
  ArmState sent;     ///< Last command. The drives have reached this command.
  ArmState rate;     ///< Rate at which commands changed in the last step: bends in rad/s, stretches in 1/s.
  ArmState rest;     ///< Shape of the arm at rest under `sent`.
  ArmState desired;  ///< Target shape now.
  /// Target shape at the end of each later step. If the list is shorter than the horizon, the last target
  /// also applies to the remaining steps.
  std::vector<ArmState> desired_later = {};
  std::vector<PredictiveLimit> limits = {};
  std::vector<SwingMode> modes = {};  ///< Modes of the arm's oscillation; empty for an arm without dynamics.
  Eigen::VectorXd swing = {};         ///< Modal coordinates z of all modes, then their rates z'.
  /// Estimated frequency of each mode, as a factor on SwingMode::frequency.
  Eigen::VectorXd frequency_factors = {};
};

/// Model predictive control of an arm's shape (docs/control.md, "Predictive law"). Over a horizon, the law
/// chooses the changes a_k of the command's rate that minimise
///   sum over k of |e_k|^2 + rho |a_k / step|^2,
/// where e_k is the predicted distance from the target, root mean square along the arm, share of its length.
/// The prediction is linear about the present command. Commands change the equilibrium shape according to its
/// derivative and excite the modes, which oscillate freely in between. The law limits bends and bend rates,
/// and satisfies the given linear limits (PredictiveLimit); stretches are not limited. The solver is the
/// alternating direction method of multipliers (Boyd et al., 2011), with projections on discs and
/// half-spaces. The iterations of this method satisfy the limits approximately. The next command satisfies
/// the limits of bends and rates exactly. A limiter must check the command.
class PredictiveLaw {
 public:
  /// `driven`: the arm in terms of the sections that the drives bend. `shaped`: the arm with one section per
  /// arc. Throws std::invalid_argument for numbers out of range.
  PredictiveLaw(const Arm& driven, const Arm& shaped, const PredictiveLawConfig& config);

  /// Returns the command for the end of the next step. `by_command`: derivative of the equilibrium shape with
  /// respect to the command, (3 arcs) x (3 sections) (Actuation::slopes).
  [[nodiscard]] ArmState step(const PredictiveState& now, const Eigen::MatrixXd& by_command);

  /// Quadratic program of the last step, for comparison with other solvers. The changes x of the rates
  /// minimise x^T H x / 2 + gradient^T x. The references are valid until the next step.
  struct Problem {
    const Eigen::MatrixXd& H;
    const Eigen::VectorXd& gradient;
    const Eigen::VectorXd& found;  ///< Changes of the rates that the solver found.
  };
  [[nodiscard]] Problem problem() const { return {H_, gradient_, changes_}; }
  /// Returns the index of the linear limit that restricts the last step's commands most; std::nullopt if none
  /// does.
  [[nodiscard]] std::optional<std::size_t> active_limit() const { return active_limit_; }

 private:
  struct Disc {
    Eigen::Index at = 0;  // First of its numbers in a step's variables.
    Eigen::Index size = 2;
    double bend = 0, rate = 0;  // Largest.
  };
  void find_metric(const ArmState& shape);
  void predict(const PredictiveState& now, const Eigen::MatrixXd& by_command);
  void set_limits(const PredictiveState& now);
  void solve(const Eigen::VectorXd& sent, const Eigen::VectorXd& rate);

  Arm driven_, shaped_;
  PredictiveLawConfig config_;
  ArmVariables variables_;
  std::vector<Disc> discs_;
  double effort_ = 0;                    // rho
  Eigen::MatrixXd metric_;               // Rows whose square sum is |e|^2, by (bend_x, bend_y) of the arcs.
  std::vector<Eigen::MatrixXd> answer_;  // Weighted error, m steps after a change of rate.
  std::vector<Eigen::MatrixXd> end_;     // Weighted error at the end, by the change of each step.
  Eigen::VectorXd free_, free_end_;      // Weighted errors without changes.
  Eigen::VectorXd changes_;              // The changes found.
  Eigen::MatrixXd limit_rows_;           // Of the linear limits, by the variables, each of norm 1.
  Eigen::VectorXd limit_rooms_;          // In every step: rows times (command - sent) must not exceed these.
  std::optional<std::size_t> active_limit_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd gradient_;
};

}  // namespace flexura
