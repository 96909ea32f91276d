#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_error.h"
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
  ArmState desired_;                  // Of the sight before.
  double limited_for_ = 0;            // s, of late
  std::string limited_by_;
  bool is_singular_ = false;
};

/// How fast and how well steps come to their goal, counted as they are made: it keeps the last `settle` s of
/// errors, however long the servo goes on.
class ServoTally {
 public:
  /// `begun`: the session's start; `last_goal`: when the last goal is wanted, s from there. `arm` outlives
  /// it.
  ServoTally(const Arm& arm, const ServoConfig& config, double begun, double last_goal)
      : arm_(arm), begun_(begun), last_goal_(last_goal), late_(config.settle) {}

  /// A step that was made.
  void add(const ServoStep& step);
  /// Fills in what a result says of them.
  void finish(ServoResult& result) const;

 private:
  void add_overshoot(const ServoStep& step);

  const Arm& arm_;
  double begun_, last_goal_;
  std::optional<double> settled_;
  LateErrors late_;
  // From where the tip started, once the last goal was wanted, and its way to there.
  std::optional<Eigen::Vector3d> tip_;
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero();
  double overshoot_ = 0;
};

}  // namespace flexura
