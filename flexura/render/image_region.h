#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "flexura/camera/intrinsics.h"

namespace flexura {

/// Where balls around the points of a segment are seen by a lens without distortion, and some pixels around:
/// what is within a radius of a segment of the image. Never too small.
class ImageRegion {
 public:
  /// From p to q, C, m; none when the camera is too near. With `beyond`, m, only what is no farther than that
  /// beyond the ends, along the segment.
  static std::optional<ImageRegion> of(const Intrinsics& lens, const Eigen::Vector3d& p,
                                       const Eigen::Vector3d& q, double radius,
                                       double beyond = std::numeric_limits<double>::infinity()) {
    constexpr double pixels_around = 2;
    const double nearest = std::min(p.z(), q.z());
    if (!(nearest > 1.5 * radius)) return std::nullopt;
    ImageRegion region;
    const Eigen::Vector2d a = p.head<2>() / p.z(), b = q.head<2>() / q.z();
    region.from_ = {lens.fx * a.x() + lens.cx, lens.fy * a.y() + lens.cy};
    region.to_ = {lens.fx * b.x() + lens.cx, lens.fy * b.y() + lens.cy};
    // A ball at the angle t from the axis is seen longer by 1 / cos^2 t.
    const double off_axis = 1 + std::max(a.squaredNorm(), b.squaredNorm());
    const double scale = std::max(lens.fx, lens.fy) / (nearest - radius) * off_axis;
    region.radius_ = scale * radius + pixels_around;
    region.is_cut_ = beyond < radius;
    region.beyond_ = scale * beyond + pixels_around;
    return region;
  }

  /// Rows and columns [begin, end) of a row within an image of `size` pixels.
  struct Range {
    int begin = 0, end = 0;
  };
  [[nodiscard]] Range rows(int size) const {
    return whole(std::min(from_.y(), to_.y()) - radius_, std::max(from_.y(), to_.y()) + radius_, size);
  }
  [[nodiscard]] Range columns(int v, int size) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto add = [&](double a, double b) { low = std::min(low, a), high = std::max(high, b); };
    for (const Eigen::Vector2d& end : {from_, to_}) {
      if (is_cut_) break;
      const double across = radius_ * radius_ - (v - end.y()) * (v - end.y());
      if (across >= 0) add(end.x() - std::sqrt(across), end.x() + std::sqrt(across));
    }
    const Eigen::Vector2d way = to_ - from_;
    const double length = way.norm();
    if (length > 0) {
      const Eigen::Vector2d d = way / length;
      const double up = v - from_.y();
      double a = -std::numeric_limits<double>::infinity(), b = -a;
      // 0 <= u d.x + up d.y <= length and |up d.x - u d.y| <= radius, with u counted from `from_`.
      const double more = is_cut_ ? beyond_ : 0;
      cut(d.x(), up * d.y(), -more, length + more, a, b);
      cut(-d.y(), up * d.x(), -radius_, radius_, a, b);
      if (a <= b) add(from_.x() + a, from_.x() + b);
    }
    return low <= high ? whole(low, high, size) : Range{};
  }

 private:
  static Range whole(double low, double high, int size) {
    const double limit = size;
    return {static_cast<int>(std::clamp(std::floor(low), 0.0, limit)),
            static_cast<int>(std::clamp(std::ceil(high) + 1, 0.0, limit))};
  }
  // Keeps the u in [a, b] with low <= slope u + value <= high.
  static void cut(double slope, double value, double low, double high, double& a, double& b) {
    if (slope == 0) {
      if (value < low || value > high) b = -std::numeric_limits<double>::infinity();
      return;
    }
    const double one = (low - value) / slope, other = (high - value) / slope;
    a = std::max(a, std::min(one, other)), b = std::min(b, std::max(one, other));
  }

  Eigen::Vector2d from_, to_;
  double radius_ = 0, beyond_ = 0;
  bool is_cut_ = false;
};

}  // namespace flexura
