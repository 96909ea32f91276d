#include "flexura/vision/backbone_image.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Returns the directions to the two borders of a sample; not finite if the lens has no ray.
std::array<Vector3d, 2> directions(const Lens& lens, const AxisSample& sample) {
  std::array<Vector3d, 2> result;
  for (std::size_t side = 0; side < 2; ++side) {
    const double offset = (side == 0 ? 0.5 : -0.5) * sample.width;
    const auto ray = lens.unproject(sample.pixel + offset * sample.normal);
    result[side].setConstant(std::numeric_limits<double>::quiet_NaN());
    if (ray) result[side] = Vector3d(ray->x(), ray->y(), 1).normalized();
  }
  return result;
}

}  // namespace

bool to_backbone_image(const Lens& lens, std::vector<AxisSample>& axis) {
  const std::size_t n = axis.size();
  if (n < 3)
    return std::ranges::all_of(axis, [&](const AxisSample& sample) { return has_rays(lens, sample); });
  bool is_whole = true;
  std::vector<std::array<Vector3d, 2>> borders;
  borders.reserve(n);
  for (const AxisSample& sample : axis) borders.push_back(directions(lens, sample));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t last = i > 0 ? i - 1 : 0, next = i + 1 < n ? i + 1 : i;
    const auto &here = borders[i], &before = borders[last], &after = borders[next];
    const Vector3d first = after[0] - before[0], second = after[1] - before[1], tangent = first + second;
    const Vector3d chord = here[0] - here[1];
    // Border points that belong to the same arc length have equal angles to the tangent's direction. Hence
    // the points are moved along the borders until the chord is perpendicular to the axis.
    const double desired = chord.dot(tangent) / tangent.squaredNorm();
    const double most = 0.2 * chord.norm() / std::max(first.norm(), second.norm());
    // Without a measured width this is unknown.
    const bool is_measured =
        std::isfinite(desired) && axis[last].is_seen && axis[i].is_seen && axis[next].is_seen;
    Vector3d middle = here[0] + here[1];
    if (is_measured) middle += std::clamp(desired, -most, most) * (second - first);
    const auto pixel = middle.allFinite() ? lens.project(middle) : std::nullopt;
    if (pixel) axis[i].pixel = *pixel;
    is_whole = is_whole && pixel.has_value();
  }
  return is_whole;
}

bool has_rays(const Lens& lens, const AxisSample& sample) {
  const auto [first, second] = directions(lens, sample);
  return first.allFinite() && second.allFinite();
}

bool BackboneAxis::is_whole() const { return std::ranges::find(is_backbone, false) == is_backbone.end(); }

std::vector<AxisSample> BackboneAxis::known() const {
  std::vector<AxisSample> result;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (is_backbone[i]) result.push_back(samples[i]);
  return result;
}

BackboneAxis backbone_axis(const Lens& lens, const std::vector<AxisSample>& axis) {
  constexpr int fewest = 3;
  const std::size_t n = axis.size();
  BackboneAxis result{axis, std::vector<bool>(n, false)};
  to_backbone_image(lens, result.samples);
  std::vector<bool> has(n);
  for (std::size_t i = 0; i < n; ++i) has[i] = has_rays(lens, axis[i]) && has_rays(lens, result.samples[i]);
  int seen = 0;
  for (std::size_t i = 0; i < n; ++i) {
    result.is_backbone[i] = has[i] && (i == 0 || has[i - 1]) && (i + 1 == n || has[i + 1]);
    if (result.is_backbone[i] && axis[i].is_seen) ++seen;
  }
  if (!result.is_whole() && seen < fewest) result.is_backbone.assign(n, false);
  for (std::size_t i = 0; i < n; ++i)
    if (!result.is_backbone[i]) result.samples[i] = axis[i];
  return result;
}

std::vector<double> backbone_depths(const Lens& lens, const std::vector<AxisSample>& axis, double radius) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw std::invalid_argument(fmt::format("a radius of {} m: expected a radius above 0", radius));
  std::vector<double> depths;
  depths.reserve(axis.size());
  for (const AxisSample& sample : axis) {
    const auto [first, second] = directions(lens, sample);
    // Chord of the directions = 2 r sqrt(1 - (r/D)^2) / distance of the tangent points.
    const double near = 2 * radius / (first - second).norm(), share = radius / near;
    const double touching = near * std::sqrt(std::max(0.0, 1 - share * share));
    const double distance = std::hypot(touching, radius);
    depths.push_back(distance * (first + second).normalized().z());
  }
  return depths;
}

}  // namespace flexura
