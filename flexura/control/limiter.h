#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/safety/limits.h"

namespace flexura {

class ContactWatch;
struct ConvexLimits;

/// Limits of a limiter, in addition to the limits of the arm.
struct LimiterConfig {
  double step = 1.0 / 30;  ///< Time between commands, s; > 0.
  std::optional<Drive> drive =
      {};  ///< Drive of the arm: limits of its motors' speed, step rate, acceleration and position.
  /// Time between the rows of the command list that the motors follow, s; 0: `step`. The rates of the motors
  /// change within this time.
  double list_step = 0;
  std::vector<Obstacle> obstacles =
      {};  ///< Obstacles that the arm must not touch; checked only with looks_ahead.
  bool looks_ahead =
      true;  ///< Whether to check the path for contact (check_motions), up to where the arm can be at rest.
  int most_braking = 200;  ///< Largest number of steps in which the arm must come to rest.
};

/// Command of a limiter.
struct LimitedCommand {
  ArmState state;             ///< Command to send: the arm's state one step from now.
  bool is_untouched = false;  ///< Whether the command equals the law's command, bit for bit.
  bool is_at_rest = false;    ///< Whether the arm stays at the last command.
  std::string reason;         ///< Why the law's command was changed, or "".
};

/// Record of a fault that stopped the arm.
struct LimiterFault {
  double time = 0;     ///< Time since the limiter was constructed, s: number of steps times `step`.
  std::string reason;  ///< Why the arm was stopped.
  std::optional<ArmState> observed;  ///< Last observed state, given to observe().
  ArmState sent;                     ///< Last command before the fault.
  std::optional<ArmState> asked;     ///< Command of the law at the time of the fault.
};

/// Limits commands between a law and an arm's drives. Whatever the law's command, the command that is sent:
///   - Is finite and within the arm's limits of bends, stretches and folding. The sent command changes within
///     the rate limits of bends and stretches.
///   - Respects the motors' limits of speed, step rate and acceleration, without backlash, friction and
///     rounding. Respects the motors' limits of position, with backlash, friction and rounding.
///   - Allows the arm to brake to rest within all these limits. If `looks_ahead` is true, this braking path
///     is free of contact. The limiter keeps the braking path and follows it if no other command is allowed
///     (docs/control.md, "The limiter").
/// A command that is not finite or does not fit the arm, and every call of fault(), stops the arm. The arm
/// follows its braking path to rest and stays there until reset().
class CommandLimiter {
 public:
  /// `start`: the command at which the arm is initially at rest. Throws std::invalid_argument if this state
  /// does not fit the arm, violates a limit or (with looks_ahead) causes a contact. Also throws
  /// std::invalid_argument for a step that is not positive.
  CommandLimiter(ArmModel arm, LimiterConfig config, const ArmState& start);
  CommandLimiter(const Arm& driven, LimiterConfig config, const ArmState& start)
      : CommandLimiter(ArmModel(driven), std::move(config), start) {}

  /// Returns the command for the next step: the allowed command that is nearest to `asked`. Distance is the
  /// Euclidean norm over bends (rad) and stretches. Limits are linearised about the present command. If the
  /// linearisation is too inexact, the command is between the braking command and the nearest command.
  [[nodiscard]] LimitedCommand next(const ArmState& asked);
  /// Returns a shorter step towards the law's command, so that every motor can brake to its target at half
  /// its largest acceleration. This function is meant for laws that reduce the error in each step by the
  /// share `rate` (1/s) times the step's duration. Returns `asked` if no motor has an acceleration limit.
  [[nodiscard]] ArmState within_braking(const ArmState& asked, double rate) const;
  /// Returns the command for the next step on the braking path.
  [[nodiscard]] LimitedCommand brake();

  /// Stores the last observation, for the record of a fault.
  void observe(const ArmState& observed) { observed_ = observed; }
  /// Stops the arm because of a fault, such as an error of a port or a lost estimate. If several faults
  /// occur, the limiter keeps the first fault.
  void fault(const std::string& reason);
  /// Returns the record of a fault that occurs now because of `reason`.
  [[nodiscard]] LimiterFault record(std::string reason) const {
    return {static_cast<double>(steps_) * config_.step, std::move(reason), observed_, sent_, asked_};
  }
  /// Returns the fault that stopped the arm; std::nullopt without a fault since the start or the last
  /// reset().
  [[nodiscard]] const std::optional<LimiterFault>& fault() const { return fault_; }
  /// Clears the fault, so that commands are followed again. Throws std::logic_error if the arm is not yet at
  /// rest.
  void reset();

  /// Returns the last command.
  [[nodiscard]] const ArmState& sent() const { return sent_; }
  /// Returns true if the arm stays at the last command.
  [[nodiscard]] bool is_at_rest() const { return path_to_rest_.empty(); }

 private:
  struct Plan {
    std::vector<ArmState> way;  // The next state, and the following ones to rest.
    bool is_allowed = false;
    bool touches = false;  // Contact is the only reason why it is not allowed.
    std::string reason;    // Why the plan is not allowed.
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
  // Returns the allowed command that is nearest to `desired`, by linear limits; with contacts if
  // `keeps_clear`.
  [[nodiscard]] std::optional<ArmState> nearest(const ArmState& desired, bool keeps_clear) const;
  void add_motor_limits(ConvexLimits& limits) const;
  void add_clearances(const ArmState& desired, ConvexLimits& limits) const;
  [[nodiscard]] Eigen::VectorXd motors_at(const ArmState& state) const;
  [[nodiscard]] int braking_steps(const ArmState& next) const;
  LimitedCommand send(Plan plan, std::string reason, bool is_untouched);

  ArmModel model_;
  Arm arm_;  // Arm as its drives see it.
  LimiterConfig config_;
  ArmVariables variables_;
  std::vector<LimitWatch> limits_;
  std::shared_ptr<const std::vector<ContactWatch>>
      contacts_;  // Of the shape; empty if it does not look ahead.
  ArmState sent_;
  std::vector<ArmState> path_to_rest_;
  double row_ = 0, turning_time_ = 0;  // In s.
  MotorStep last_step_;                // Empty without drives.
  long steps_ = 0;
  std::optional<ArmState> observed_, asked_;
  std::optional<LimiterFault> fault_;
};

}  // namespace flexura
