#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Returns red, green and blue (0 to 255) at a subpixel position, px, by bilinear interpolation. For a gray
/// picture, returns the gray value three times.
[[nodiscard]] Eigen::Vector3d color_at(const Image<std::uint8_t>& picture, const Eigen::Vector2d& pixel);

/// Returns the median of each channel. `colors` must not be empty.
[[nodiscard]] Eigen::Vector3d median_color(const std::vector<Eigen::Vector3d>& colors);

/// A range [first, last) of samples on a line along the arm.
struct Stretch {
  std::size_t first, last;
};
/// Returns the ranges of samples whose colour differs by more than `bound` from `own`, the colour of the arm.
[[nodiscard]] std::vector<Stretch> stretches(const std::vector<Eigen::Vector3d>& colors,
                                             const Eigen::Vector3d& own, double bound);

/// The arm's visible surface: positions and colours on lines along the centerline, sampled one pixel apart.
struct ArmSkin {
  /// Distances of the lines from the centerline, in half widths of the arm.
  static constexpr std::array<double, 7> lines = {-0.72, -0.5, -0.25, 0, 0.25, 0.5, 0.72};
  static constexpr std::size_t middle_line = 3;

  std::vector<Eigen::Vector2d> axis, normals;
  std::vector<double> half_widths;
  std::vector<bool> is_seen;  ///< Whether both borders are visible at the sample; otherwise the centerline is
                              ///< extrapolated there.
  std::array<std::vector<Eigen::Vector3d>, lines.size()> colors;

  ArmSkin(const Image<std::uint8_t>& picture, const ArmObservation& arm);

  [[nodiscard]] std::size_t size() const { return axis.size(); }
  /// Returns a point of the centerline, px. `along`: index of a sample; values between integers are
  /// interpolated.
  [[nodiscard]] Eigen::Vector2d at(double along) const;
};

}  // namespace flexura
