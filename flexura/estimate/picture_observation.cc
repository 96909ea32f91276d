#include "flexura/estimate/picture_observation.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flexura/vision/backbone_image.h"
#include "flexura/vision/markers.h"

namespace flexura {
namespace {

// Smallest standard deviation of an axis, px: the error of lenses.
constexpr double least_sigma = 0.007;
// Standard deviation of a silhouette, px: a tube's is about its radius from the backbone's image.
constexpr double border_sigma = 0.5;
// Standard deviation of a band's middle, px, by skin and shading.
constexpr double band_sigma = 0.2;

// Smoothing distance of axes, px.
constexpr double smoothed = 5.4;
// Errors common to a whole axis, over more than a hundred pixels, because the border model is approximate.
// Measured on drawn arms (docs/estimation.md), px. `of_any`: any tube, by its blur and the root of blur over
// width. (The light at the border of a round tube falls with the root of the distance.) `of_thin`: thin
// tubes, whose borders are within each other's blur, by the square of blur over width. `of_locked`: straight
// tubes along rows or columns, whose borders have a constant subpixel position.
constexpr double of_any = 0.0064, of_thin = 0.35, of_locked = 0.011;
// Length of the axis over which the last is determined, px.
constexpr double stretch = 60;

double offset_at(const ArmObservation& arm, std::size_t i, std::size_t samples) {
  const std::vector<AxisSample>& axis = arm.axis;
  const std::size_t before = i - std::min(i, samples / 2),
                    after = std::min(before + samples, axis.size() - 1);
  const Eigen::Vector2d way = axis[after].pixel - axis[before].pixel;
  // Number of rows or columns that this part crosses, px.
  const double crossed = way.cwiseAbs().minCoeff() * stretch / std::max(way.norm(), 1.0);
  const double locked = of_locked / (1 + 5 * crossed * crossed);
  const double thin = arm.blur / std::max(axis[i].width, 1.0);
  return std::hypot(of_any * arm.blur * std::sqrt(thin) + of_thin * thin * thin, locked);
}

// Length of the axis from sample `from` to sample `to`, px.
double length_between(const std::vector<AxisSample>& axis, std::size_t from, std::size_t to) {
  double length = 0;
  for (std::size_t i = from; i < to; ++i) length += (axis[i + 1].pixel - axis[i].pixel).norm();
  return length;
}

// Returns which samples determine the axis: all visible ones, except a few between two long bridged
// stretches. There the borders of something else were taken for the tube's, pixels away. (A cross-section
// hidden by noise is bridged over the smoothing distance only; samples between two such bridges are kept.)
std::vector<bool> reliable(const std::vector<AxisSample>& axis) {
  std::vector<bool> is_reliable(axis.size());
  const auto next_seen = [&](std::size_t i, bool is_seen) {
    while (i < axis.size() && axis[i].is_seen != is_seen) ++i;
    return i;
  };
  std::size_t before = 0;  // The last visible sample before the stretch.
  for (std::size_t first = next_seen(0, true), end = first; first < axis.size();
       first = next_seen(end, true)) {
    end = next_seen(first, false);
    const std::size_t last = end - 1, after = std::min(next_seen(end, true), axis.size() - 1);
    const bool is_by_chance = length_between(axis, first, last) < 0.5 * axis[first].width &&
                              length_between(axis, before, first) > 2 * smoothed &&
                              length_between(axis, last, after) > 2 * smoothed;
    for (std::size_t i = first; i < end; ++i) is_reliable[i] = !is_by_chance;
    before = last;
  }
  return is_reliable;
}

// Direction of the axis where it is nearest to a pixel.
Eigen::Vector2d heading_at(const std::vector<AxisSample>& axis, const Eigen::Vector2d& pixel) {
  const auto nearest = std::ranges::min_element(
      axis, {}, [&](const AxisSample& sample) { return (sample.pixel - pixel).squaredNorm(); });
  return {nearest->normal.y(), -nearest->normal.x()};
}

// A pixel without a ray shows no point of the arm.
void leave_out_what_has_no_ray(const Lens& lens, Observation& seen) {
  const auto has_no_ray = [&](const Eigen::Vector2d& pixel) {
    const bool has_none = !lens.unproject(pixel);
    seen.leaves_out = seen.leaves_out || has_none;
    return has_none;
  };
  const auto is_out = [&](const auto& point) { return has_no_ray(point.pixel); };
  std::erase_if(seen.points, is_out), std::erase_if(seen.borders, is_out);
  std::erase_if(seen.figure, has_no_ray);
  for (auto& end : seen.ends)
    if (end && is_out(*end)) end.reset();
}

// Returns the image of the backbone. A lens that shows its whole picture has rays for the whole axis.
BackboneAxis backbone_of(const ArmObservation& arm, const View& view) {
  if (!shows_all(view)) return backbone_axis(view.lens, arm.axis);
  BackboneAxis axis{arm.axis, std::vector<bool>(arm.axis.size(), true)};
  to_backbone_image(view.lens, axis.samples);
  return axis;
}

Observation observation_along(const ArmObservation& arm, const BackboneAxis& backbone, const View& view) {
  Observation seen;
  seen.view = view;
  seen.reach.sigma = smoothed;
  for (const BorderPoint& point : arm.unexplained) seen.borders.push_back({point.pixel, border_sigma});
  seen.figure = arm.places;
  const std::vector<AxisSample>& axis = backbone.samples;
  const std::vector<bool> is_reliable = reliable(arm.axis);
  const auto samples = static_cast<std::size_t>(
      axis.size() < 2 ? 0.0 : stretch / std::max((axis[1].pixel - axis[0].pixel).norm(), 0.5));
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!is_reliable[i]) continue;
    if (!backbone.is_backbone[i]) {
      seen.leaves_out = true;
      continue;
    }
    const AxisSample& sample = arm.axis[i];
    const Eigen::Vector2d half = 0.5 * sample.width * sample.normal;
    const std::array<Eigen::Vector2d, 2> borders = {sample.pixel + half, sample.pixel - half};
    // The axis is half-way between the borders: each has sqrt(2) times its standard deviation.
    const double sigma = std::max(std::numbers::sqrt2 * sample.sigma, least_sigma);
    for (std::size_t side = 0; side < 2; ++side) seen.edges[side].push_back({borders[side], sigma});
    seen.points.push_back({axis[i].pixel, std::max(sample.sigma, least_sigma), offset_at(arm, i, samples)});
  }
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
    if (arm.is_whole() && arm.ends[end].kind == AxisEndKind::free)
      seen.ends[end] = SeenEnd{arm.ends[end].pixel, arm.ends[end].sigma};
  if (!shows_all(view)) leave_out_what_has_no_ray(view.lens, seen);
  return seen;
}

}  // namespace

bool shows_all(const View& view) {
  const double right = view.width - 1, low = view.height - 1;
  const std::array<Eigen::Vector2d, 4> corners = {{{0, 0}, {right, 0}, {0, low}, {right, low}}};
  return std::ranges::all_of(
      corners, [&](const Eigen::Vector2d& corner) { return view.lens.unproject(corner).has_value(); });
}

Observation observation_of(const ArmObservation& arm, const View& view) {
  return observation_along(arm, backbone_of(arm, view), view);
}

Observation observation_of(const ArmObservation& arm, const View& view, const Image<std::uint8_t>& picture) {
  ArmObservation corrected = arm;
  const BackboneAxis backbone = backbone_of(arm, view);
  corrected.axis = backbone.samples;
  Observation seen = observation_along(arm, backbone, view);
  constexpr bool with_spots = false;  // They give no backbone position.
  for (const MarkerObservation& marker : find_markers(picture, corrected, with_spots).markers) {
    if (!marker.determines_place()) continue;
    if (!view.lens.unproject(marker.pixel)) {
      seen.leaves_out = true;
      continue;
    }
    seen.bands.push_back({marker.pixel, heading_at(corrected.axis, marker.pixel),
                          std::hypot(marker.sigma, band_sigma), marker.color});
  }
  return seen;
}

}  // namespace flexura
