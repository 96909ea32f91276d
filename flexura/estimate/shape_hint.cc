#include "flexura/estimate/shape_hint.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "flexura/estimate/shape_silhouette.h"
#include "flexura/math/median.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

using Eigen::Vector3d;

// A point of the arm: its direction and distance from a camera, and the described radius there, m.
struct BackbonePlace {
  Vector3d direction = {0, 0, 1};
  double distance = 0, radius = 0;
};
std::vector<BackbonePlace> places_from(const View& view, const Shape& shape) {
  constexpr int per_section = 50;
  const Backbone backbone(shape.arm, shape.state);
  std::vector<BackbonePlace> places;
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

// Adds the ratios of observed to described radii where both edges of the tube are visible. The chord between
// their directions is 2 r over the distance (backbone_depths).
void add_ratios(const Observation& seen, const ViewError& error, const Shape& shape,
                std::vector<double>& ratios) {
  const View view = corrected(seen.view, error);
  const std::vector<BackbonePlace> places = places_from(view, shape);
  for (std::size_t i = 0; i < std::min(seen.edges[0].size(), seen.edges[1].size()); ++i) {
    const auto one = direction_of(view.lens, seen.edges[0][i].pixel),
               other = direction_of(view.lens, seen.edges[1][i].pixel);
    if (!one || !other) continue;
    const Vector3d middle = (*one + *other).normalized();
    const auto there = std::ranges::max_element(
        places, {}, [&](const BackbonePlace& place) { return place.direction.dot(middle); });
    const double ratio = 0.5 * (*one - *other).norm() * there->distance / there->radius;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
}

// Returns a hint if the observed radius differs from the described one.
std::optional<std::string> hint_of_radius(std::span<const Observation> observations, const Shape& shape) {
  constexpr double most_off = 0.15;
  constexpr std::size_t fewest = 20;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < observations.size(); ++i)
    add_ratios(observations[i], error_of(shape, i), shape, ratios);
  if (ratios.size() < fewest) return std::nullopt;
  const double ratio = median(std::span(ratios));
  if (!(std::abs(ratio - 1) > most_off)) return std::nullopt;
  const double first = shape.arm.sections.front().radius[0];
  const bool is_one = std::ranges::all_of(shape.arm.sections, [&](const Section& section) {
    return section.radius[0] == first && section.radius[1] == first;
  });
  if (is_one)
    return fmt::format(
        "the pictures show an arm with a radius of {:.3g} m, but its file has {:.3g} m ({:.3g} m is the "
        "default)",
        ratio * first, first, Section{}.radius[0]);
  return fmt::format("the pictures show an arm that is {:.2f} times as thick as in its file", ratio);
}

// Returns a hint if the base, p_WB, would not be near the observed points.
std::optional<std::string> hint_of_base(std::span<const Observation> observations, const Vector3d& p_WB) {
  constexpr double far = 0.05;  // Share of the picture's diagonal.
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& seen = observations[i];
    const auto base = seen.view.project(p_WB);
    if (!((seen.view.X_WC.inverse() * p_WB).z() > 0))
      return fmt::format(
          "the base is behind the camera of picture {}: expected the position of the camera in the world, "
          "and the rotation of its frame (x right, y down, z forward)",
          i + 1);
    const double width = seen.view.width, height = seen.view.height;
    const bool is_inside =
        base && base->x() >= 0 && base->y() >= 0 && base->x() < width && base->y() < height;
    if (!is_inside) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const CurvePoint& point : seen.points) nearest = std::min(nearest, (point.pixel - *base).norm());
    for (const SeenBorder& point : seen.borders) nearest = std::min(nearest, (point.pixel - *base).norm());
    if (std::isfinite(nearest) && nearest > far * std::hypot(width, height))
      return fmt::format(
          "the base would be visible at ({:.0f}, {:.0f}) in picture {}, {:.0f} px from the arm. Check the "
          "base's position, whether the picture is from this camera, and whether it is upside down",
          base->x(), base->y(), i + 1, nearest);
  }
  return std::nullopt;
}

// Returns the unit of lengths that are this many times too large; "" if it is no such factor.
std::string unit_of(double factor) {
  constexpr double near = 0.15;
  for (const auto& [name, size] :
       {std::pair("mm", 1000.0), std::pair("cm", 100.0), std::pair("inches", 1 / 0.0254)})
    if (std::abs(factor / size - 1) < near) return name;
  return "";
}

// Returns a hint if the arm in the pictures has another length than the described one.
std::optional<std::string> hint_of_length(const ShapePrior& prior,
                                          std::span<const Observation> observations) {
  constexpr double same = 0.15;
  const ShapeEstimate free = ShapeEstimator(unknown_arm(std::nullopt, std::nullopt)).estimate(observations);
  if (!free.is_found) return std::nullopt;
  const double seen = Backbone(free.shape.arm, free.shape.state).length(), described = prior.arm.length();
  if (std::abs(std::log(described / seen)) < same) return std::nullopt;
  std::string hint = fmt::format(
      "with these positions of the cameras, the pictures show {:.3g} m of an arm, but its length is given as "
      "{:.3g} m",
      seen, described);
  if (const std::string unit = unit_of(described / seen); !unit.empty())
    return hint + fmt::format(": are the lengths of the arm in {}? Expected m", unit);
  if (const std::string unit = unit_of(seen / described); !unit.empty())
    return hint + fmt::format(": are the positions of the cameras in {}? Expected m", unit);
  return hint;
}

}  // namespace

std::optional<std::string> hint_of(const ShapePrior& prior, std::span<const Observation> observations,
                                   const ShapeEstimate& estimate) {
  if (estimate.is_found) return hint_of_radius(observations, estimate.shape);
  auto hint =
      prior.is_base_position_known ? hint_of_base(observations, prior.arm.X_WB.position) : std::nullopt;
  if (!prior.is_length_known) return hint;
  // A wrong unit also moves the base.
  auto other = hint_of_length(prior, observations);
  const bool is_unit = other && other->ends_with("Expected m");
  return is_unit || !hint ? other : hint;
}

}  // namespace flexura
