#pragma once

#include <array>
#include <deque>
#include <optional>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the distances between corresponding points of two shapes, at equal shares of their lengths from
/// base to tip, m.
[[nodiscard]] std::array<double, 51> shape_distances(const Backbone& shape, const Backbone& desired);

/// Distance of a shape from another one, by shape_distances(), as shares of the arm's length.
struct ServoError {
  double rms = 0, most = 0, tip = 0;  ///< Root mean square along the arm, maximum, and distance at the tip.
};
/// Returns the distance of `shape` from `desired`. `length`: of the arm, m.
[[nodiscard]] ServoError servo_error(const Backbone& shape, const Backbone& desired, double length);
[[nodiscard]] ServoError servo_error(const Arm& arm, const ArmState& shape, const ArmState& desired);

/// Errors of the recent past, for their mean.
class LateErrors {
 public:
  /// Drops errors that are older than the newest one by more than `span`, s.
  explicit LateErrors(double span) : span_(span) {}

  /// Adds an error. `time`: s, at least that of the previous error.
  void add(double time, const ServoError& error);
  /// Returns the mean of the kept errors, or std::nullopt before the first error.
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
