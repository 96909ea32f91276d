#include "flexura/estimate/shape_silhouette.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Image of a shape's point in one picture, and the distance of its borders from there.
struct SeenPlace {
  std::optional<Eigen::Vector2d> pixel;
  double half_width = 0;  // px
  double widest = 0;      // Half width in the direction of the largest stretch of a pinhole image, px.
};
std::vector<SeenPlace> seen_places(const Observation& seen, const ViewError& error, const Shape& shape) {
  constexpr int count = 80;
  const Backbone backbone(shape.arm, shape.state);
  const View view = corrected(seen.view, error);
  const double focal = std::max(view.lens.intrinsics().fx, view.lens.intrinsics().fy);
  std::vector<SeenPlace> places;
  // Start and length of the section along the arm, m.
  std::size_t section = 0;
  double begin = 0, length = shape.arm.sections[0].length * shape.state.stretches[0];
  for (int k = 0; k <= count; ++k) {
    const double s = backbone.length() * k / count;
    while (s > begin + length && section + 1 < shape.arm.sections.size()) {
      begin += length, ++section;
      length = shape.arm.sections[section].length * shape.state.stretches[section];
    }
    const double share = length > 0 ? std::clamp((s - begin) / length, 0.0, 1.0) : 0.0;
    const auto& ends = shape.arm.sections[section].radius;
    const double radius = (1 - share) * ends[0] + share * ends[1];
    const Eigen::Vector3d place = backbone.pose(s).position, p = view.X_WC.inverse() * place;
    const double half_width = radius * focal / p.norm(), slant = p.norm() / p.z();
    places.push_back({view.project(place), half_width, half_width * slant * slant});
  }
  return places;
}

// Mean distance between the remaining observed points, px.
double spacing(const Observation& seen) {
  double way = 0;
  const auto count = static_cast<double>(std::max<std::size_t>(1, seen.points.size() + seen.borders.size()));
  for (std::size_t i = 1; i < seen.points.size(); ++i)
    way += (seen.points[i].pixel - seen.points[i - 1].pixel).norm();
  for (std::size_t i = 1; i < seen.borders.size(); ++i)
    way += (seen.borders[i].pixel - seen.borders[i - 1].pixel).norm();
  return way / count;
}

double bounded(double off) {
  constexpr double far = 3;  // px
  return std::isfinite(off) ? off * off / (1 + off * off / (far * far)) : far * far;
}

// Returns the part of a shape's image without observation: mean square of the distances, each bounded, px^2.
double silhouette_misfit(const Observation& seen, const ViewError& error, const Shape& shape) {
  constexpr double gap = 2;  // px
  const std::vector<SeenPlace> places = seen_places(seen, error, shape);
  const double apart = gap + spacing(seen);
  double sum = 0;
  for (const auto& [pixel, half_width, widest] : places) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const CurvePoint& point : seen.points)
      nearest = std::min(nearest, pixel ? (point.pixel - *pixel).norm() : nearest);
    for (const SeenBorder& border : seen.borders)
      nearest = std::min(nearest, pixel ? (border.pixel - *pixel).norm() : nearest);
    const double off = std::max(0.0, nearest - half_width - apart);
    sum += bounded(off);
  }
  return sum / static_cast<double>(places.size());
}

// The image of a tube of the given width: links between successive points, and chains of several links. A
// chain is within `reach` of its middle, px.
struct Link {
  Eigen::Vector2d from = {0, 0}, way = {0, 0}, middle = {0, 0};
  double square = 0;               // Of `way`.
  double half_width = 0, end = 0;  // Half width at its start and end.
  double reach = 0;
};
struct Chain {
  std::vector<Link> list;
  Eigen::Vector2d middle = {0, 0};
  double reach = 0;
};
std::vector<Chain> tube_of(const std::vector<SeenPlace>& places, double wider) {
  constexpr std::size_t together = 8;
  std::vector<Chain> tube;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const auto &a = places[i], &b = places[i + 1];
    if (!a.pixel || !b.pixel) continue;
    if (tube.empty() || tube.back().list.size() == together) tube.emplace_back().list.reserve(together);
    const Eigen::Vector2d way = *b.pixel - *a.pixel;
    const double width = wider * std::max(a.widest, b.widest);
    tube.back().list.push_back({*a.pixel, way, *a.pixel + 0.5 * way, way.squaredNorm(), a.widest, b.widest,
                                0.5 * way.norm() + width});
  }
  for (Chain& some : tube) {
    some.middle = some.list[some.list.size() / 2].middle;
    for (const Link& one : some.list)
      some.reach = std::max(some.reach, (one.middle - some.middle).norm() + one.reach);
  }
  return tube;
}

// Returns the distance of a pixel from the image of a tube, px; 0 inside. `near` is the chain to search first
// and becomes the nearest one. Most chains are farther than the nearest so far, whichever of their links is
// nearest.
double outside(const std::vector<Chain>& tube, const Eigen::Vector2d& pixel, double wider,
               std::size_t& near) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto is_beyond = [&](const auto& part) {
    constexpr double rounding = 1 + 1e-9;
    const double within = nearest + part.reach;
    return (pixel - part.middle).squaredNorm() > rounding * within * within;
  };
  const std::size_t start = near;
  for (std::size_t k = 0; k < tube.size() && nearest > 0; ++k) {
    const std::size_t i = start + k < tube.size() ? start + k : start + k - tube.size();
    if (is_beyond(tube[i])) continue;
    for (const Link& one : tube[i].list) {
      if (is_beyond(one)) continue;
      const Eigen::Vector2d off = pixel - one.from;
      const double t = one.square > 0 ? std::clamp(one.way.dot(off) / one.square, 0.0, 1.0) : 0.0,
                   here = (off - t * one.way).norm() - wider * ((1 - t) * one.half_width + t * one.end);
      if (here < nearest) nearest = here, near = i;
    }
  }
  return std::max(0.0, nearest);
}

}  // namespace

double misfit(const Observation& seen, const ViewError& error, const Shape& shape, double wider) {
  const auto has_radius = [](const Section& section) {
    return section.radius[0] > 0 || section.radius[1] > 0;
  };
  if (seen.figure.empty() || !std::ranges::any_of(shape.arm.sections, has_radius)) return 0;
  constexpr double close = 1.5;  // px: the foreground has whole pixels of a blurred picture.
  const std::vector<Chain> tube = tube_of(seen_places(seen, error, shape), wider);
  double sum = 0;
  std::size_t near = 0;
  for (const Eigen::Vector2d& pixel : seen.figure)
    sum += bounded(std::max(0.0, outside(tube, pixel, wider, near) - close));
  return sum / static_cast<double>(seen.figure.size());
}

ViewError error_of(const Shape& shape, std::size_t observation) {
  return observation < shape.views.size() ? shape.views[observation] : ViewError{};
}

double silhouette_misfit(std::span<const Observation> observations, const Shape& shape) {
  double sum = 0;
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (!observations[i].borders.empty())
      sum += silhouette_misfit(observations[i], error_of(shape, i), shape);
  return sum;
}

double misfit(std::span<const Observation> observations, const Shape& shape) {
  double sum = 0;
  for (std::size_t i = 0; i < observations.size(); ++i)
    sum += misfit(observations[i], error_of(shape, i), shape);
  return sum;
}

bool explains_border(const Observation& seen, const ViewError& error, const Shape& shape) {
  constexpr double max_silhouette_misfit = 1, close = 2, enough = 0.7;  // px^2, px, share
  if (silhouette_misfit(seen, error, shape) > max_silhouette_misfit) return false;
  const std::vector<SeenPlace> places = seen_places(seen, error, shape);
  // Within the stretch between two points.
  const auto is_between = [&](const SeenPlace& a, const SeenPlace& b, const Eigen::Vector2d& pixel) {
    if (!a.pixel || !b.pixel) return false;
    const Eigen::Vector2d way = *b.pixel - *a.pixel;
    const double square = way.squaredNorm();
    const double t = square > 0 ? std::clamp(way.dot(pixel - *a.pixel) / square, 0.0, 1.0) : 0.0;
    return (*a.pixel + t * way - pixel).norm() < (1 - t) * a.half_width + t * b.half_width + close;
  };
  const auto is_explained = [&](const SeenBorder& border) {
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      if (is_between(places[i], places[i + 1], border.pixel)) return true;
    return false;
  };
  const auto explained = static_cast<double>(std::ranges::count_if(seen.borders, is_explained));
  return explained >= enough * static_cast<double>(seen.borders.size());
}

}  // namespace flexura
