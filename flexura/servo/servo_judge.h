#pragma once

#include <optional>
#include <string>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_session.h"

namespace flexura {

/// Says when a servo is at its goal, and when it will not come there.
class ServoJudge {
 public:
  /// `begun`: the session's start; `last_goal`: when the last goal is wanted, s from there.
  ServoJudge(const ServoConfig& config, double begun, double last_goal)
      : config_(config), goal_time_(begun + last_goal) {}

  /// A step that was made.
  void add(const ServoStep& step);

  [[nodiscard]] bool is_done() const { return is_done_; }
  /// Why the servo is to be given up; none while there is hope.
  [[nodiscard]] const std::optional<std::string>& hopeless() const { return hopeless_; }

 private:
  void add_error(const ServoStep& step);
  [[nodiscard]] std::string why_not() const;

  const ServoConfig& config_;
  double goal_time_;
  bool is_done_ = false;
  std::optional<std::string> hopeless_;
  std::optional<double> below_since_, worse_since_;
  double seen_at_ = -1e300;           // When a new sight was last gone by, s.
  double best_ = 1e300, latest_ = 0;  // Shares of the length.
  double limited_for_ = 0;            // s, of late
  std::string limited_by_;
  bool is_singular_ = false;
};

/// Fills in what a result says of how fast and how well its steps came to their goal.
void add_figures(const Arm& arm, const ServoConfig& config, double last_goal, ServoResult& result);

}  // namespace flexura
