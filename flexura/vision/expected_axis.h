#pragma once

#include <Eigen/Core>
#include <cstddef>
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

  /// Finds the longest stretch of the predicted centerline that should be completely visible: the arm is
  /// inside the picture of `width` x `height` px, and no other part of it is near. Finds chords of the
  /// figures on this stretch; the chord nearest to its middle comes first. There may be none.
  void seeds(const Components& components, int width, int height, std::vector<TubeSeed>& seeds);

  /// Returns whether a measured centerline is the predicted one: whether it is nowhere farther from it than
  /// the arm's width and 8 px, and at least 85 % as long as the stretch that seeds() has found.
  [[nodiscard]] bool agrees(std::span<const AxisSample> axis);

  /// Returns whether the stretch that seeds() has found contains the arm's base (0) or tip (1).
  [[nodiscard]] bool shows_end(std::size_t end) const {
    return first_ != last_ && (end == 0 ? first_ == 0 : last_ + 1 == points_.size());
  }

  /// Returns whether a measured centerline runs from tip to base.
  [[nodiscard]] bool is_reversed(std::span<const AxisSample> axis) const;

 private:
  [[nodiscard]] double from_base(const Eigen::Vector2d& pixel, double& distance) const;
  [[nodiscard]] Eigen::Vector2d tangent(std::size_t point) const;
  [[nodiscard]] bool is_beside_itself(std::size_t point, double width) const;
  [[nodiscard]] double usual_width(const Components& components);
  void find_stretch(double width, const Eigen::Vector2d& corner);

  std::vector<Eigen::Vector2d> points_;
  std::vector<double> lengths_;  // From the base to each point, px.
  std::vector<double> widths_;
  std::size_t first_ = 0, last_ = 0;  // Points at the ends of the visible stretch; equal if there is none.
};

}  // namespace flexura
