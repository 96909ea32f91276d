#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_error.h"
#include "flexura/servo/servo_session.h"

namespace flexura {

/// Decides whether a servo has reached its target, or can no longer reach it.
class ServoJudge {
 public:
  /// `begun`: start of the session, s. `last_goal`: time of the last target, s after `begun`.
  ServoJudge(const ServoConfig& config, double begun, double last_goal)
      : config_(config), goal_time_(begun + last_goal) {}

  /// Adds a completed step.
  void add(const ServoStep& step);

  [[nodiscard]] bool is_done() const { return is_done_; }
  /// Returns why the servo must end as failed; std::nullopt while it can still reach the target.
  [[nodiscard]] const std::optional<std::string>& failure() const { return failure_; }

 private:
  void add_error(const ServoStep& step);
  [[nodiscard]] std::string why_not() const;

  const ServoConfig& config_;
  double goal_time_;
  bool is_done_ = false;
  std::optional<std::string> failure_;
  std::optional<double> below_since_, worse_since_;
  double seen_at_ = -1e300;           // Time of the last new observation that was used, s.
  double best_ = 1e300, latest_ = 0;  // Smallest and latest error, shares of the length.
  ArmState desired_;                  // Target at the previous observation.
  double limited_for_ = 0;            // Recent time with limited commands, s.
  std::string limited_by_;
  bool is_singular_ = false;
};

/// Statistics of a servo's steps, updated with each step. The memory of a ServoJudge does not grow with the
/// number of steps.
class ServoTally {
 public:
  /// `begun`: start of the session, s. `last_goal`: time of the last target, s after `begun`. `arm` must
  /// outlive this object.
  ServoTally(const Arm& arm, const ServoConfig& config, double begun, double last_goal)
      : arm_(arm), begun_(begun), last_goal_(last_goal), late_(config.settle) {}

  /// Adds a completed step.
  void add(const ServoStep& step);
  /// Writes these statistics into a result.
  void finish(ServoResult& result) const;

 private:
  void add_overshoot(const ServoStep& step);

  const Arm& arm_;
  double begun_, last_goal_;
  std::optional<double> settled_;
  LateErrors late_;
  // Position of the tip at the time of the last target, and the vector from there to the target, m.
  std::optional<Eigen::Vector3d> tip_;
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero();
  double overshoot_ = 0;
};

}  // namespace flexura
