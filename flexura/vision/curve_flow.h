#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// Returns the motion of the image at given positions from one gray picture to the next, px. Uses OpenCV's
/// pyramidal Lucas-Kanade method (J.-Y. Bouguet, 2001). Positions that are not found again have std::nullopt.
/// Throws std::invalid_argument for pictures of different sizes, or pictures that are not gray.
[[nodiscard]] std::vector<std::optional<Eigen::Vector2d>> flow_at(const Image<std::uint8_t>& before,
                                                                  const Image<std::uint8_t>& after,
                                                                  std::span<const Eigen::Vector2d> places);

/// Integrates the tangent angles of a curve from their changes between pictures. Measured angles can correct
/// the drift of the integration.
class AngleIntegrator {
 public:
  /// Starts with measured angles, rad.
  explicit AngleIntegrator(std::vector<double> angles) : angles_(std::move(angles)) {}

  /// Returns the current angles, rad. They are not wrapped to a range.
  [[nodiscard]] const std::vector<double>& angles() const { return angles_; }
  /// Adds the changes `turns` to the angles, rad. A change that is NaN is interpolated between its
  /// neighbours. Throws std::invalid_argument if the numbers of changes and angles differ.
  void add(std::span<const double> turns);
  /// Moves each angle towards its measured angle by the fraction `share` (0 to 1) of their difference,
  /// wrapped to at most half a turn. A measured angle that is NaN leaves its angle unchanged. Returns the
  /// drift: the root mean square of the differences, rad.
  double anchor(std::span<const double> measured, double share = 1);

 private:
  std::vector<double> angles_;
};

}  // namespace flexura
