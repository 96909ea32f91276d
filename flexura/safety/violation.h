#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// Kinds of violations, with the unit of value and limit.
enum class Hazard : std::uint8_t {
  bend,          ///< A section bends more than allowed; rad.
  bend_rate,     ///< A section bends faster than allowed; rad/s.
  stretch,       ///< A section is longer or shorter than allowed; factor.
  stretch_rate,  ///< A section changes its length faster than allowed; 1/s.
  folding,       ///< The tube folds on the inner side of a bend: curvature times radius reaches 1; no unit.
  jump,          ///< The motion has two states at one time; the unit is rad for a bend, none for a stretch.
  not_finite,    ///< A value of the motion's formula is not finite, or a length is not above 0.
  self_contact,  ///< The arm touches itself; depth in m.
  obstacle,      ///< The arm touches an obstacle; depth in m.
  motor_speed,   ///< A motor turns faster than its limit; rad/s.
  step_rate,     ///< A motor's controller would have to exceed its largest microstep rate; 1/s.
  motor_acceleration,  ///< A motor accelerates or decelerates faster than its limit; rad/s^2.
  motor_position,      ///< A motor exceeds its position limit; microsteps.
  workspace,  ///< The tip's target is outside the workspace; distance from the nearest reachable pose in m.
};

/// A violation and its time span.
struct Violation {
  Hazard hazard = Hazard::bend;
  double start = 0;       ///< Start of the span, s.
  double end = 0;         ///< End of the span, s.
  double worst_time = 0;  ///< Time of `value`, s.
  /// Index of the section, 0 at the base; for a motor, the index of its tendon's section.
  std::optional<std::size_t> section = {};
  /// Index of the section that `section` touches; 0 at the base.
  std::optional<std::size_t> other_section = {};
  std::string name = {};  ///< Name of the obstacle, the motor's axis or the task.
  double value = 0;       ///< Worst value in the span, in the hazard's unit.
  double limit = 0;       ///< Limit, in the hazard's unit.
  bool is_of_stretch =
      false;  ///< Whether a jump is a jump of the stretch (a factor) instead of the bend (rad).
  std::optional<Eigen::Vector3d> target = {};  ///< Target that the tip does not reach, in W, m.

  /// Returns "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg". The times are formatted by span_text()
  /// (spans.h).
  [[nodiscard]] std::string text() const;
  /// Returns text() without the times.
  [[nodiscard]] std::string what() const;

 private:
  [[nodiscard]] std::string place() const;
  [[nodiscard]] std::string finding() const;
};

/// Result of the check of a motion.
struct SafetyReport {
  std::vector<Violation> violations;  ///< Violations, ordered by time, then by section.
  /// Reasons why the check may have missed a violation between two samples: "sampled every 0.02 s from ...".
  std::vector<std::string> caveats;
  std::vector<std::string> notes;  ///< Remarks that do not affect safety.
  bool is_complete = true;         ///< Whether the check was completed instead of cancelled.

  [[nodiscard]] bool is_safe() const { return violations.empty() && is_complete; }
  /// Sorts the violations.
  void sort();
};

/// Selects at most `most` informative violations and returns their ascending indices in `report.violations`.
/// The worst violation of each hazard has the highest priority, then the worst of each other obstacle, then
/// all others. Violations of sections have priority over violations of motors or tasks. Of violations with
/// equal worst times, only the first is selected.
[[nodiscard]] std::vector<std::size_t> most_relevant(const SafetyReport& report, std::size_t most);

/// Returns whether a hazard concerns a motor.
[[nodiscard]] bool is_of_motor(Hazard hazard);

/// Returns the text of an amount, converted from the hazard's unit to the unit of messages: "1.5 deg".
[[nodiscard]] std::string amount_text(Hazard hazard, double amount);

/// Returns the hazard's name in reports: "bend", "bend rate", ...
[[nodiscard]] const char* name_of(Hazard hazard);

}  // namespace flexura
