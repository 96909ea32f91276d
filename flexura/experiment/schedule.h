#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// One task, placed in time.
struct Leg {
  std::string name;         ///< The task's; its kind where it has none (task_name).
  std::string kind;         ///< "move", ...
  double start = 0;         ///< s
  MotionPtr motion;         ///< Never null; its times count from `start`.
  bool is_steered = false;  ///< By sight: a limiter decides on the way what is sent.
  bool is_foreseen = true;  ///< What it does is known; a servo's way is only once it has been done.

  [[nodiscard]] double end() const { return start + motion->duration(); }  ///< s
};

/// What an experiment is going to do: the arm's state at every time, known before anything moves.
class Schedule {
 public:
  /// `performed` has what tasks did whose motion is decided on the way or followed before (calibrations,
  /// servos, dynamics), by their numbers; those that are left out are taken to do everything that they may.
  explicit Schedule(const Experiment& experiment, const std::map<std::size_t, MotionPtr>& performed = {});

  /// At least one: without tasks, a hold of no duration.
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// Steps of the clock after time 0; the last one is at duration(), the others at whole steps before it.
  [[nodiscard]] std::size_t steps() const { return steps_; }
  [[nodiscard]] double time_of_step(std::size_t step) const;  ///< s
  /// The leg under way at `time`; a leg owns its start, the last one its end too.
  [[nodiscard]] std::size_t leg_at(double time) const;
  /// The state in which the arm starts.
  [[nodiscard]] const ArmState& initial() const { return initial_; }
  /// The arm's state at `time` in [0, duration()] s.
  [[nodiscard]] ArmState state_at(double time) const;
  /// Bounds on how fast each section changes in [start, end] s; empty where a leg knows none.
  [[nodiscard]] std::optional<std::vector<SectionRates>> rates(double start, double end) const;
  /// What would harm the arm or be too much for its motors, and targets out of reach; known before anything
  /// moves. `progress` may be null, and may end the check early.
  [[nodiscard]] SafetyReport check(Progress* progress = nullptr) const;

 private:
  void add(const TaskConfig& task, const MotionPtr& motion);
  void add_servo(const ServoTask& servo, const ArmState& from, const MotionPtr& known);
  void add_missed(double missed, const std::optional<Eigen::Vector3d>& target);

  ArmModel model_;
  std::optional<Drive> drive_;
  ArmState initial_;
  std::vector<Obstacle> obstacles_;
  std::vector<Violation> missed_targets_;
  double step_ = 0;
  double duration_ = 0;
  std::size_t steps_ = 0;
  std::vector<Leg> legs_;
};

}  // namespace flexura
