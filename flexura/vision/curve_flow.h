#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// How far what is seen at places moves from one gray picture to the next of the same size, px, by the
/// pyramidal method of Lucas and Kanade (J.-Y. Bouguet, 2001; OpenCV's); none where it is not found again.
/// std::invalid_argument: pictures of different sizes, or not gray.
[[nodiscard]] std::vector<std::optional<Eigen::Vector2d>> flow_at(const Image<std::uint8_t>& before,
                                                                  const Image<std::uint8_t>& after,
                                                                  std::span<const Eigen::Vector2d> places);

/// Angles of a curve's tangent, integrated from their turns from picture to picture and drawn back to
/// measured angles, since what is integrated drifts.
class AngleIntegrator {
 public:
  /// Starts at measured angles, rad.
  explicit AngleIntegrator(std::vector<double> angles) : angles_(std::move(angles)) {}

  /// As they stand now, rad; not brought within a turn.
  [[nodiscard]] const std::vector<double>& angles() const { return angles_; }
  /// Adds turns, rad; those that are not numbers count as their neighbours'. std::invalid_argument: another
  /// number of them.
  void add(std::span<const double> turns);
  /// Moves the angles by `share` (0 to 1) of the way to measured ones, by the shorter way around; those that
  /// are not numbers leave theirs. Returns the root mean square of what they were off, rad: the drift.
  double anchor(std::span<const double> measured, double share = 1);

 private:
  std::vector<double> angles_;
};

}  // namespace flexura
