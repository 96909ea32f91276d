#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_error.h"
#include "flexura/servo/servo_session.h"

namespace flexura {

/// Decides when a servo has reached its target, and when it cannot.
class ServoJudge {
 public:
  /// `begun`: start of the session; `last_goal`: time of the last target, s from there.
  ServoJudge(const ServoConfig& config, double begun, double last_goal)
      : config_(config), goal_time_(begun + last_goal) {}

  /// Adds a completed step.
  void add(const ServoStep& step);

  [[nodiscard]] bool is_done() const { return is_done_; }
  /// Returns the reason to end the servo; std::nullopt while it can still succeed.
  [[nodiscard]] const std::optional<std::string>& failure() const { return failure_; }

 private:
  void add_error(const ServoStep& step);
  [[nodiscard]] std::string why_not() const;

  const ServoConfig& config_;
  double goal_time_;
  bool is_done_ = false;
  std::optional<std::string> failure_;
  std::optional<double> below_since_, worse_since_;
  double seen_at_ = -1e300;           // Time of the last new observation used, s.
  double best_ = 1e300, latest_ = 0;  // Shares of the length.
  ArmState desired_;                  // Target at the previous observation.
  double limited_for_ = 0;            // Recent, s.
  std::string limited_by_;
  bool is_singular_ = false;
};

/// Statistics of a servo's steps, updated with each step. Keeps the last `settle` s of errors, however long
/// the servo runs.
class ServoTally {
 public:
  /// `begun`: start of the session; `last_goal`: time of the last target, s from there. `arm` must outlive
  /// this object.
  ServoTally(const Arm& arm, const ServoConfig& config, double begun, double last_goal)
      : arm_(arm), begun_(begun), last_goal_(last_goal), late_(config.settle) {}

  /// Adds a completed step.
  void add(const ServoStep& step);
  /// Fills in these statistics in a result.
  void finish(ServoResult& result) const;

 private:
  void add_overshoot(const ServoStep& step);

  const Arm& arm_;
  double begun_, last_goal_;
  std::optional<double> settled_;
  LateErrors late_;
  // Position of the tip at the time of the last target, and its way to the target.
  std::optional<Eigen::Vector3d> tip_;
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero();
  double overshoot_ = 0;
};

}  // namespace flexura
