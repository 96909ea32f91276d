#include "flexura/servo/servo_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {

std::array<double, 51> shape_distances(const Backbone& shape, const Backbone& desired) {
  std::array<double, 51> distances{};
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(distances.size() - 1);
    distances[i] =
        (shape.pose(share * shape.length()).position - desired.pose(share * desired.length()).position)
            .norm();
  }
  return distances;
}

ServoError servo_error(const Backbone& shape, const Backbone& desired, double length) {
  const auto distances = shape_distances(shape, desired);
  double squares = 0, most = 0;
  for (const double off : distances) {
    squares += off * off / static_cast<double>(distances.size());
    most = std::max(most, off);
  }
  return {std::sqrt(squares) / length, most / length, distances.back() / length};
}

ServoError servo_error(const Arm& arm, const ArmState& shape, const ArmState& desired) {
  return servo_error(Backbone(arm, shape), Backbone(arm, desired), arm.length());
}

void LateErrors::add(double time, const ServoError& error) {
  errors_.push_back({time, error});
  while (errors_.front().time < time - span_) errors_.pop_front();
}

std::optional<ServoError> LateErrors::mean() const {
  if (errors_.empty()) return std::nullopt;
  const auto count = static_cast<double>(errors_.size());
  ServoError sum;
  for (const auto& [time, error] : errors_)
    sum.rms += error.rms, sum.most += error.most, sum.tip += error.tip;
  return ServoError{sum.rms / count, sum.most / count, sum.tip / count};
}

}  // namespace flexura
