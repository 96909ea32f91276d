#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// Kinds of violations of a motion.
enum class Hazard : std::uint8_t {
  bend,                ///< A section bends more than allowed; rad.
  bend_rate,           ///< A section bends faster than allowed; rad/s.
  stretch,             ///< A section is longer or shorter than allowed; factor.
  stretch_rate,        ///< A section changes its length faster than allowed; 1/s.
  folding,             ///< The inner side of the tube folds: curvature times radius reaches 1.
  jump,                ///< The motion has two states at one time; rad (stretch: factor).
  not_finite,          ///< The law's formula has no finite value, or no length above 0.
  self_contact,        ///< The arm touches itself; m of depth.
  obstacle,            ///< The arm touches an obstacle; m of depth.
  motor_speed,         ///< A motor turns faster than its limit; rad/s.
  step_rate,           ///< Its controller gives more microsteps per second than its limit; 1/s.
  motor_acceleration,  ///< A motor accelerates or decelerates faster than its limit; rad/s^2.
  motor_position,      ///< A motor exceeds its position limit; microsteps.
  workspace,           ///< The tip's target is outside the workspace; m from the nearest pose.
};

/// A violation and its time span.
struct Violation {
  Hazard hazard = Hazard::bend;
  double start = 0;                               ///< In s.
  double end = 0;                                 ///< In s.
  double worst_time = 0;                          ///< Time of `value`, s.
  std::optional<std::size_t> section = {};        ///< From 0; for a motor, the section of its tendon.
  std::optional<std::size_t> other_section = {};  ///< From 0; the section that `section` touches.
  std::string name = {};                          ///< Name of the obstacle, the motor's axis or the task.
  double value = 0;                               ///< Worst value in the span, in the hazard's unit.
  double limit = 0;                               ///< Limit, in the hazard's unit.
  bool is_of_stretch = false;                  ///< A jump of the stretch (a factor), not of the bend (rad).
  std::optional<Eigen::Vector3d> target = {};  ///< Position that the tip does not reach, world, m.

  /// Returns "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg". Times are as in span_text (spans.h).
  [[nodiscard]] std::string text() const;
  /// Returns the text without the times.
  [[nodiscard]] std::string what() const;

 private:
  [[nodiscard]] std::string place() const;
  [[nodiscard]] std::string finding() const;
};

/// Result of the check of a motion.
struct SafetyReport {
  std::vector<Violation> violations;  ///< By time, then section.
  /// Reasons why the check may have missed something between two steps: "sampled every 0.02 s from ...".
  std::vector<std::string> caveats;
  std::vector<std::string> notes;  ///< Remarks that are not violations.
  bool is_complete = true;         ///< False if the check was cancelled.

  [[nodiscard]] bool is_safe() const { return violations.empty() && is_complete; }
  /// Sorts the violations.
  void sort();
};

/// Returns the most informative violations, at most `most`: the worst of every hazard, then that of every
/// other obstacle, then the rest. Those of a section come before those of a motor or a task. The result has
/// indices in `report.violations`, ascending. Of several with the same worst time only the first is included.
[[nodiscard]] std::vector<std::size_t> most_relevant(const SafetyReport& report, std::size_t most);

/// Returns true if the hazard is a motor's.
[[nodiscard]] bool is_of_motor(Hazard hazard);

/// Returns an amount in the unit of the hazard's texts: "1.5 deg".
[[nodiscard]] std::string amount_text(Hazard hazard, double amount);

/// Returns the hazard's name in reports: "bend", "bend rate", ...
[[nodiscard]] const char* name_of(Hazard hazard);

}  // namespace flexura
