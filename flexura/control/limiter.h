#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/model/arm_model.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/safety/limits.h"

namespace flexura {

/// Limits of a limiter in addition to the arm's own.
struct LimiterConfig {
  double step = 1.0 / 30;           ///< Time between commands, s; > 0.
  std::optional<Drive> drive = {};  ///< Limits of its motors' speed, step rate, acceleration, position.
  /// Time between rows of the command list that the motors follow, s: rates change within that. 0: `step`.
  double list_step = 0;
  std::vector<Obstacle> obstacles = {};  ///< Obstacles that no path may touch, with looks_ahead.
  bool looks_ahead = true;  ///< Checks every path for contact (check_motions) until the arm would rest.
  int most_braking = 200;   ///< Most steps to come to rest.
};

/// Command of a limiter.
struct LimitedCommand {
  ArmState state;             ///< Command to send: the arm's state one step from now.
  bool is_untouched = false;  ///< Equal to the law's command, bit for bit.
  bool is_at_rest = false;    ///< The arm stays at the last command.
  std::string reason;         ///< Why the law was held back, or "".
};

/// Record of a fault.
struct LimiterFault {
  double time = 0;                   ///< Time since the limiter was made, s: its steps.
  std::string reason;                ///< Why the arm was stopped.
  std::optional<ArmState> observed;  ///< Last state from observe().
  ArmState sent;                     ///< Last command before it.
  std::optional<ArmState> asked;     ///< Command of the law at that time.
};

/// Limits commands between a law and an arm's drives. For any command of the law, the command sent:
///   - Is finite and within the arm's bends, stretches and folding. It changes no faster than bends and
///     stretches may.
///   - Respects the motors' speeds, step rates and accelerations; their backlash and rounding are left to the
///     drive. It respects the motors' positions, with backlash and rounding.
///   - Can be brought to rest from there within all of these. With `looks_ahead` there is no contact on the
///     way. That way is kept, and followed if nothing else is allowed (docs/control.md, "The limiter").
/// A command that is not finite or of another arm, and every fault() from outside, stops the arm. It follows
/// that way to rest and stays there until reset().
class CommandLimiter {
 public:
  /// Starts at rest in `start`, a command. Throws std::invalid_argument for a state that does not fit the
  /// arm, breaks a limit or (with looks_ahead) touches something. Also for a step that is not positive.
  CommandLimiter(ArmModel arm, LimiterConfig config, const ArmState& start);
  CommandLimiter(const Arm& driven, LimiterConfig config, const ArmState& start)
      : CommandLimiter(ArmModel(driven), std::move(config), start) {}

  /// Returns the command for the next step, as near to `asked` as possible: on the straight line in the rates
  /// from braking to the law's.
  [[nodiscard]] LimitedCommand next(const ArmState& asked);
  /// Returns a law's command, or less of it, so that every motor can still brake to its target, at half of
  /// its acceleration. For laws that cover the share `rate` times the step of the rest in each step (rate in
  /// 1/s). Returns `asked` if no motor has an acceleration limit.
  [[nodiscard]] ArmState within_braking(const ArmState& asked, double rate) const;
  /// Returns the command for the next step of an arm that has to come to rest.
  [[nodiscard]] LimitedCommand brake();

  /// Stores the last observation, for the record of a fault.
  void observe(const ArmState& observed) { observed_ = observed; }
  /// Stops the arm: a port's fault, a lost estimate. Keeps the first of several faults.
  void fault(const std::string& reason);
  /// Returns the record of a fault for this reason now.
  [[nodiscard]] LimiterFault record(std::string reason) const {
    return {static_cast<double>(steps_) * config_.step, std::move(reason), observed_, sent_, asked_};
  }
  /// Returns the fault that stopped the arm; std::nullopt if there was none since the start or the last
  /// reset().
  [[nodiscard]] const std::optional<LimiterFault>& fault() const { return fault_; }
  /// Continues after a fault. Throws std::logic_error before the arm is at rest.
  void reset();

  /// Returns the last command.
  [[nodiscard]] const ArmState& sent() const { return sent_; }
  /// Returns true if the arm stays at the last command.
  [[nodiscard]] bool is_at_rest() const { return path_to_rest_.empty(); }

 private:
  struct Plan {
    std::vector<ArmState> way;  // The next state, and the following ones to rest.
    bool is_allowed = false;
    std::string reason;  // Why not.
  };
  struct MotorStep {
    Eigen::VectorXd motors;        // At its end, microsteps.
    Eigen::VectorXd rates, swing;  // In microsteps/s.
  };
  [[nodiscard]] MotorStep motor_step(const ArmState& from, const Eigen::VectorXd& motors_from,
                                     const ArmState& to) const;
  [[nodiscard]] ArmState within_limits(const ArmState& asked, std::string& reason) const;
  [[nodiscard]] Plan plan(const ArmState& next, bool looks_ahead) const;
  [[nodiscard]] std::string breach(const std::vector<ArmState>& way) const;
  [[nodiscard]] std::string breach_of_motors(const std::vector<ArmState>& way) const;
  [[nodiscard]] std::string contact(const std::vector<ArmState>& way) const;
  [[nodiscard]] Eigen::VectorXd motors_at(const ArmState& state) const;
  [[nodiscard]] int braking_steps(const ArmState& next) const;
  LimitedCommand send(Plan plan, std::string reason, bool is_untouched);

  ArmModel model_;
  Arm arm_;  // Arm as its drives see it.
  LimiterConfig config_;
  std::vector<LimitWatch> limits_;
  ArmState sent_;
  std::vector<ArmState> path_to_rest_;
  double row_ = 0, turning_time_ = 0;  // In s.
  MotorStep last_step_;                // Empty without drives.
  long steps_ = 0;
  std::optional<ArmState> observed_, asked_;
  std::optional<LimiterFault> fault_;
};

}  // namespace flexura
