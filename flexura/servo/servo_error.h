#pragma once

#include <array>
#include <deque>
#include <optional>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the distances between corresponding points of two shapes, m. Corresponding points are at equal
/// shares of the shapes' lengths, from base to tip.
[[nodiscard]] std::array<double, 51> shape_distances(const Backbone& shape, const Backbone& desired);

/// Distance between two shapes by shape_distances(), as shares of the arm's length.
struct ServoError {
  double rms = 0, most = 0, tip = 0;  ///< Root mean square along the arm, maximum, and distance at the tip.
};
/// Returns the distance of `shape` from `desired`. `length`: of the arm, m.
[[nodiscard]] ServoError servo_error(const Backbone& shape, const Backbone& desired, double length);
[[nodiscard]] ServoError servo_error(const Arm& arm, const ArmState& shape, const ArmState& desired);

/// Mean of recent errors.
class LateErrors {
 public:
  /// The mean includes the errors of the last `span` s before the newest one.
  explicit LateErrors(double span) : span_(span) {}

  /// Adds an error. `time`, s, must not be before the time of the previous error.
  void add(double time, const ServoError& error);
  /// Returns the mean of the recent errors; std::nullopt before the first error.
  [[nodiscard]] std::optional<ServoError> mean() const;

 private:
  struct Timed {
    double time = 0;
    ServoError error;
  };
  double span_;
  std::deque<Timed> errors_;
};

}  // namespace flexura
