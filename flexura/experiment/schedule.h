#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/model/arm.h"

namespace flexura {

/// One task, placed in time: the arm goes linearly from one state to another.
struct Leg {
  std::string name;
  std::string kind;
  double start = 0;     ///< s
  double duration = 0;  ///< s
  ArmState from;
  ArmState to;
};

/// A limit of the arm that a leg breaks.
struct Violation {
  double start = 0;  ///< s, from when
  double end = 0;    ///< s, to when
  std::size_t section = 0;
  std::string what;  ///< "bend", "bend rate", "stretch"
  double value = 0;  ///< The worst: rad, rad/s or a factor.
  double limit = 0;
  [[nodiscard]] std::string text() const;
};

/// What an experiment is going to do: the arm's state at every time, known before anything moves.
class Schedule {
 public:
  explicit Schedule(const Experiment& experiment);

  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// Steps of the clock after time 0; the last one is at duration(), the others at whole steps before it.
  [[nodiscard]] std::size_t steps() const { return steps_; }
  [[nodiscard]] double time_of_step(std::size_t step) const;  ///< s
  /// The leg under way at `time`; a leg owns its start, the last one its end too.
  [[nodiscard]] std::size_t leg_at(double time) const;
  /// The arm's state at `time` in [0, duration()] s.
  [[nodiscard]] ArmState state_at(double time) const;
  /// Every limit broken, by leg and section. Exact: along a leg bends and stretches change linearly, so their
  /// sizes are largest at an end and their rates are constant.
  [[nodiscard]] std::vector<Violation> violations(const Arm& arm) const;

 private:
  double step_ = 0;
  double duration_ = 0;
  std::size_t steps_ = 0;
  std::vector<Leg> legs_;
};

}  // namespace flexura
