#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// Pixels [first, last) of a row that belong to the foreground.
struct Run {
  int v = 0, first = 0, last = 0;
  std::uint32_t component = 0;  ///< Index in Components::list, once these are known.
};

/// A connected component of foreground pixels, corners included.
struct Component {
  std::int64_t area = 0;                         ///< Area, px.
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Its box, inclusive.
  int on_border = 0;                             ///< Number of its pixels in the picture's outermost ring.
  std::uint32_t first_run = 0;                   ///< Index of its first run in Components::runs.
  std::uint32_t run_count = 0;                   ///< Number of its runs; they need not be consecutive.
};

/// The foreground of a picture as runs of pixels, joined to components (A. Rosenfeld, J. L. Pfaltz, 1966, by
/// union-find). After the first pictures it allocates no more.
struct Components {
  std::vector<Run> runs;        ///< Row by row from the top, left to right.
  std::vector<Component> list;  ///< Components in the order of their first run.

  /// Finds the pixels on the figure's side of the threshold, or of the local level of `blocks`.
  void find(const Image<std::uint8_t>& gray, const Threshold& threshold,
            const BlockThresholds* blocks = nullptr);

  /// Returns the run that contains a pixel; null in the background.
  [[nodiscard]] const Run* run_at(int u, int v) const;

 private:
  void join(int height);
  std::uint32_t root(std::uint32_t label);

  std::vector<std::uint32_t> row_start_;  // First run of each row; one more entry.
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> levels_;
};

/// Samples points over a component, px: on every `spacing`-th row every `spacing`-th pixel, and both ends of
/// each run. In parts at least as wide, no pixel is farther from a point than 1.5 times the spacing.
void strew(const Components& components, std::uint32_t component, int spacing,
           std::vector<Eigen::Vector2d>& places);

/// Computes threshold and components of a picture; no components if the threshold has a reason. `samples`: of
/// the histogram; all pixels are used if these find no figure.
[[nodiscard]] Threshold segment(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                Components& components, BlockThresholds& blocks,
                                std::size_t samples = 1U << 30U);

}  // namespace flexura
