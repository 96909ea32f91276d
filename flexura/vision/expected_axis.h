#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/tube_seeds.h"

namespace flexura {

/// The predicted centerline of an arm in a picture, and how a measured centerline agrees with it. After the
/// first pictures it allocates no more memory.
class ExpectedAxis {
 public:
  /// Sets the prediction: points from base to tip, px. `origin` is subtracted from them. Points that are not
  /// finite or far outside any picture are omitted.
  void set(std::span<const Eigen::Vector2d> pixels, const Eigen::Vector2d& origin);
  [[nodiscard]] bool is_empty() const { return points_.size() < 2; }

  /// Finds chords of the figures on the predicted centerline where no other part of it is near; the chord
  /// nearest to the middle of the centerline comes first. There may be none.
  void seeds(const Components& components, std::vector<TubeSeed>& seeds);

  /// Returns whether a measured centerline is the predicted one: whether it is nowhere farther from it than
  /// the arm's width and 8 px, and long enough. Parts of the prediction that are outside the picture of
  /// `width` x `height` px, or near another part, may be missing.
  [[nodiscard]] bool agrees(std::span<const AxisSample> axis, int width, int height);

  /// Returns whether a measured centerline runs from tip to base.
  [[nodiscard]] bool is_reversed(std::span<const AxisSample> axis) const;

 private:
  [[nodiscard]] double from_base(const Eigen::Vector2d& pixel, double& distance) const;
  [[nodiscard]] bool is_beside_itself(std::size_t point, double width) const;

  std::vector<Eigen::Vector2d> points_;
  std::vector<double> lengths_;  // From the base to each point, px.
  std::vector<double> widths_;
};

}  // namespace flexura
