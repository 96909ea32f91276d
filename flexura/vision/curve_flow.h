#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// Returns the motion of the image at these positions from one gray picture to the next, px. Uses the
/// pyramidal method of Lucas and Kanade (J.-Y. Bouguet, 2001; OpenCV's). Empty where a position is not found
/// again. Throws std::invalid_argument for pictures of different sizes, or not gray.
[[nodiscard]] std::vector<std::optional<Eigen::Vector2d>> flow_at(const Image<std::uint8_t>& before,
                                                                  const Image<std::uint8_t>& after,
                                                                  std::span<const Eigen::Vector2d> places);

/// Integrates a curve's tangent angles from their changes between pictures. Measured angles correct the drift
/// of the integration.
class AngleIntegrator {
 public:
  /// Starts at measured angles, rad.
  explicit AngleIntegrator(std::vector<double> angles) : angles_(std::move(angles)) {}

  /// Returns the present angles, rad, not wrapped.
  [[nodiscard]] const std::vector<double>& angles() const { return angles_; }
  /// Adds changes, rad; NaN is replaced by the value of the neighbours. Throws std::invalid_argument for
  /// another number of them.
  void add(std::span<const double> turns);
  /// Moves the angles by `share` (0 to 1) towards measured ones, the shorter way around; NaN leaves an angle
  /// unchanged. Returns the root mean square of the differences, rad: the drift.
  double anchor(std::span<const double> measured, double share = 1);

 private:
  std::vector<double> angles_;
};

}  // namespace flexura
