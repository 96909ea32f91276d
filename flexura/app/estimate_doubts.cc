#include "flexura/app/estimate_doubts.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/estimate/shape_silhouette.h"
#include "flexura/math/median.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

using Eigen::Vector3d;

// A place of the arm: its direction from a camera, how far it is, and the radius described there, m.
struct Place {
  Vector3d direction = {0, 0, 1};
  double distance = 0, radius = 0;
};
std::vector<Place> places_from(const View& view, const Shape& shape) {
  constexpr int per_section = 50;
  const Backbone backbone(shape.arm, shape.state);
  std::vector<Place> places;
  double begin = 0;
  for (std::size_t i = 0; i < shape.arm.sections.size(); ++i) {
    const Section& section = shape.arm.sections[i];
    const double length = section.length * shape.state.stretches[i];
    for (int k = 0; k <= per_section; ++k) {
      const double share = static_cast<double>(k) / per_section,
                   s = std::min(begin + share * length, backbone.length());
      const Vector3d p = view.X_WC.inverse() * backbone.pose(s).position;
      places.push_back(
          {p.normalized(), p.norm(), (1 - share) * section.radius[0] + share * section.radius[1]});
    }
    begin += length;
  }
  return places;
}

std::optional<Vector3d> direction_of(const Lens& lens, const Eigen::Vector2d& pixel) {
  const auto ray = lens.unproject(pixel);
  if (!ray) return std::nullopt;
  return ray->homogeneous().normalized();
}

// The radii seen over those described, where both edges of the tube are. The chord between their directions
// is 2 r over the distance (backbone_depths).
void add_ratios(const Sighting& seen, const ViewError& error, const Shape& shape,
                std::vector<double>& ratios) {
  const View view = corrected(seen.view, error);
  const std::vector<Place> places = places_from(view, shape);
  for (std::size_t i = 0; i < std::min(seen.edges[0].size(), seen.edges[1].size()); ++i) {
    const auto one = direction_of(view.lens, seen.edges[0][i].pixel),
               other = direction_of(view.lens, seen.edges[1][i].pixel);
    if (!one || !other) continue;
    const Vector3d middle = (*one + *other).normalized();
    const auto there =
        std::ranges::max_element(places, {}, [&](const Place& place) { return place.direction.dot(middle); });
    const double ratio = 0.5 * (*one - *other).norm() * there->distance / there->radius;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
}

}  // namespace

std::optional<std::string> doubt_of_size(const View& view) {
  const Intrinsics lens = view.lens.intrinsics();
  const auto is_aside = [](double at, int size) { return at < 0.3 * size || at > 0.7 * size; };
  if (!is_aside(lens.cx, view.width) && !is_aside(lens.cy, view.height)) return std::nullopt;
  // In whose middle the principal point would be, if that is a picture of the same shape.
  const double width = 2 * lens.cx + 1, height = 2 * lens.cy + 1, factor = width / view.width;
  constexpr double alike = 0.2;
  const bool is_scaled = factor > 0 && std::abs(height / (factor * view.height) - 1) < alike;
  return fmt::format(
      "the principal point ({:.4g}, {:.4g}) is far from the middle of this picture of {} x {} px: is the "
      "camera's description one for pictures of another size{}?",
      lens.cx, lens.cy, view.width, view.height,
      is_scaled ? fmt::format(", {:.3g} times as large", factor) : "");
}

std::optional<std::string> doubt_of_radius(std::span<const Sighting> sightings, const Shape& shape) {
  constexpr double most_off = 0.15;
  constexpr std::size_t fewest = 20;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    add_ratios(sightings[i], error_of(shape, i), shape, ratios);
  if (ratios.size() < fewest) return std::nullopt;
  const double ratio = median(std::span(ratios));
  if (!(std::abs(ratio - 1) > most_off)) return std::nullopt;
  const double first = shape.arm.sections.front().radius[0];
  const bool is_one = std::ranges::all_of(shape.arm.sections, [&](const Section& section) {
    return section.radius[0] == first && section.radius[1] == first;
  });
  if (is_one)
    return fmt::format("the pictures show an arm of {:.3g} m radius, described are {:.3g} m", ratio * first,
                       first);
  return fmt::format("the pictures show an arm {:.2f} times as thick as it is described", ratio);
}

}  // namespace flexura
