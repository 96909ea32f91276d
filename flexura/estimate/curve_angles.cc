#include "flexura/estimate/curve_angles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/estimate/correspondence.h"
#include "flexura/math/direction.h"

namespace flexura {
namespace {

// Direction in W of a curve's image at point i, as in a parallel projection.
Eigen::Vector3d image_direction(const Observation& seen, std::size_t i) {
  constexpr std::size_t reach = 3;
  const std::size_t first = i - std::min(i, reach), last = std::min(i + reach, seen.points.size() - 1);
  return seen.view.parallel_way(seen.points[last].pixel - seen.points[first].pixel);
}

}  // namespace

std::vector<DirectionAngles> direction_angles(const Backbone& backbone, std::size_t count) {
  std::vector<DirectionAngles> angles(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const Eigen::Vector3d e = backbone.pose(share * backbone.length()).rotation.col(2);
    const double across = std::hypot(e.x(), e.y());
    const double before = i > 0 ? angles[i - 1].azimuth : 0;
    // Along Z the azimuth is undefined and keeps its value.
    const Eigen::Vector2d own = angles_of_direction(e);
    angles[i].azimuth = across > 1e-12 ? nearest_turn(own[0], before) : before;
    angles[i].elevation = own[1];
    angles[i].is_singular = is_singular_for_planes(angles[i].azimuth);
  }
  return angles;
}

DirectionAngles angles_of_planes(double alpha_1, double alpha_2) {
  return {alpha_1, elevation_of_planes(alpha_1, alpha_2), is_singular_for_planes(alpha_1)};
}

std::vector<DirectionAngles> plane_angles(const Observation& front, const Observation& side,
                                          std::size_t count) {
  constexpr std::size_t fewest = 8;
  const std::vector<SpacePoint> common = correspondence(front, side);
  if (common.size() < fewest) return {};
  std::vector<double> way(common.size(), 0);
  std::vector<DirectionAngles> seen(common.size());
  for (std::size_t i = 0; i < common.size(); ++i) {
    const SpacePoint& point = common[i];
    if (i > 0) way[i] = way[i - 1] + (point.position - common[i - 1].position).norm();
    const Eigen::Vector3d d1 = image_direction(front, point.seen[0]),
                          d2 = image_direction(side, point.seen[1]);
    seen[i] = angles_of_planes(std::atan2(d1.x(), d1.y()), std::atan2(d2.z(), d2.y()));
    if (i > 0) seen[i].azimuth = nearest_turn(seen[i].azimuth, seen[i - 1].azimuth);
  }
  std::vector<DirectionAngles> angles(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double there = way.back() * static_cast<double>(i) / static_cast<double>(count - 1);
    const auto after = std::ranges::lower_bound(way, there);
    const auto next =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - way.begin(), 1, std::ssize(way) - 1));
    const DirectionAngles &a = seen[next - 1], &b = seen[next];
    const double piece = way[next] - way[next - 1], share = piece > 0 ? (there - way[next - 1]) / piece : 0;
    angles[i] = {a.azimuth + share * (b.azimuth - a.azimuth),
                 a.elevation + share * (b.elevation - a.elevation), a.is_singular || b.is_singular};
  }
  return angles;
}

}  // namespace flexura
