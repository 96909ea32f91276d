#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/vision/arm_finder.h"

namespace flexura {

/// The two borders of a measured tube, for questions about places: grids of cells hold the samples whose
/// borders are there. After the first pictures it allocates no more memory.
class AxisCover {
 public:
  /// Distance between the borders' points and a place along the axis, px.
  static constexpr double along = 1.5;

  /// Sets the tube.
  void set(const std::vector<AxisSample>& axis);

  /// Returns whether a place is on a border of the tube: whether there is a sample so that the place is less
  /// than `close` from half the width across the axis, and less than `along` from the sample along it, px.
  /// `close` is at most 1.5 px.
  [[nodiscard]] bool is_border(const Eigen::Vector2d& place, double close) const;

  /// Returns whether a chord with this middle and unit normal crosses the tube as its samples do.
  [[nodiscard]] bool has_chord(const Eigen::Vector2d& middle, const Eigen::Vector2d& normal) const;

 private:
  [[nodiscard]] std::size_t cell_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  std::vector<AxisSample> axis_;
  Eigen::Vector2d corner_ = {0, 0};  // Of the first cell, px.
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> starts_;  // First entry of each cell in samples_, and the number of entries.
  std::vector<std::uint32_t> samples_, cells_, next_;
};

}  // namespace flexura
