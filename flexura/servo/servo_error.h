#pragma once

#include <array>
#include <deque>
#include <optional>

#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Distances between the points of two shapes at equal shares of their lengths, evenly from base to tip, m.
[[nodiscard]] std::array<double, 51> shape_distances(const Backbone& shape, const Backbone& desired);

/// How far a shape is from another one: shape_distances(), as shares of the arm's length.
struct ServoError {
  double rms = 0, most = 0, tip = 0;  ///< Root mean square; the largest; at the tip.
};
/// `length`: the arm's, m.
[[nodiscard]] ServoError servo_error(const Backbone& shape, const Backbone& desired, double length);
[[nodiscard]] ServoError servo_error(const Arm& arm, const ArmState& shape, const ArmState& desired);

/// The errors of the last while.
class LateErrors {
 public:
  /// `span`: those that are older than the newest one by more than that are forgotten, s.
  explicit LateErrors(double span) : span_(span) {}

  /// `time`: no earlier than of the one before, s.
  void add(double time, const ServoError& error);
  /// None before the first one.
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
