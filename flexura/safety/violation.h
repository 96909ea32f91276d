#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// What a motion can break.
enum class Hazard : std::uint8_t {
  bend,                ///< A section bends more than it may; rad.
  bend_rate,           ///< A section bends faster than it may; rad/s.
  stretch,             ///< A section is longer or shorter than it may be; factor.
  stretch_rate,        ///< A section changes its length faster than it may; 1/s.
  folding,             ///< The inner side of the tube folds: curvature times radius reaches 1.
  jump,                ///< The law asks for two states at one time; rad (or a factor).
  not_finite,          ///< The law's formula has no finite value, or no length above 0.
  self_contact,        ///< The arm touches itself; m of depth.
  obstacle,            ///< The arm touches an obstacle; m of depth.
  motor_speed,         ///< A motor turns faster than it can; rad/s.
  step_rate,           ///< Its controller gives more microsteps a second than it can; 1/s.
  motor_acceleration,  ///< A motor speeds up or slows down faster than it can; rad/s^2.
  motor_position,      ///< A motor goes farther than it may; microsteps.
  workspace,           ///< The tip's target is out of the arm's reach; m from the nearest place.
};

/// Something a motion would break, and when.
struct Violation {
  Hazard hazard = Hazard::bend;
  double start = 0;                               ///< s
  double end = 0;                                 ///< s
  double worst_time = 0;                          ///< When `value` is found, s.
  std::optional<std::size_t> section = {};        ///< From 0; of a motor, the one whose tendon it pulls.
  std::optional<std::size_t> other_section = {};  ///< From 0; which `section` touches.
  std::string name = {};                          ///< Of the obstacle, the motor's axis or the task.
  double value = 0;                               ///< The worst in that time, in the hazard's unit.
  double limit = 0;                               ///< What the value may be, in the hazard's unit.
  bool is_of_stretch = false;                  ///< A jump of the stretch (a factor), not of the bend (rad).
  std::optional<Eigen::Vector3d> target = {};  ///< The place that the tip misses, world, m.

  /// "0.5 s to 2 s: section 1: bend 62 deg, limit 60 deg"; the times as span_text (spans.h) writes them.
  [[nodiscard]] std::string text() const;
  /// The same without its times.
  [[nodiscard]] std::string what() const;

 private:
  [[nodiscard]] std::string place() const;
  [[nodiscard]] std::string finding() const;
};

/// What the check of a motion found.
struct SafetyReport {
  std::vector<Violation> violations;  ///< By time, then section.
  /// Why the check of some time may have missed what happens between two steps: "sampled every 0.02 s from
  /// ...".
  std::vector<std::string> caveats;
  std::vector<std::string> notes;  ///< Worth knowing, and no reason to refuse.
  bool is_complete = true;         ///< False: the check was cancelled.

  [[nodiscard]] bool is_safe() const { return violations.empty() && is_complete; }
  /// Puts the violations in their order.
  void sort();
};

/// Which violations tell most when no more than `most` can be shown: the worst of every hazard, then that of
/// every other obstacle, then the rest; those of a section before those of a motor or a task. Places in
/// `report.violations`, ascending; of several with one worst time only the first is told.
[[nodiscard]] std::vector<std::size_t> most_telling(const SafetyReport& report, std::size_t most);

/// Whether the hazard is a motor's.
[[nodiscard]] bool is_of_motor(Hazard hazard);

/// "1.5 deg": an amount in the unit that texts show for the hazard.
[[nodiscard]] std::string amount_text(Hazard hazard, double amount);

/// The hazard's name in reports: "bend", "bend rate", ...
[[nodiscard]] const char* name_of(Hazard hazard);

}  // namespace flexura
