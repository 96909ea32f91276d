#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// Settings of a DisturbanceWatch.
struct DisturbanceConfig {
  double limit = 0.05;  ///< Deviation that counts as a disturbance, share of the arm's length; > 0.
  /// Additional deviation allowed for errors of the model, as a share of the predicted motion.
  double model_error = 0.35;
  double grace = 0.3;  ///< Time from the first observation until the detection begins, s.
  double window =
      0.5;  ///< Time between the newest observation and the earlier one with which it is compared, s; > 0.
  /// Number of successive observations needed to detect the beginning or the end of a disturbance.
  int patience = 3;
};

/// Detects that an arm does not follow its drives: something pushes or holds it, a tendon breaks, or a motor
/// loses steps (docs/servo.md, "Disturbances").
///
/// The model predicts the change of the arm's shape at rest from the motion of the drives. The deviation is
/// the distance of the observed shape from this prediction: root mean square along the arm, share of its
/// length. A constant error of the model, for example an unknown payload, causes no deviation.
class DisturbanceWatch {
 public:
  /// Throws std::invalid_argument for numbers out of range.
  explicit DisturbanceWatch(ArmModel model, const DisturbanceConfig& config = {});

  /// Adds an observation of the arm. `time`: s, later than the previous one. `rest`: estimated shape without
  /// oscillation. `command`: position of the drives at this time. `sigma`: standard deviation of the shape,
  /// share of the length. Ignores shapes that are not finite, and commands without an equilibrium.
  void add(double time, const ArmState& rest, const ArmState& command, double sigma);

  /// Returns true from the detection of a disturbance until its end.
  [[nodiscard]] bool is_disturbed() const { return is_disturbed_; }
  /// Returns the deviation of the last observation, share of the arm's length.
  [[nodiscard]] double deviation() const { return deviation_; }
  /// Returns how long the current disturbance has lasted, s; 0 without a disturbance.
  [[nodiscard]] double lasts() const { return is_disturbed_ ? last_.time - since_ : 0; }
  /// Describes the last deviation: its size and its possible cause. Names a tendon if the release of this
  /// tendon explains most of the deviation. Such a tendon is broken or slack, or its motor lost steps.
  [[nodiscard]] std::string what() const;
  /// Names the tendon whose release explains most of the deviation since the first observation, or returns ""
  /// if there is no such tendon. This function detects a tendon that breaks under a small tension, which
  /// causes no sudden deviation.
  [[nodiscard]] std::string slow_cause() const;

 private:
  struct Sample {
    double time = 0;
    ArmState rest, command, nominal;  // Observed shape, drives, and the model's shape for them.
  };
  [[nodiscard]] const Sample& reference() const { return is_disturbed_ ? before_ : samples_.front(); }
  // Returns the shape that the model predicts for the last observation, from an earlier one.
  [[nodiscard]] ArmState predicted(const Sample& from) const;
  // Returns the index of the tendon whose release explains most of the deviation from this shape, if there is
  // one.
  [[nodiscard]] std::optional<std::size_t> released_tendon(const ArmState& expected) const;

  ArmModel model_;
  DisturbanceConfig config_;
  std::deque<Sample> samples_;    // Of the window, oldest first.
  Sample first_, before_, last_;  // The first, the last before the disturbance, and the newest.
  bool is_disturbed_ = false;
  double deviation_ = 0, since_ = 0, begun_ = 0;
  int in_a_row_ = 0;  // Successive observations that contradict is_disturbed_.
};

}  // namespace flexura
