#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "flexura/camera/intrinsics.h"

namespace flexura {

/// A range [begin, end) of rows or columns.
struct PixelRange {
  int begin = 0, end = 0;

  /// Returns the integers in [low, high] that are between 0 and size - 1.
  static PixelRange around(double low, double high, int size) {
    const double limit = size;
    const int begin = static_cast<int>(std::clamp(std::ceil(low), 0.0, limit));
    return {begin, std::max(begin, static_cast<int>(std::clamp(std::floor(high) + 1, 0.0, limit)))};
  }
};

/// A region of the image that contains the images of all balls with a given radius around the points of a
/// line segment, with a margin of some pixels. The computation assumes a lens without distortion. The region
/// is never too small.
class ImageRegion {
 public:
  /// Returns the region for the segment from p to q, in C, m; std::nullopt if the camera is too near. Omits
  /// parts of the tube (the union of the balls) that are more than `beyond`, m, past the segment's ends,
  /// measured along the segment.
  static std::optional<ImageRegion> of(const Intrinsics& lens, const Eigen::Vector3d& p,
                                       const Eigen::Vector3d& q, double radius,
                                       double beyond = std::numeric_limits<double>::infinity()) {
    constexpr double pixels_around = 2;
    const double nearest = std::min(p.z(), q.z());
    if (!(nearest > 1.5 * radius)) return std::nullopt;
    ImageRegion region;
    const Eigen::Vector2d a = p.head<2>() / p.z(), b = q.head<2>() / q.z();
    const Eigen::Vector2d from(lens.fx * a.x() + lens.cx, lens.fy * a.y() + lens.cy);
    const Eigen::Vector2d to(lens.fx * b.x() + lens.cx, lens.fy * b.y() + lens.cy);
    // At the angle t from the optical axis, the image of a ball is longer by the factor 1 / cos^2 t.
    const double off_axis = 1 + std::max(a.squaredNorm(), b.squaredNorm());
    const double scale = std::max(lens.fx, lens.fy) / (nearest - radius) * off_axis;
    const double aside = scale * radius + pixels_around;
    const double more = scale * std::min(beyond, radius) + pixels_around;
    region.low_ = from.cwiseMin(to).array() - aside;
    region.high_ = from.cwiseMax(to).array() + aside;
    const double length = (to - from).norm();
    if (!(length > 0)) return region;
    const Eigen::Vector2d d = (to - from) / length;
    region.bands_ = {Band(d, from, -more, length + more), Band({-d.y(), d.x()}, from, -aside, aside)};
    return region;
  }

  /// Smallest and largest (u, v) of the region.
  [[nodiscard]] const Eigen::Vector2d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector2d& high() const { return high_; }

  /// Returns the rows of the region, or its columns in row v, within an image of `size` rows or columns.
  [[nodiscard]] PixelRange rows(int size) const { return PixelRange::around(low_.y(), high_.y(), size); }
  [[nodiscard]] PixelRange columns(int v, int size) const {
    double low = low_.x(), high = high_.x();
    for (const Band& band : bands_) band.cut(v, low, high);
    return PixelRange::around(low, high, size);
  }

 private:
  // The band between two parallel lines. In a row, the band is between two columns that are linear in v.
  struct Band {
    double low = -std::numeric_limits<double>::infinity(), high = -low, by_v = 0;

    Band() = default;
    // low <= normal . (x - from) <= high.
    Band(const Eigen::Vector2d& normal, const Eigen::Vector2d& from, double least, double most) {
      if (std::abs(normal.x()) < 1e-6) return;
      const double one = least / normal.x(), other = most / normal.x();
      by_v = -normal.y() / normal.x();
      const double start = from.x() - by_v * from.y();
      low = start + std::min(one, other), high = start + std::max(one, other);
    }
    void cut(double v, double& from, double& to) const {
      from = std::max(from, low + by_v * v), to = std::min(to, high + by_v * v);
    }
  };

  Eigen::Vector2d low_, high_;
  std::array<Band, 2> bands_;
};

}  // namespace flexura
