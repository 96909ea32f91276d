#include "flexura/estimate/shape_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "flexura/estimate/correspondence.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/shape_start.h"

namespace flexura {
namespace {

// The turn of a view that is in doubt after which the base is seen where the arm begins.
ViewError aimed_at_base(const Sighting& seen, const Eigen::Vector3d& p_WB) {
  ViewError error;
  if (!(seen.doubt.turn > 0) || !seen.ends[0]) return error;
  const auto ray = seen.view.lens.unproject(seen.ends[0]->pixel);
  if (!ray) return error;
  const Eigen::Vector3d looked = ray->homogeneous().normalized(),
                        there = (seen.view.X_WC.inverse() * p_WB).normalized();
  // Farther off it is no base, but where the arm comes out from behind something.
  constexpr double most = 3;  // Of the doubt.
  const Eigen::Vector3d turn = looked.cross(there);
  if (turn.norm() < most * seen.doubt.turn) error.turn = turn;
  return error;
}

Shape scaled(Shape shape, double factor) {
  for (Eigen::Vector2d& bend : shape.state.bends) bend *= factor;
  return shape;
}

}  // namespace

bool are_as_doubted(std::span<const Sighting> sightings, const Shape& shape) {
  constexpr double most = 5;         // standard deviations
  constexpr double rounding = 1e-4;  // Of what is not doubted at all.
  for (std::size_t i = 0; i < std::min(sightings.size(), shape.views.size()); ++i) {
    const auto& [turn, focal] = sightings[i].doubt;
    const ViewError& error = shape.views[i];
    if (!(error.turn.norm() <= most * turn + rounding) || !(std::abs(error.focal) <= most * focal + rounding))
      return false;
  }
  return true;
}

ShapeSearch::Try ShapeSearch::tried(ShapeProblem& problem, const Shape& start, double most) {
  constexpr double impossible = 1e9;
  Try one{descent_.descend(problem, start, most_iterations_)};
  const Shape& shape = one.fit.shape;
  const std::span<const Sighting> seen = problem.sightings();
  one.merit = one.fit.cost + astray(seen, shape) + (are_as_doubted(seen, shape) ? 0.0 : impossible);
  if (!(one.merit < most)) return one;
  one.misfit = misfit(seen, shape);
  one.merit += one.misfit;
  return one;
}

// Beyond the distances of the points that are believed.
bool ShapeSearch::is_explained(const Try& one) const {
  constexpr double most = 0.02, most_misfit = 0.002;  // px^2
  return one.fit.is_good(most_rms_) && one.merit - one.fit.rms * one.fit.rms < most &&
         one.misfit < most_misfit;
}

ShapeSearch::Result ShapeSearch::best(std::vector<Sighting> seen) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::optional<Try> best;
  std::vector<Sighting> best_seen;
  const std::size_t ways = prior_.is_base_position_known || seen.size() < 2 ? 1 : 2;
  for (std::size_t way = 0; way < ways; ++way) {
    if (way == 1) seen[1] = reversed(seen[1]);
    ShapeProblem problem(prior_, seen);
    for (const Shape& start : starts(seen)) {
      Try one = tried(problem, start, best ? best->merit : infinity);
      const bool is_last = one.fit.is_good(most_rms_) && are_as_doubted(seen, one.fit.shape);
      if (!best || one.merit < best->merit) best = std::move(one), best_seen = seen;
      if (is_last) break;
    }
  }
  // What one picture shows in part may be one of several shapes: where all is not explained the others are
  // tried.
  constexpr int rounds = 2;
  bool is_better = true;
  for (int round = 0; round < rounds && is_better && !is_explained(*best); ++round) {
    is_better = false;
    ShapeProblem problem(prior_, best_seen);
    for (const Shape& start : look_alikes(best_seen, Shape(best->fit.shape))) {
      Try one = tried(problem, start, best->merit);
      if (one.merit < best->merit) best = std::move(one), is_better = true;
      if (is_explained(*best)) break;
    }
  }
  return {std::move(best->fit), std::move(best_seen)};
}

std::vector<Shape> ShapeSearch::starts(std::span<const Sighting> sightings) const {
  std::vector<Shape> shapes;
  std::vector<ViewError> views;
  for (const Sighting& seen : sightings)
    views.push_back(prior_.is_base_position_known ? aimed_at_base(seen, prior_.arm.X_WB.position)
                                                  : ViewError{});
  if (sightings.size() >= 2) {
    std::array<Sighting, 2> aimed = {sightings[0], sightings[1]};
    for (std::size_t i = 0; i < 2; ++i) aimed[i].view = corrected(aimed[i].view, views[i]);
    const Correspondence pairs = correspondence(aimed[0], aimed[1]);
    std::vector<Eigen::Vector3d> points;
    points.reserve(pairs.points.size());
    for (const SpacePoint& point : pairs.points) points.push_back(point.position);
    if (prior_.is_base_position_known && !points.empty()) points.front() = prior_.arm.X_WB.position;
    const auto is_other = [&](const Eigen::Vector3d& p) { return p != points.front(); };
    if (std::ranges::any_of(points, is_other)) {
      shapes.push_back(shape_along(prior_, points));
      shapes.push_back(scaled(shapes.front(), 0.5));
    }
  }
  shapes.push_back(straight_shape(prior_));
  for (Shape& shape : shapes) shape.views = views;
  const auto is_turned = [](const ViewError& error) { return error.turn.norm() > 0; };
  if (!std::ranges::any_of(views, is_turned)) return shapes;
  // What was taken for the base may be something else.
  const std::size_t aimed = shapes.size();
  for (std::size_t i = 0; i < aimed; ++i) shapes.emplace_back(shapes[i]).views.clear();
  return shapes;
}

std::vector<Shape> ShapeSearch::look_alikes(std::span<const Sighting> sightings, const Shape& shape) const {
  std::vector<Shape> shapes;
  // A fit that went astray may have shrunk an arm of unknown length to nothing.
  constexpr double least = 1e-6;  // m
  double length = 0;
  for (std::size_t i = 0; i < shape.arm.sections.size(); ++i)
    length += shape.arm.sections[i].length * shape.state.stretches[i];
  if (!(length > least) || !std::isfinite(length)) return shapes;
  const std::size_t sections = prior_.arm.sections.size();
  constexpr std::size_t most = 4;  // Of many short sections every so many.
  for (std::size_t i = 0; i < sections; i += 1 + (sections - 1) / most)
    for (const Sighting& seen : sightings) shapes.push_back(mirrored(prior_, shape, i, seen.view));
  if (sections > most) return shapes;
  for (const double bend : {0.0, 0.6, 1.2}) {
    const std::vector<Shape> others = bent_otherwise(shape, sections - 1, bend, bend > 0 ? 8 : 1);
    shapes.insert(shapes.end(), others.begin(), others.end());
  }
  return shapes;
}

}  // namespace flexura
