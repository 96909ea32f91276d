#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// Pixels [first, last) of a row that belong to the figure.
struct Run {
  int v = 0, first = 0, last = 0;
  std::uint32_t component = 0;  ///< Its place in Components::list, once these are known.
};

/// A figure's pixels that hang together, corners included.
struct Component {
  std::int64_t area = 0;                         ///< px
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Its box; the last two are in it.
  int on_border = 0;            ///< Of its pixels, how many lie in the picture's outermost ring.
  std::uint32_t first_run = 0;  ///< In Components::runs.
  std::uint32_t run_count = 0;  ///< How many of them are its own; they need not follow each other.
};

/// The figure of a picture, as runs of pixels joined to components (A. Rosenfeld, J. L. Pfaltz, 1966, by
/// union-find). Reused, it allocates no more.
struct Components {
  std::vector<Run> runs;        ///< Row by row from the top, left to right.
  std::vector<Component> list;  ///< In the order of their first run.

  /// Pixels on the figure's side of the threshold, with `blocks` of the level there.
  void find(const Image<std::uint8_t>& gray, const Threshold& threshold,
            const BlockThresholds* blocks = nullptr);

  /// The run that holds a pixel; null where the ground is.
  [[nodiscard]] const Run* run_at(int u, int v) const;

 private:
  void join(int height);
  std::uint32_t root(std::uint32_t label);

  std::vector<std::uint32_t> row_start_;  // Of each row, its first run; one more.
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> levels_;
};

/// Places strewn over a component, px: on every `spacing`-th row every `spacing`-th pixel, and both ends of
/// each run. What is as wide has no pixel farther from one of them than 1.5 of that.
void strew(const Components& components, std::uint32_t component, int spacing,
           std::vector<Eigen::Vector2d>& places);

/// Threshold and components of a picture; none where the threshold has a reason. `samples`: of the histogram;
/// all pixels count where so many find no figure.
[[nodiscard]] Threshold segment(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                Components& components, BlockThresholds& blocks,
                                std::size_t samples = 1U << 30U);

}  // namespace flexura
