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

/// What a limiter keeps to besides the arm's own limits.
struct LimiterConfig {
  double step = 1.0 / 30;           ///< Time from one command to the next, s; > 0.
  std::optional<Drive> drive = {};  ///< Its motors' speeds, step rates, accelerations and positions.
  /// From row to row of the command list that the motors follow, s: a rate that changes changes within that.
  /// 0: as `step`.
  double list_step = 0;
  std::vector<Obstacle> obstacles = {};  ///< Which no way may touch, with looks_ahead.
  bool looks_ahead = true;  ///< Every way is checked for contact (check_motions) until the arm would rest.
  int most_braking = 200;   ///< The most steps that coming to rest may take.
};

/// What a limiter makes of a command.
struct LimitedCommand {
  ArmState state;             ///< To be sent: where the arm is to be one step from now.
  bool is_untouched = false;  ///< It is what the law asked for, bit for bit.
  bool is_at_rest = false;    ///< The arm stays where the last command sent it.
  std::string reason;         ///< What held the law back; empty when it was not.
};

/// What is kept of a fault.
struct LimiterFault {
  double time = 0;                   ///< s since the limiter was made: its steps.
  std::string reason;                ///< Why the arm was stopped.
  std::optional<ArmState> observed;  ///< The last that observe() was told.
  ArmState sent;                     ///< The last command before it.
  std::optional<ArmState> asked;     ///< What the law asked for then.
};

/// Stands between a law and an arm's drives. Whatever the law asks for, what is sent
///   - is finite, within the arm's bends, stretches and folding, and changes no faster than its bends and
///     stretches may;
///   - keeps to the motors' speeds, step rates and accelerations (play and rounding are the drive's own), and
///     to their positions with both;
///   - can be brought to rest from there within all of these, and with `looks_ahead` without a contact on the
///     way: that way is kept, and gone when nothing else will do (docs/control.md, "The limiter").
/// A command that is not finite or of another arm, and every fault() from outside, stops the arm: it goes
/// that way to rest and stays there until reset().
class CommandLimiter {
 public:
  /// At rest in `start`, a command. std::invalid_argument: a state that does not fit the arm, breaks a limit
  /// or (with looks_ahead) touches something, a step that is not positive.
  CommandLimiter(ArmModel arm, LimiterConfig config, const ArmState& start);
  CommandLimiter(const Arm& driven, LimiterConfig config, const ArmState& start)
      : CommandLimiter(ArmModel(driven), std::move(config), start) {}

  /// The command for the next step, as near to `asked` as it can be: on the straight line in the rates from
  /// braking to the law's.
  [[nodiscard]] LimitedCommand next(const ArmState& asked);
  /// For laws that go the share `rate` times the step of what is left in each step (rate in 1/s): what such a
  /// law asks for, or less of it, so that every motor can still brake to where that leads, at half of its
  /// acceleration. Where no motor has one, `asked` itself.
  [[nodiscard]] ArmState within_braking(const ArmState& asked, double rate) const;
  /// The command for the next step of an arm that is to come to rest.
  [[nodiscard]] LimitedCommand brake();

  /// Tells what was seen last, for the record of a fault.
  void observe(const ArmState& observed) { observed_ = observed; }
  /// Stops the arm: a port's fault, a lost estimate. Of several the first one is kept.
  void fault(const std::string& reason);
  /// What would be kept of a fault for this reason now.
  [[nodiscard]] LimiterFault record(std::string reason) const {
    return {static_cast<double>(steps_) * config_.step, std::move(reason), observed_, sent_, asked_};
  }
  /// What stopped the arm; none since the start or the last reset().
  [[nodiscard]] const std::optional<LimiterFault>& fault() const { return fault_; }
  /// Goes on after a fault. std::logic_error before the arm rests.
  void reset();

  /// The last command.
  [[nodiscard]] const ArmState& sent() const { return sent_; }
  /// The arm stays where the last command sent it.
  [[nodiscard]] bool is_at_rest() const { return way_to_rest_.empty(); }

 private:
  struct Plan {
    std::vector<ArmState> way;  // the next state, and those on to rest
    bool is_allowed = false;
    std::string reason;  // why not
  };
  struct MotorStep {
    Eigen::VectorXd motors;        // At its end, microsteps.
    Eigen::VectorXd rates, swing;  // microsteps/s
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
  Arm arm_;  // As its drives see it.
  LimiterConfig config_;
  std::vector<LimitWatch> limits_;
  ArmState sent_;
  std::vector<ArmState> way_to_rest_;
  double row_ = 0, turning_time_ = 0;  // s
  MotorStep last_step_;                // Empty without drives.
  long steps_ = 0;
  std::optional<ArmState> observed_, asked_;
  std::optional<LimiterFault> fault_;
};

}  // namespace flexura
