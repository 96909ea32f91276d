#include "flexura/vision/expected_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/vision/axis_lengths.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// The figure may be this far from the prediction, px.
constexpr int prediction_reach = 12;

// Points outside the picture matter for the curve's length, but not these, px.
constexpr double far_outside = 1e6;

// Returns a chord of a figure near a point of the prediction; its width is 0 if there is none.
TubeSeed chord_near(const Components& components, const Vector2d& point, const Vector2d& normal) {
  constexpr double widest = 400;
  for (int i = 0; i <= 2 * prediction_reach; ++i) {
    const Vector2d place = point + (i % 2 == 0 ? i / 2 : -(i + 1) / 2) * normal;
    if (place.x() < 0 || place.y() < 0) continue;
    if (components.run_at(static_cast<int>(place.x() + 0.5), static_cast<int>(place.y() + 0.5)) == nullptr)
      continue;
    const TubeSeed seed = shortest_chord(components, place, widest);
    return seed.width < widest ? seed : TubeSeed{};
  }
  return {};
}

}  // namespace

void ExpectedAxis::set(std::span<const Vector2d> pixels, const Vector2d& origin) {
  points_.clear(), lengths_.clear();
  for (const Vector2d& pixel : pixels) {
    const Vector2d point = pixel - origin;
    if (!(point.cwiseAbs().maxCoeff() < far_outside)) continue;  // Also NaN.
    const double step = points_.empty() ? 0 : (point - points_.back()).norm();
    lengths_.push_back(points_.empty() ? 0 : lengths_.back() + step);
    points_.push_back(point);
  }
}

// Returns whether another part of the centerline covers a point of it, at least in part.
bool ExpectedAxis::is_beside_itself(std::size_t point, double width) const {
  constexpr double far = 3, near = 1.5;  // Widths along and across the centerline.
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (std::abs(lengths_[i] - lengths_[point]) > far * width &&
        (points_[i] - points_[point]).squaredNorm() < near * near * width * width)
      return true;
  return false;
}

void ExpectedAxis::seeds(const Components& components, std::vector<TubeSeed>& seeds) {
  constexpr std::array<double, 5> fractions = {0.5, 0.35, 0.65, 0.2, 0.8};
  constexpr double across = 0.5;  // Greatest cosine of the angle between a chord and the centerline.
  seeds.clear();
  for (const double fraction : fractions) {
    const auto at = std::ranges::lower_bound(lengths_, fraction * lengths_.back()) - lengths_.begin();
    const auto i = std::min(static_cast<std::size_t>(at), points_.size() - 1);
    const Vector2d tangent =
        (points_[std::min(i + 1, points_.size() - 1)] - points_[i == 0 ? 0 : i - 1]).normalized();
    const TubeSeed seed = chord_near(components, points_[i], {-tangent.y(), tangent.x()});
    if (seed.width > 0 && std::abs(seed.normal.dot(tangent)) < across && !is_beside_itself(i, seed.width))
      seeds.push_back(seed);
  }
}

// Returns the length along the prediction from its base to the place next to a pixel.
double ExpectedAxis::from_base(const Vector2d& pixel, double& distance) const {
  double nearest = std::numeric_limits<double>::infinity(), result = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Vector2d along = points_[i] - points_[i - 1];
    const double squared = along.squaredNorm();
    const double share =
        squared > 0 ? std::clamp((pixel - points_[i - 1]).dot(along) / squared, 0.0, 1.0) : 0;
    const double off = (pixel - points_[i - 1] - share * along).squaredNorm();
    if (off < nearest) nearest = off, result = lengths_[i - 1] + share * std::sqrt(squared);
  }
  distance = std::sqrt(nearest);
  return result;
}

bool ExpectedAxis::agrees(std::span<const AxisSample> axis, int width, int height) {
  constexpr double grace = 8;  // px
  constexpr double least_share = 0.85;
  constexpr std::size_t every = 4;  // Samples are one or two pixels apart.
  if (axis.empty()) return false;
  widths_.clear();
  for (const AxisSample& sample : axis) widths_.push_back(sample.width);
  const double usual = median(std::span(widths_));
  for (std::size_t i = 0; i < axis.size(); i += every) {
    double distance = 0;
    (void)from_base(axis[i].pixel, distance);
    if (distance > usual + grace) return false;
  }
  double clear = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Vector2d& point = points_[i];
    const bool is_inside = point.x() > 0 && point.y() > 0 && point.x() < width - 1 && point.y() < height - 1;
    if (is_inside && !is_beside_itself(i, usual)) clear += lengths_[i] - lengths_[i - 1];
  }
  return length_of(axis) > least_share * clear;
}

bool ExpectedAxis::is_reversed(std::span<const AxisSample> axis) const {
  double distance = 0;
  const std::size_t quarter = axis.size() / 4;
  return from_base(axis[quarter].pixel, distance) >
         from_base(axis[axis.size() - 1 - quarter].pixel, distance);
}

}  // namespace flexura
