#include "flexura/estimate/shape_estimator.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "flexura/estimate/band_match.h"
#include "flexura/estimate/correspondence.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/shape_start.h"

namespace flexura {
namespace {

// In sigmas: a fit whose points lie farther from the shape is no fit.
constexpr double most_scale = 8;

// The end nearer to where the base is seen comes first.
Sighting from_base(const Sighting& seen, const Eigen::Vector3d& p_WB) {
  const auto base = seen.view.project(p_WB);
  if (!base || seen.points.empty()) return seen;
  const bool is_reversed =
      (seen.points.back().pixel - *base).norm() < (seen.points.front().pixel - *base).norm();
  return is_reversed ? reversed(seen) : seen;
}

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

// Whether what is wrong with the views is no more than they are doubted.
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

bool have_axes(std::span<const Sighting> sightings) {
  return std::ranges::all_of(sightings, [](const Sighting& seen) { return are_enough({&seen, 1}); });
}

// Fills the places of the knots and their standard deviations; returns the arm's length.
double add_sigmas(const ShapeProblem& problem, const Eigen::MatrixXd& covariance, ShapeEstimate& result) {
  double s = 0;
  const auto& knots = problem.curve().knots();
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const auto& by = knots[i].unknowns;
    const double variance = (by * covariance.topLeftCorner(by.cols(), by.cols()) * by.transpose()).trace();
    result.s.push_back(s);
    result.sigma.push_back(variance >= 0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity());
    if (i + 1 < knots.size()) s += problem.curve().interval(i);
  }
  return s;
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value / static_cast<double>(values.size());
  return std::sqrt(squares);
}

// Why the arm may begin or end elsewhere on the same curve; "" where two of its ends, its length and places
// of markers tell. Else an axis that stops short draws the shape's end to its last point, and rows across
// that are then taken for what they are not: its place along the curve, to a hundredth of a pixel.
std::string doubt_of_ends(const ShapePrior& prior, const ShapeProblem& problem) {
  std::set<double> places;  // Of markers that are known, m.
  std::array<bool, 2> is_seen = {};
  for (const Sighting& seen : problem.sightings()) {
    for (std::size_t end = 0; end < 2; ++end) is_seen[end] = is_seen[end] || seen.ends[end].has_value();
    for (const SeenMarker& marker : seen.markers) places.insert(marker.s);
  }
  for (const BandLook& look : problem.looks())
    if (look.s) places.insert(*look.s);
  const bool has_base = prior.is_base_position_known || is_seen[0], has_tip = is_seen[1];
  const std::size_t told =
      places.size() + (has_base ? 1 : 0) + (has_tip ? 1 : 0) + (prior.is_length_known ? 1 : 0);
  if (told >= 2) return "";
  const char* what = "either end";
  if (has_base) what = "the tip";
  if (has_tip) what = "the base";
  return fmt::format("no picture shows {} of the arm: it may go on unseen", what);
}

ShapeEstimate unseen(Shape shape) {
  ShapeEstimate none;
  none.shape = std::move(shape);
  none.reason = "the arm is not seen in every image";
  return none;
}

Shape scaled(Shape shape, double factor) {
  for (Eigen::Vector2d& bend : shape.state.bends) bend *= factor;
  return shape;
}

}  // namespace

ShapeEstimator::ShapeEstimator(ShapePrior prior, EstimatorConfig config)
    : prior_(std::move(prior)), config_(config) {}

bool ShapeEstimator::is_good(const ShapeFit& fit) const {
  return fit.is_settled && fit.doubted < 0.1 && (fit.scale < most_scale || fit.rms < 0.5 * config_.most_rms);
}

std::vector<Sighting> ShapeEstimator::prepared(std::span<const Sighting> sightings) const {
  std::vector<Sighting> result;
  for (const Sighting& seen : sightings) {
    const auto is_none = [](const auto& point) {
      return !point.pixel.allFinite() || !(point.sigma > 0) || !std::isfinite(point.sigma);
    };
    Sighting whole = seen;
    std::erase_if(whole.points, is_none), std::erase_if(whole.borders, is_none);
    std::erase_if(whole.points, [](const CurvePoint& point) { return !(std::abs(point.offset) < 1e6); });
    if (!(whole.reach.offset > 0)) whole.reach.offset = ErrorReach{}.offset;
    std::erase_if(whole.markers, is_none), std::erase_if(whole.bands, is_none);
    for (auto& end : whole.ends)
      if (end && is_none(*end)) end.reset();
    Sighting thin = thinned(std::move(whole), config_.most_points);
    // Of an arm that is no wider than its backbone borders tell nothing.
    const auto has_radius = [](const Section& section) {
      return section.radius[0] > 0 || section.radius[1] > 0;
    };
    if (!std::ranges::any_of(prior_.arm.sections, has_radius)) thin.borders.clear();
    result.push_back(prior_.is_base_position_known ? from_base(thin, prior_.arm.X_WB.position) : thin);
  }
  return result;
}

std::vector<Shape> ShapeEstimator::starts(std::span<const Sighting> sightings) const {
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

std::vector<Shape> ShapeEstimator::look_alikes(std::span<const Sighting> sightings,
                                               const Shape& shape) const {
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
  return shapes;
}

ShapeEstimate ShapeEstimator::estimate(std::span<const Sighting> sightings) {
  std::vector<Sighting> seen = prepared(sightings);
  if (seen.empty() || !have_axes(seen)) return unseen(straight_shape(prior_));
  std::optional<ShapeFit> best;
  double best_merit = 0;
  std::vector<Sighting> best_seen;
  // What speaks against a shape, px^2.
  const auto merit_of = [](std::span<const Sighting> what, const ShapeFit& fit) {
    constexpr double impossible = 1e9;
    return fit.cost + astray(what, fit.shape) + (are_as_doubted(what, fit.shape) ? 0.0 : impossible);
  };
  const std::size_t ways = prior_.is_base_position_known || seen.size() < 2 ? 1 : 2;
  for (std::size_t way = 0; way < ways; ++way) {
    if (way == 1) seen[1] = reversed(seen[1]);
    ShapeProblem problem(prior_, seen);
    for (const Shape& start : starts(seen)) {
      ShapeFit fit = descent_.descend(problem, start, config_.most_iterations);
      const double merit = merit_of(seen, fit);
      const bool is_last = is_good(fit) && are_as_doubted(seen, fit.shape);
      if (!best || merit < best_merit) best = std::move(fit), best_merit = merit, best_seen = seen;
      if (is_last) break;
    }
  }
  // What one picture shows in part may be one of several shapes: where all is not explained the others are
  // tried.
  constexpr int rounds = 2;
  constexpr double explained = 0.25;  // px^2
  const auto is_explained = [&] { return is_good(*best) && best_merit < explained; };
  bool is_better = true;
  for (int round = 0; round < rounds && is_better && !is_explained(); ++round) {
    is_better = false;
    ShapeProblem problem(prior_, best_seen);
    for (const Shape& start : look_alikes(best_seen, Shape(best->shape))) {
      ShapeFit fit = descent_.descend(problem, start, config_.most_iterations);
      const double merit = merit_of(best_seen, fit);
      if (merit < best_merit) best = std::move(fit), best_merit = merit, is_better = true;
      if (is_explained()) break;
    }
  }
  ShapeProblem problem(prior_, best_seen);
  if (!problem.linearise(best->shape)) best->cost = std::numeric_limits<double>::infinity();
  const double cost = best->cost;
  return with_bands(best_seen, answer(problem, std::move(*best)), cost, nullptr);
}

ShapeEstimate ShapeEstimator::follow(std::span<const Sighting> sightings, const Shape& before) {
  const std::vector<Sighting> seen = prepared(sightings);
  if (!are_enough(seen)) return unseen(before);
  ShapeProblem problem(prior_, seen);
  ShapeFit fit = descent_.descend(problem, before, config_.most_iterations, StartKind::near);
  if (!is_good(fit)) {
    ShapeFit other = descent_.descend(problem, before, config_.most_iterations);
    if (is_good(other) || other.cost < fit.cost) fit = std::move(other);
    if (!problem.linearise(fit.shape)) fit.cost = std::numeric_limits<double>::infinity();
  }
  const double cost = fit.cost;
  return with_bands(seen, answer(problem, std::move(fit)), cost, nullptr);
}

ShapeEstimate ShapeEstimator::update(std::span<const Sighting> sightings, const ShapeBelief& before) {
  const std::vector<Sighting> seen = prepared(sightings);
  if (!are_enough(seen)) return unseen(before.mean);
  ShapeProblem problem(prior_, seen, {}, &before);
  ShapeFit fit = descent_.descend(problem, before.mean, config_.most_iterations, StartKind::near);
  const double cost = fit.cost;
  return with_bands(seen, answer(problem, std::move(fit)), cost, &before);
}

ShapeEstimate ShapeEstimator::with_bands(std::span<const Sighting> sightings, ShapeEstimate first,
                                         double cost, const ShapeBelief* belief) {
  const auto is_plain = [](const Sighting& seen) { return seen.bands.empty(); };
  if (!std::isfinite(cost) || first.sigma.empty() || std::ranges::all_of(sightings, is_plain)) return first;
  const std::vector<BandLook> looks =
      match_bands(prior_, first.shape, root_mean_square(first.sigma), sightings);
  if (looks.empty()) return first;
  ShapeProblem problem(prior_, sightings, looks, belief);
  ShapeFit fit = descent_.descend(problem, first.shape, config_.most_iterations, StartKind::near);
  // Of the axes: markers move the shape along where they lie on them, not away.
  constexpr double worse = 1.5, little = 1e-4;
  const bool is_worse = !(fit.cost < worse * cost + little);
  ShapeEstimate result = answer(problem, std::move(fit));
  if (is_worse || (first.is_found && !result.is_found)) {
    first.notes.emplace_back("the markers speak against the axes: they are not used");
    return first;
  }
  result.markers = placed_markers(prior_, result.shape, looks, sightings);
  return result;
}

ShapeEstimate ShapeEstimator::answer(const ShapeProblem& problem, ShapeFit fit) const {
  ShapeEstimate result;
  result.shape = fit.shape, result.covariance = fit.covariance, result.iterations = fit.iterations;
  result.rms = fit.rms, result.doubted = fit.doubted, result.scale = fit.scale;
  result.surprise = fit.surprise;
  if (!std::isfinite(fit.cost)) {
    result.reason = "no shape of the arm is seen by these cameras";
    return result;
  }
  const double length = add_sigmas(problem, fit.covariance, result);
  const double sigma = root_mean_square(result.sigma);
  if (!(sigma < config_.hopeless * length)) {
    result.reason = "the images do not tell the shape";
    return result;
  }
  if (!are_as_doubted(problem.sightings(), fit.shape)) {
    result.reason = "the cameras would have to stand otherwise by far more than is doubted";
    return result;
  }
  for (std::size_t i = 0; i < problem.sightings().size(); ++i) {
    const Sighting& seen = problem.sightings()[i];
    // Most of what one picture shows is somewhere else; of a few points that says little.
    constexpr double most_doubted = 0.6;
    constexpr std::size_t few = 8;
    const bool is_other = fit.doubted_in[i] > most_doubted && seen.points.size() + seen.borders.size() >= few;
    if (!is_other && (are_enough({&seen, 1}) || explains_border(seen, error_of(fit.shape, i), fit.shape)))
      continue;
    result.reason = fmt::format("picture {} shows something else than the arm", i + 1);
    return result;
  }
  result.is_found = fit.doubted < 0.5 && (fit.rms < config_.most_rms || fit.scale < most_scale);
  if (!result.is_found) {
    result.reason = fmt::format(
        "no shape explains the images: {:.0f} % of the points lie elsewhere, the rest {:.2f} px off",
        100 * fit.doubted, fit.rms);
  }
  constexpr double poor = 3;
  if (fit.scale > poor)
    result.notes.push_back(
        fmt::format("the images are {:.0f} times farther off than their noise explains", fit.scale));
  if (!fit.is_settled) result.notes.emplace_back("the fit did not settle");
  if (fit.doubted > 0.1)
    result.notes.push_back(fmt::format("{:.0f} % of the points are not the arm's", 100 * fit.doubted));
  if (fit.contradicted > 0)
    result.notes.push_back(fmt::format(
        "{} of the ends and markers are seen elsewhere than the shape has them", fit.contradicted));
  if (std::string doubt = doubt_of_ends(prior_, problem); !doubt.empty())
    result.notes.push_back(std::move(doubt));
  if (sigma > config_.uncertain * length)
    result.notes.push_back(fmt::format(
        "uncertain to {:.2g} m{}", sigma,
        prior_.is_length_known ? ""
                               : ", if it is this shape: of unknown length another one may fit as well"));
  return result;
}

ShapePrior unknown_arm(std::optional<Eigen::Vector3d> base, std::optional<double> length,
                       std::size_t sections) {
  ShapePrior prior;
  prior.arm.kind = ArmKind::spatial;
  prior.is_base_direction_known = false;
  prior.is_base_position_known = base.has_value();
  prior.is_length_known = length.has_value();
  if (base) prior.arm.X_WB.position = *base;
  const double whole = length.value_or(1.0);
  // No radius: borders tell nothing of it.
  prior.arm.sections.resize(sections, {.length = whole / static_cast<double>(sections), .radius = {0, 0}});
  // Of a turn a length, from one section to the next.
  prior.curvature_step = 1.0 / whole;
  return prior;
}

}  // namespace flexura
