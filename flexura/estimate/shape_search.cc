#include "flexura/estimate/shape_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "flexura/estimate/observation_pair.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/shape_start.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Returns the rotation of a view with a prior that moves the base's image to the arm's beginning.
ViewError aimed_at_base(const Observation& seen, const Eigen::Vector3d& p_WB) {
  ViewError error;
  if (!(seen.view_prior.rotation_std > 0) || !seen.ends[0]) return error;
  const auto ray = seen.view.lens.unproject(seen.ends[0]->pixel);
  if (!ray) return error;
  const Eigen::Vector3d looked = ray->homogeneous().normalized(),
                        there = (seen.view.X_WC.inverse() * p_WB).normalized();
  // If it is farther away, it is not the base but where the arm emerges from behind something.
  constexpr double most = 3;  // Standard deviations of the prior.
  const Eigen::Vector3d turn = looked.cross(there);
  if (turn.norm() < most * seen.view_prior.rotation_std) error.turn = turn;
  return error;
}

// Returns the squared distances of observed ends from a shape's ends, each bounded, px^2. If a tip is hidden,
// what is taken for it may lie anywhere.
double ends_elsewhere(std::span<const Observation> observations, const Shape& shape) {
  constexpr double most = 1;  // px^2
  const Backbone backbone(shape.arm, shape.state);
  double sum = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const View view = corrected(observations[i].view, error_of(shape, i));
    for (std::size_t end = 0; end < 2; ++end) {
      if (!observations[i].ends[end]) continue;
      const auto pixel = view.project(backbone.pose(end == 0 ? 0 : backbone.length()).position);
      const double square = pixel ? (*pixel - observations[i].ends[end]->pixel).squaredNorm()
                                  : std::numeric_limits<double>::infinity();
      sum += std::isfinite(square) ? square / (1 + square / most) : most;
    }
  }
  return sum;
}

// Improves the bend of the last section by descent on the misfit of silhouettes and ends.
Shape last_bent_to_fit(std::span<const Observation> observations, Shape shape) {
  constexpr double first = 0.1, last = 0.01;  // rad
  Eigen::Vector2d& bend = shape.state.bends.back();
  const auto against = [&] { return misfit(observations, shape) + ends_elsewhere(observations, shape); };
  double least = against();
  const int axes = shape.arm.kind == ArmKind::planar ? 1 : 2;
  for (double step = first; step > last; step /= 2) {
    constexpr int most_rounds = 10;
    bool is_lower = true;
    for (int round = 0; round < most_rounds && is_lower; ++round) {
      is_lower = false;
      for (int k = 0; k < 2 * axes; ++k) {
        const Eigen::Vector2d before = bend;
        bend[k / 2] += k % 2 == 0 ? step : -step;
        const double now = against();
        if (now < least)
          least = now, is_lower = true;
        else
          bend = before;
      }
    }
  }
  return shape;
}

// Returns the few shapes with another bend of the last section that fit silhouettes and ends best.
std::vector<Shape> last_bent_otherwise(std::span<const Observation> observations, const Shape& shape) {
  constexpr double step = 0.2;  // rad
  constexpr int steps = 8, ways = 12;
  constexpr std::size_t few = 8;
  const std::size_t last = shape.arm.sections.size() - 1;
  struct Other {
    Shape shape;
    double against = 0;  // px^2
  };
  std::vector<Other> others;
  for (int k = 0; k < steps; ++k)
    for (Shape& other : bent_otherwise(shape, last, k * step, k > 0 ? ways : 1)) {
      const double against = misfit(observations, other) + ends_elsewhere(observations, other);
      others.push_back({std::move(other), against});
    }
  std::ranges::stable_sort(others, {}, &Other::against);
  // Without radius and ends there is no evidence against any shape.
  if (!(others.back().against > others.front().against)) return {};
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < std::min(few, others.size()); ++i)
    shapes.push_back(last_bent_to_fit(observations, std::move(others[i].shape)));
  return shapes;
}

// Returns the largest distance of points at equal shares of both lengths, m.
double distance(const Shape& one, const Shape& other) {
  constexpr int count = 20;
  const Backbone a(one.arm, one.state), b(other.arm, other.state);
  double largest = 0;
  for (int i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const Eigen::Vector3d off = a.pose(share * a.length()).position - b.pose(share * b.length()).position;
    largest = std::max(largest, off.norm());
  }
  return largest;
}

bool has_lengths(const Shape& shape) {
  const auto is_length = [](const Section& section, double stretch) {
    const double length = section.length * stretch;
    return length > 0 && std::isfinite(length);
  };
  for (std::size_t i = 0; i < shape.arm.sections.size(); ++i)
    if (!is_length(shape.arm.sections[i], shape.state.stretches[i]) || !shape.state.bends[i].allFinite())
      return false;
  return true;
}

Shape scaled(Shape shape, double factor) {
  for (Eigen::Vector2d& bend : shape.state.bends) bend *= factor;
  return shape;
}

}  // namespace

std::optional<std::size_t> view_elsewhere(std::span<const Observation> observations, const Shape& shape) {
  constexpr double most = 5;         // standard deviations
  constexpr double rounding = 1e-4;  // Of views without a prior.
  for (std::size_t i = 0; i < std::min(observations.size(), shape.views.size()); ++i) {
    const auto& [turn, focal] = observations[i].view_prior;
    const ViewError& error = shape.views[i];
    if (!(error.turn.norm() <= most * turn + rounding) || !(std::abs(error.focal) <= most * focal + rounding))
      return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> bent_too_far(const Shape& shape) {
  constexpr double share = 1.02, more = 0.02;  // rad; the precision of bends from pictures.
  for (std::size_t i = 0; i < shape.arm.sections.size(); ++i)
    if (shape.state.bends[i].norm() > share * shape.arm.sections[i].max_bend + more) return i;
  return std::nullopt;
}

ShapeSearch::Try ShapeSearch::tried(ShapeProblem& problem, const Start& start, double most) {
  // Points and silhouette decide where they distinguish shapes.
  constexpr double of_ends = 0.001;
  Try one;
  one.fit = descent_.descend(problem, start.shape, most_iterations_, start.kind);
  const Shape& shape = one.fit.shape;
  const std::span<const Observation> seen = problem.observations();
  // A fit may diverge to invalid lengths.
  if (!has_lengths(shape)) {
    one.merit = one.misfit = std::numeric_limits<double>::infinity();
    return one;
  }
  one.ends = ends_elsewhere(seen, shape);
  one.unexplained = one.fit.cost - one.fit.rms * one.fit.rms + silhouette_misfit(seen, shape);
  one.merit = one.fit.cost + silhouette_misfit(seen, shape) + of_ends * one.ends;
  one.is_within_prior = !view_elsewhere(seen, shape);
  one.is_possible = !bent_too_far(shape);
  one.misfit = std::numeric_limits<double>::infinity();
  if (!(one.merit < most)) return one;
  one.misfit = misfit(seen, shape);
  one.merit += one.misfit;
  return one;
}

bool ShapeSearch::is_better(const Try& one, const Try& other) {
  if (one.is_within_prior != other.is_within_prior) return one.is_within_prior;
  // One whose bends are all possible may explain slightly less.
  constexpr double most = 2, little = 0.01;  // px^2
  if (one.is_possible && !other.is_possible) return one.merit < most * other.merit + little;
  if (other.is_possible && !one.is_possible) return !(other.merit < most * one.merit + little);
  return one.merit < other.merit;
}

bool ShapeSearch::is_explained(const Try& one) const {
  // One hidden tip is not unusual.
  constexpr double most = 0.02, most_misfit = 0.0005, most_ends = 1.3;  // px^2
  constexpr double most_scale = 2;
  return one.fit.is_good(most_rms_) && one.fit.scale < most_scale && one.unexplained < most &&
         one.misfit < most_misfit && one.ends < most_ends;
}

// Leaves far more unexplained than is_explained allows.
bool ShapeSearch::leaves_much(const Try& one) const {
  constexpr double most = 0.02, most_misfit = 0.01, most_ends = 2.3;  // px^2
  constexpr double most_scale = 4;
  return !one.fit.is_good(most_rms_) || one.fit.scale > most_scale || one.unexplained > most ||
         one.misfit > most_misfit || one.ends > most_ends;
}

ShapeSearch::Result ShapeSearch::best(const std::vector<Observation>& observations) {
  // `otherwise`: one that explains everything with camera errors beyond their priors.
  std::optional<Try> best, otherwise;
  std::vector<Observation> best_seen, seen_otherwise;
  const auto most = [&] {
    return best && best->is_within_prior && best->is_possible ? best->merit
                                                              : std::numeric_limits<double>::infinity();
  };
  const auto is_best = [&](const Try& one) { return !best || is_better(one, *best); };
  const auto note = [&](const Try& one, const std::vector<Observation>& as_seen) {
    if (!one.is_within_prior && !otherwise && is_explained(one)) otherwise = one, seen_otherwise = as_seen;
  };
  const auto is_end = [&] { return best->is_within_prior && best->is_possible && is_explained(*best); };
  // Without a base it is unknown which ends of the axes correspond. Both orders are tried for two pictures;
  // the others follow the resulting points.
  const bool has_base = prior_.is_base_position_known, has_pair = observations.size() >= 2;
  const ObservationPair pair = has_pair ? best_pair(observations) : ObservationPair{0, 0};
  for (const bool against : {false, true}) {
    if (against && (has_base || !has_pair)) break;
    const std::vector<Observation> seen =
        has_pair ? run_alike(observations, pair, against, has_base) : observations;
    ShapeProblem problem(prior_, seen);
    for (const Shape& start : starts(seen, pair)) {
      Try one = tried(problem, {start}, most());
      note(one, seen);
      const bool is_last = one.fit.is_good(most_rms_) && one.is_within_prior;
      if (is_best(one)) best = std::move(one), best_seen = seen;
      if (is_last) break;
    }
  }
  // A part seen in one picture may have several shapes: if not all is explained, alternatives are tried.
  constexpr int rounds = 2;
  constexpr double worse = 1.5, little = 0.01;  // px
  constexpr double one_end = 0.9;               // px^2, of displaced ends
  const double most_rms = worse * best->fit.rms + little;
  bool has_moved = true;
  for (int round = 0; round < rounds && has_moved && !is_end(); ++round) {
    has_moved = false;
    ShapeProblem problem(prior_, best_seen);
    for (const Start& start : look_alikes(best_seen, Shape(best->fit.shape))) {
      Try one = tried(problem, start, most());
      note(one, best_seen);
      if (one.fit.rms < most_rms && is_best(one)) best = std::move(one), has_moved = true;
      if (is_end()) break;
    }
  }
  if (otherwise && (!best->is_within_prior || leaves_much(*best)))
    return {std::move(otherwise->fit), std::move(seen_otherwise)};
  // Alternatives are also checked if no picture shows the tip.
  const auto shows_tip = [](const Observation& seen) { return seen.ends[1].has_value(); };
  const bool may_be_another =
      is_explained(*best) && (best->ends > one_end || std::ranges::none_of(best_seen, shows_tip));
  Result result{std::move(best->fit), std::move(best_seen)};
  if (may_be_another) result.apart = apart(result);
  return result;
}

// One end of the arm is displaced: it may be hidden, or the true shape may be another one with a similar
// image.
double ShapeSearch::apart(const Result& found) {
  const auto is_uncertain = [](const Observation& seen) {
    return seen.view_prior.is_any() || !seen.bands.empty() || !seen.markers.empty();
  };
  if (!prior_.is_base_position_known || !prior_.is_length_known ||
      std::ranges::any_of(found.seen, is_uncertain))
    return 0;
  double largest = 0;
  ShapeProblem problem(prior_, found.seen);
  for (const Start& start : look_alikes(found.seen, found.fit.shape)) {
    const Try one = tried(problem, start, std::numeric_limits<double>::infinity());
    if (is_explained(one) && one.is_possible)
      largest = std::max(largest, distance(found.fit.shape, one.fit.shape));
  }
  return largest;
}

std::vector<Shape> ShapeSearch::starts(std::span<const Observation> observations,
                                       const ObservationPair& pair) const {
  std::vector<Shape> shapes;
  std::vector<ViewError> views;
  for (const Observation& seen : observations)
    views.push_back(prior_.is_base_position_known ? aimed_at_base(seen, prior_.arm.X_WB.position)
                                                  : ViewError{});
  if (observations.size() >= 2) {
    std::array<Observation, 2> aimed = {observations[pair[0]], observations[pair[1]]};
    for (std::size_t k = 0; k < 2; ++k) aimed[k].view = corrected(aimed[k].view, views[pair[k]]);
    std::vector<Eigen::Vector3d> points = places_seen(aimed[0], aimed[1]);
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

std::vector<ShapeSearch::Start> ShapeSearch::look_alikes(std::span<const Observation> observations,
                                                         const Shape& shape) const {
  std::vector<Start> shapes;
  // A diverged fit may have shrunk an arm of unknown length to zero.
  constexpr double least = 1e-6;  // m
  double length = 0;
  for (std::size_t i = 0; i < shape.arm.sections.size(); ++i)
    length += shape.arm.sections[i].length * shape.state.stretches[i];
  if (!(length > least) || !std::isfinite(length)) return shapes;
  const std::size_t sections = prior_.arm.sections.size();
  constexpr std::size_t most = 4;  // Of many short sections, only every nth.
  for (std::size_t i = 0; i < sections; i += 1 + (sections - 1) / most)
    for (const Observation& seen : observations) shapes.push_back({mirrored(prior_, shape, i, seen.view)});
  if (sections > most) return shapes;
  const auto append = [&](std::vector<Shape> others, StartKind kind) {
    for (Shape& other : others) shapes.push_back({std::move(other), kind});
  };
  for (const double bend : {0.0, 0.6, 1.2})
    append(bent_otherwise(shape, sections - 1, bend, bend > 0 ? 8 : 1), StartKind::far);
  // These lie on the silhouette: axis points beside them are outliers at once.
  append(last_bent_otherwise(observations, shape), StartKind::near);
  return shapes;
}

}  // namespace flexura
