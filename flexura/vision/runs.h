#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// A run of foreground pixels: columns [first, last) of row v.
struct Run {
  int v = 0, first = 0, last = 0;
  std::uint32_t component = 0;  ///< Index in Components::list, after the components are computed.
};

/// A connected component of foreground pixels, with 8-connectivity.
struct Component {
  std::int64_t area = 0;                         ///< Area, px.
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Bounding box, last column and row included.
  int on_border = 0;                             ///< Number of pixels in the picture's outermost ring.
  std::uint32_t first_run = 0;                   ///< Index of the first run in Components::runs.
  std::uint32_t run_count = 0;                   ///< Number of runs, which need not be consecutive.
};

/// The foreground of a picture as runs of pixels, and their connected components (A. Rosenfeld, J. L. Pfaltz,
/// 1966, with union-find). After the first pictures it allocates no more memory.
struct Components {
  std::vector<Run> runs;        ///< Runs, row by row from the top, left to right.
  std::vector<Component> list;  ///< Components, in the order of their first runs.

  /// Finds runs and components of the foreground pixels. The foreground is separated by `threshold` or, with
  /// `blocks`, by local thresholds. Pixels at which `inside` is 0 are background.
  void find(const Image<std::uint8_t>& gray, const Threshold& threshold,
            const BlockThresholds* blocks = nullptr, const Image<std::uint8_t>* inside = nullptr);

  /// Returns the run that contains a pixel; null for a background pixel.
  [[nodiscard]] const Run* run_at(int u, int v) const;

 private:
  void keep_inside(const Image<std::uint8_t>& inside);
  void join(int height);
  std::uint32_t root(std::uint32_t label);

  std::vector<std::uint32_t> row_start_;  // Index of the first run of each row, and the number of runs.
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> levels_;
};

/// Appends sample points of a component, px: every Nth pixel in every Nth row, with N = `spacing`, and both
/// ends of the runs in these rows. In parts of the component that are at least `spacing` wide, each pixel has
/// a sample point within 1.5 times the spacing.
void strew(const Components& components, std::uint32_t component, int spacing,
           std::vector<Eigen::Vector2d>& places);

/// Computes the threshold and the components of a picture. There are no components if the threshold separates
/// no foreground. `samples` limits the number of pixels in the histogram. If no figure is found with them,
/// all pixels are used. Pixels at which `inside` is 0 belong to no component.
[[nodiscard]] Threshold segment(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                Components& components, BlockThresholds& blocks,
                                std::size_t samples = 1U << 30U, const Image<std::uint8_t>* inside = nullptr);

}  // namespace flexura
