#include "flexura/vision/axis_cover.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

// Side of a cell, px. A place on a border is at most 1.5 sqrt(2) px from the border's point of its sample, so
// this point is in the place's cell or in a neighbouring one.
constexpr double side = 2.5;

}  // namespace

void AxisCover::set(const std::vector<AxisSample>& axis) {
  axis_ = axis;
  columns_ = rows_ = 0;
  if (axis_.empty()) return;
  Eigen::Vector2d low = axis_.front().pixel, high = low;
  for (const AxisSample& sample : axis_) {
    const Eigen::Vector2d half = (0.5 * sample.width * sample.normal).cwiseAbs();
    low = low.cwiseMin(sample.pixel - half), high = high.cwiseMax(sample.pixel + half);
  }
  corner_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / side) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / side) + 1;
  // The entries are sorted by counting.
  starts_.assign(cell_of(0, rows_) + 1, 0);
  cells_.clear();
  for (const AxisSample& sample : axis_) {
    for (const double sign : {-0.5, 0.5}) {
      const Eigen::Vector2d at = (sample.pixel + sign * sample.width * sample.normal - corner_) / side;
      const int column = std::clamp(static_cast<int>(at.x()), 0, columns_ - 1),
                row = std::clamp(static_cast<int>(at.y()), 0, rows_ - 1);
      const std::size_t cell = cell_of(column, row);
      cells_.push_back(static_cast<std::uint32_t>(cell));
      ++starts_[cell + 1];
    }
  }
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  next_ = starts_;
  samples_.resize(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i)
    samples_[next_[cells_[i]]++] = static_cast<std::uint32_t>(i / 2);
}

bool AxisCover::is_border(const Eigen::Vector2d& place, double close) const {
  const Eigen::Vector2d at = (place - corner_) / side;
  const bool is_near = at.x() > -1 && at.y() > -1 && at.x() < columns_ + 1 && at.y() < rows_ + 1;
  if (!is_near) return false;
  const auto column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, rows_ - 1); ++j) {
    const int first = std::max(column - 1, 0), last = std::min(column + 1, columns_ - 1);
    if (first > last) continue;
    for (std::uint32_t k = starts_[cell_of(first, j)]; k < starts_[cell_of(last, j) + 1]; ++k) {
      const AxisSample& sample = axis_[samples_[k]];
      const Eigen::Vector2d off = place - sample.pixel;
      const double across = std::abs(off.dot(sample.normal));
      if (std::abs(across - 0.5 * sample.width) < close &&
          off.squaredNorm() < across * across + along * along)
        return true;
    }
  }
  return false;
}

bool AxisCover::has_chord(const Eigen::Vector2d& middle, const Eigen::Vector2d& normal) const {
  constexpr double parallel = 0.95;  // Cosine of 18 degrees.
  return std::ranges::any_of(axis_, [&](const AxisSample& sample) {
    const double near = 0.25 * sample.width;
    return sample.is_seen && (middle - sample.pixel).squaredNorm() < near * near &&
           std::abs(normal.dot(sample.normal)) > parallel;
  });
}

}  // namespace flexura
