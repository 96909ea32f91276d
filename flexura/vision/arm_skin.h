#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Returns red, green, blue (0 to 255) at a subpixel position by bilinear interpolation; for a gray picture
/// its value three times.
[[nodiscard]] Eigen::Vector3d color_at(const Image<std::uint8_t>& picture, const Eigen::Vector2d& pixel);

/// Returns the median of each channel. `colors` must not be empty.
[[nodiscard]] Eigen::Vector3d median_color(const std::vector<Eigen::Vector3d>& colors);

/// Samples [first, last) of a line along the arm.
struct Stretch {
  std::size_t first, last;
};
/// Returns the stretches whose colour is more than `bound` away from the arm's `own`.
[[nodiscard]] std::vector<Stretch> stretches(const std::vector<Eigen::Vector3d>& colors,
                                             const Eigen::Vector3d& own, double bound);

/// The arm's skin unrolled: positions and colours along its axis and beside it, a pixel apart.
struct ArmSkin {
  /// Lines along the arm, in half widths from its axis.
  static constexpr std::array<double, 7> lines = {-0.72, -0.5, -0.25, 0, 0.25, 0.5, 0.72};
  static constexpr std::size_t middle_line = 3;

  std::vector<Eigen::Vector2d> axis, normals;
  std::vector<double> half_widths;
  std::vector<bool> is_seen;  ///< Whether both borders are visible; otherwise the axis is extrapolated here.
  std::array<std::vector<Eigen::Vector3d>, lines.size()> colors;

  ArmSkin(const Image<std::uint8_t>& picture, const ArmObservation& arm);

  [[nodiscard]] std::size_t size() const { return axis.size(); }
  /// Returns the axis point at the sample position `along`.
  [[nodiscard]] Eigen::Vector2d at(double along) const;
};

}  // namespace flexura
