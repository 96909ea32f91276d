#include "flexura/estimate/picture_sighting.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flexura/vision/backbone_image.h"
#include "flexura/vision/markers.h"

namespace flexura {
namespace {

// No axis is known better, px: lenses are not.
constexpr double least_sigma = 0.007;
// Of a silhouette, px: a tube's is nearly as far from the backbone's image as its radius is large there.
constexpr double border_sigma = 0.5;
// Of a band's middle, px: what skin and shading do to it.
constexpr double band_sigma = 0.2;

// Over which axes are smoothed, px.
constexpr double smoothed = 5.4;
// Whole axes are off together, over more than a hundred pixels: the borders' model is not the picture's. As
// measured against drawn arms (docs/estimation.md), px: of any tube, by its blur and the root of blur over
// width, for the light falls off at the border of a round one as the root of the distance does; of thin ones,
// whose borders are one in the other's blur, by the square of blur over width; and of straight ones along
// rows or columns, whose borders are at one place between two pixels all the way.
constexpr double of_any = 0.0064, of_thin = 0.35, of_locked = 0.011;
// Over how much of the axis the last is looked for, px.
constexpr double stretch = 60;

double offset_at(const ArmSighting& arm, std::size_t i, std::size_t samples) {
  const std::vector<AxisSample>& axis = arm.axis;
  const std::size_t before = i - std::min(i, samples / 2),
                    after = std::min(before + samples, axis.size() - 1);
  const Eigen::Vector2d way = axis[after].pixel - axis[before].pixel;
  // The rows or columns that so much of it crosses, px.
  const double crossed = way.cwiseAbs().minCoeff() * stretch / std::max(way.norm(), 1.0);
  const double locked = of_locked / (1 + 5 * crossed * crossed);
  const double thin = arm.blur / std::max(axis[i].width, 1.0);
  return std::hypot(of_any * arm.blur * std::sqrt(thin) + of_thin * thin * thin, locked);
}

// The length of the axis from sample `from` to sample `to`, px.
double length_between(const std::vector<AxisSample>& axis, std::size_t from, std::size_t to) {
  double length = 0;
  for (std::size_t i = from; i < to; ++i) length += (axis[i + 1].pixel - axis[i].pixel).norm();
  return length;
}

// Whether samples tell where the axis is: those that are seen, but for a few between two long stretches that
// it bridges. There borders of something else were taken for the tube's, pixels off. (A cross-section that
// noise hides is bridged over what axes are smoothed over; it says nothing of those between two such.)
std::vector<bool> telling(const std::vector<AxisSample>& axis) {
  std::vector<bool> tells(axis.size());
  const auto next_seen = [&](std::size_t i, bool is_seen) {
    while (i < axis.size() && axis[i].is_seen != is_seen) ++i;
    return i;
  };
  std::size_t before = 0;  // The last sample seen before the stretch.
  for (std::size_t first = next_seen(0, true), end = first; first < axis.size();
       first = next_seen(end, true)) {
    end = next_seen(first, false);
    const std::size_t last = end - 1, after = std::min(next_seen(end, true), axis.size() - 1);
    const bool is_by_chance = length_between(axis, first, last) < 0.5 * axis[first].width &&
                              length_between(axis, before, first) > 2 * smoothed &&
                              length_between(axis, last, after) > 2 * smoothed;
    for (std::size_t i = first; i < end; ++i) tells[i] = !is_by_chance;
    before = last;
  }
  return tells;
}

// The way in which the axis goes on where it is nearest to a pixel.
Eigen::Vector2d heading_at(const std::vector<AxisSample>& axis, const Eigen::Vector2d& pixel) {
  const auto nearest = std::ranges::min_element(
      axis, {}, [&](const AxisSample& sample) { return (sample.pixel - pixel).squaredNorm(); });
  return {nearest->normal.y(), -nearest->normal.x()};
}

}  // namespace

Sighting sighting_of(const ArmSighting& arm, const View& view) {
  Sighting seen;
  seen.view = view;
  seen.reach.sigma = smoothed;
  for (const BorderPoint& point : arm.unexplained) seen.borders.push_back({point.pixel, border_sigma});
  seen.figure = arm.places;
  std::vector<AxisSample> axis = arm.axis;
  std::vector<bool> tells = telling(axis);
  // The axis lies half-way between the borders: each is known by the root of two worse.
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!tells[i]) continue;
    const AxisSample& sample = axis[i];
    const double sigma = std::max(std::numbers::sqrt2 * sample.sigma, least_sigma);
    const Eigen::Vector2d half = 0.5 * sample.width * sample.normal;
    seen.edges[0].push_back({sample.pixel + half, sigma});
    seen.edges[1].push_back({sample.pixel - half, sigma});
  }
  if (!to_backbone_image(view.lens, axis)) {
    // Where the lens has no ray nothing was moved: that is no place of the backbone.
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const AxisSample& sample = arm.axis[i];
      for (const double side : {0.5, -0.5})
        if (!view.lens.unproject(sample.pixel + side * sample.width * sample.normal)) tells[i] = false;
    }
  }
  const auto samples = static_cast<std::size_t>(
      axis.size() < 2 ? 0.0 : stretch / std::max((axis[1].pixel - axis[0].pixel).norm(), 0.5));
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (tells[i])
      seen.points.push_back(
          {axis[i].pixel, std::max(axis[i].sigma, least_sigma), offset_at(arm, i, samples)});
  if (!arm.is_whole()) return seen;
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
    if (arm.ends[end].kind == AxisEndKind::free)
      seen.ends[end] = SeenEnd{arm.ends[end].pixel, arm.ends[end].sigma};
  return seen;
}

Sighting sighting_of(const ArmSighting& arm, const View& view, const Image<std::uint8_t>& picture) {
  Sighting seen = sighting_of(arm, view);
  ArmSighting corrected = arm;
  to_backbone_image(view.lens, corrected.axis);
  constexpr bool with_spots = false;  // Nothing is known of the backbone there.
  for (const MarkerSighting& marker : find_markers(picture, corrected, with_spots).markers) {
    if (!marker.tells_place()) continue;
    seen.bands.push_back({marker.pixel, heading_at(corrected.axis, marker.pixel),
                          std::hypot(marker.sigma, band_sigma), marker.color});
  }
  return seen;
}

}  // namespace flexura
