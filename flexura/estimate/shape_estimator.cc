#include "flexura/estimate/shape_estimator.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "flexura/base/bounded_text.h"
#include "flexura/base/degree.h"
#include "flexura/estimate/axis_beginning.h"
#include "flexura/estimate/band_match.h"
#include "flexura/estimate/hidden_tip.h"
#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/section_groups.h"
#include "flexura/estimate/shape_search.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/shape_start.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Orders the observation so that the end nearer to the base's image comes first.
Observation from_base(Observation seen, const Eigen::Vector3d& p_WB) {
  const auto base = seen.view.project(p_WB);
  if (!base || seen.points.empty()) return seen;
  const bool is_reversed =
      (seen.points.back().pixel - *base).norm() < (seen.points.front().pixel - *base).norm();
  return is_reversed ? reversed(std::move(seen)) : seen;
}

bool have_axes(std::span<const Observation> observations) {
  return std::ranges::all_of(observations, [](const Observation& seen) { return are_enough({&seen, 1}); });
}

// Fills in the knots' positions and their standard deviations; returns the arm's length.
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

// Returns why the arm may begin or end elsewhere on the same curve; "" if two of base, tip, length and marker
// positions are known. Otherwise an axis that stops short pulls the shape's end to its last point. The rows
// across that end would then determine its position along the curve, to a hundredth of a pixel.
std::string warning_about_ends(const ShapePrior& prior, const ShapeProblem& problem) {
  std::set<double> places;  // Of known markers, m.
  std::array<bool, 2> is_seen = {};
  for (const Observation& seen : problem.observations()) {
    for (std::size_t end = 0; end < 2; ++end) is_seen[end] = is_seen[end] || seen.ends[end].has_value();
    for (const SeenMarker& marker : seen.markers) places.insert(marker.s);
  }
  for (const BandObservation& band_observation : problem.band_observations())
    if (band_observation.s) places.insert(*band_observation.s);
  const bool has_base = prior.is_base_position_known || is_seen[0], has_tip = is_seen[1];
  const std::size_t determined =
      places.size() + (has_base ? 1 : 0) + (has_tip ? 1 : 0) + (prior.is_length_known ? 1 : 0);
  if (determined >= 2) return "";
  const char* what = "either end";
  if (has_base) what = "the tip";
  if (has_tip) what = "the base";
  return fmt::format("no picture shows {} of the arm, so the arm may be longer than what is visible", what);
}

// Adds notes on pictures that differ from the shape by more than the arm's disks and rings, or slightly wrong
// cameras, explain.
void add_misfit(std::span<const Observation> observations, ShapeEstimate& result) {
  constexpr double little = 0.01;  // px^2
  constexpr double with_disks = 2;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const double square = misfit(observations[i], error_of(result.shape, i), result.shape, with_disks);
    if (square > little + result.rms * result.rms)
      result.notes.push_back(
          fmt::format("parts of the foreground of picture {} do not agree with this shape: they may be "
                      "another object, or the shape is wrong",
                      i + 1));
  }
}

// Adds notes on pictures in which an arm without a kinematic model begins beside its base: the given base or
// camera is wrong. Such an arm adapts to any base, and nothing else would show the error.
void add_base_aside(const ShapePrior& prior, std::span<const Observation> observations,
                    ShapeEstimate& result) {
  constexpr double most = 0.5, sigmas = 5;  // px, plus this many standard deviations
  if (!prior.is_base_position_known || prior.is_base_direction_known) return;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const auto base =
        corrected(observations[i].view, error_of(result.shape, i)).project(prior.arm.X_WB.position);
    if (!base || !observations[i].ends[0]) continue;
    const auto aside = aside_of_beginning(observations[i], *base);
    if (aside && aside->distance > most + sigmas * aside->sigma)
      result.notes.push_back(
          fmt::format("in picture {}, the arm begins {:.2g} px from the image of its base: are the base's "
                      "position and the camera's description right?",
                      i + 1, aside->distance));
  }
}

// Returns why no arm has the shape: a section bent by more than a full turn intersects itself. "" if none
// does.
std::string bent_beyond_arms(const Shape& shape) {
  constexpr double most_bend = 2 * std::numbers::pi;
  const auto& bends = shape.state.bends;
  const auto most =
      std::ranges::max_element(bends, {}, [](const Eigen::Vector2d& bend) { return bend.norm(); });
  if (most->norm() <= most_bend) return "";
  return fmt::format(
      "no shape of this arm explains the pictures: section {} would have to bend by more than a full turn. "
      "Expected an arm and cameras that agree with their descriptions, and pictures that show most of this "
      "section",
      most - bends.begin() + 1);
}

// Returns whether the fit is good enough to give information on the cameras.
bool indicates_cameras(const ShapeFit& fit) {
  constexpr double max_outlier_share = 0.1;
  return fit.outlier_share < max_outlier_share && fit.scale < ShapeFit::most_scale;
}

std::string elsewhere(std::size_t picture, const ViewError& error) {
  return fmt::format(
      "picture {} fits only if its camera is rotated by {} degrees and its focal length is {} % {}, far more "
      "than its prior allows",
      picture + 1, bounded_text(error.turn.norm() / degree, 180),
      bounded_text(100 * std::abs(std::expm1(error.focal)), 100, 3), error.focal < 0 ? "shorter" : "longer");
}

// Returns the first picture in which most points are outliers; a few points do not count.
std::optional<std::size_t> picture_of_another(std::span<const Observation> observations,
                                              const ShapeFit& fit) {
  constexpr double max_outlier_share = 0.6;
  constexpr std::size_t few = 8;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& seen = observations[i];
    const bool is_other =
        fit.outlier_share_in[i] > max_outlier_share && seen.points.size() + seen.borders.size() >= few;
    const bool determines =
        are_enough({&seen, 1}) || explains_border(seen, error_of(fit.shape, i), fit.shape);
    if (is_other || !determines) return i;
  }
  return std::nullopt;
}

void add_fit_warnings(const ShapeFit& fit, ShapeEstimate& result) {
  constexpr double poor = 3, max_outlier_share = 0.1;
  if (fit.scale > poor)
    result.notes.push_back(fmt::format("the residuals in the images are {} times their noise",
                                       bounded_text(std::round(fit.scale), 1000, 4)));
  if (!fit.is_settled) result.notes.emplace_back("the fit did not converge");
  if (fit.outlier_share > max_outlier_share)
    result.notes.push_back(
        fmt::format("{:.0f} % of the points do not belong to the arm", 100 * fit.outlier_share));
  if (fit.contradicted > 0)
    result.notes.push_back(fmt::format(
        "{} of the ends and markers were observed at positions that do not fit the shape", fit.contradicted));
}

ShapeEstimate unseen(Shape shape) {
  ShapeEstimate none;
  none.shape = std::move(shape);
  none.reason = "the arm is not visible in every image";
  return none;
}

// Pictures do not show each of many short sections, and each try costs more with more unknowns: groups of
// sections are searched, and then all sections are fitted from there.
ShapeSearch::Result searched(const ShapePrior& prior, const EstimatorConfig& config, ShapeDescent& descent,
                             const std::vector<Observation>& observations) {
  constexpr std::size_t many = 40, few = 30;
  if (prior.arm.sections.size() <= many)
    return ShapeSearch(prior, config.most_iterations, config.most_rms, descent).best(observations);
  const ShapePrior grouped = with_grouped_sections(prior, few);
  ShapeSearch::Result result =
      ShapeSearch(grouped, config.most_iterations, config.most_rms, descent).best(observations);
  const Shape start = without_groups(prior, result.fit.shape, few);
  if (std::isfinite(result.fit.cost)) {
    ShapeProblem problem(prior, result.seen);
    result.fit = descent.descend(problem, start, config.most_iterations, StartKind::near);
  } else {
    result.fit.shape = start;
  }
  return result;
}

}  // namespace

double ShapeEstimate::rms_sigma() const {
  double squares = 0;
  for (const double one : sigma) squares += one * one / static_cast<double>(sigma.size());
  return std::sqrt(squares);
}

ShapeEstimator::ShapeEstimator(ShapePrior prior, EstimatorConfig config)
    : prior_(std::move(prior)), config_(config) {}

std::vector<Observation> ShapeEstimator::prepared(std::span<const Observation> observations) const {
  std::vector<Observation> result;
  result.reserve(observations.size());
  for (const Observation& seen : observations) {
    const auto is_none = [](const auto& point) {
      return !point.pixel.allFinite() || !(point.sigma > 0) || !std::isfinite(point.sigma);
    };
    Observation whole = seen;
    std::erase_if(whole.points, is_none), std::erase_if(whole.borders, is_none);
    std::erase_if(whole.points, [](const CurvePoint& point) { return !(std::abs(point.offset) < 1e6); });
    if (!(whole.reach.offset > 0)) whole.reach.offset = ErrorReach{}.offset;
    std::erase_if(whole.markers, is_none), std::erase_if(whole.bands, is_none);
    for (auto& end : whole.ends)
      if (end && is_none(*end)) end.reset();
    Observation thin = thinned(std::move(whole), config_.most_points);
    // Borders give no information on an arm without a radius.
    const auto has_radius = [](const Section& section) {
      return section.radius[0] > 0 || section.radius[1] > 0;
    };
    if (!std::ranges::any_of(prior_.arm.sections, has_radius)) thin.borders.clear();
    if (prior_.is_base_position_known) thin = from_base(std::move(thin), prior_.arm.X_WB.position);
    result.push_back(std::move(thin));
  }
  return result;
}

ShapeEstimate ShapeEstimator::estimate(std::span<const Observation> observations) {
  std::vector<Observation> prepared_ones = prepared(observations);
  if (prepared_ones.empty() || !have_axes(prepared_ones)) return unseen(straight_shape(prior_));
  auto [fit, seen, apart] = searched(prior_, config_, descent_, prepared_ones);
  ShapeProblem problem(prior_, seen);
  if (!problem.linearise(fit.shape)) fit.cost = std::numeric_limits<double>::infinity();
  const double cost = fit.cost;
  ShapeEstimate result = with_bands(seen, answer(problem, std::move(fit)), cost, nullptr);
  if (result.is_found) add_misfit(seen, result);
  constexpr double another = 0.01;  // Of its length: nearer ones are the same shape.
  if (result.is_found && apart > another * Backbone(result.shape.arm, result.shape.state).length()) {
    result.is_found = false;
    result.reason =
        fmt::format("two different shapes explain the images; they are up to {:.2g} m apart", apart);
  }
  return result;
}

ShapeEstimate ShapeEstimator::follow(std::span<const Observation> observations, const Shape& before) {
  const std::vector<Observation> seen = prepared(observations);
  if (!are_enough(seen)) return unseen(before);
  ShapeProblem problem(prior_, seen);
  ShapeFit fit = descent_.descend(problem, before, config_.most_iterations, StartKind::near);
  if (!fit.is_good(config_.most_rms)) {
    ShapeFit other = descent_.descend(problem, before, config_.most_iterations);
    if (other.is_good(config_.most_rms) || other.cost < fit.cost) fit = std::move(other);
    if (!problem.linearise(fit.shape)) fit.cost = std::numeric_limits<double>::infinity();
  }
  const double cost = fit.cost;
  return with_bands(seen, answer(problem, std::move(fit)), cost, nullptr);
}

ShapeEstimate ShapeEstimator::update(std::span<const Observation> observations,
                                     const ShapePrediction& before) {
  std::vector<Observation> seen = prepared(observations);
  if (!are_enough(seen)) return unseen(before.mean);
  for (std::size_t i = 0; i < seen.size(); ++i) distrust_hidden_tip(before.mean, i, seen[i]);
  ShapeProblem problem(prior_, seen, {}, &before);
  ShapeFit fit = descent_.descend(problem, before.mean, config_.most_iterations, StartKind::near);
  const double cost = fit.cost;
  return with_bands(seen, answer(problem, std::move(fit)), cost, &before);
}

ShapeEstimate ShapeEstimator::with_bands(std::span<const Observation> observations, ShapeEstimate first,
                                         double cost, const ShapePrediction* prediction) {
  const auto is_plain = [](const Observation& seen) { return seen.bands.empty(); };
  if (!std::isfinite(cost) || first.sigma.empty() || std::ranges::all_of(observations, is_plain))
    return first;
  const std::vector<BandObservation> band_observations =
      match_bands(prior_, first.shape, first.rms_sigma(), observations);
  if (band_observations.empty()) return first;
  ShapeProblem problem(prior_, observations, band_observations, prediction);
  ShapeFit fit = descent_.descend(problem, first.shape, config_.most_iterations, StartKind::near);
  // Of the axes: markers may shift the shape along itself but not off the axes.
  constexpr double worse = 1.5, little = 1e-4;
  const bool is_worse = !(fit.cost < worse * cost + little);
  ShapeEstimate result = answer(problem, std::move(fit));
  if (is_worse || (first.is_found && !result.is_found)) {
    first.notes.emplace_back("the markers contradict the axes and are not used");
    return first;
  }
  result.markers = placed_markers(prior_, result.shape, band_observations, observations);
  return result;
}

ShapeEstimate ShapeEstimator::answer(const ShapeProblem& problem, ShapeFit fit) const {
  ShapeEstimate result;
  result.shape = fit.shape, result.covariance = fit.covariance, result.iterations = fit.iterations;
  result.rms = fit.rms, result.outlier_share = fit.outlier_share, result.scale = fit.scale;
  result.innovation = fit.innovation;
  if (!std::isfinite(fit.cost)) {
    result.reason =
        "no shape of the arm explains the pictures: the lines of sight do not meet in front of all cameras";
    const auto lacks_rays = [](const Observation& seen) { return !shows_all(seen.view); };
    const auto seen = problem.observations();
    if (const auto found = std::ranges::find_if(seen, lacks_rays); found != seen.end())
      result.reason += fmt::format(
          ", or within the part of picture {} for which its lens has rays: is its description of the "
          "distortion right?",
          found - seen.begin() + 1);
    return result;
  }
  const double length = add_sigmas(problem, fit.covariance, result);
  const double sigma = result.rms_sigma();
  constexpr double unrecoverable = 0.05;
  if (!(sigma < unrecoverable * length)) {
    result.reason = "the shape is not observable in the images";
    return result;
  }
  if (std::string reason = bent_beyond_arms(fit.shape); !reason.empty()) {
    result.reason = std::move(reason);
    return result;
  }
  if (const auto view = view_elsewhere(problem.observations(), fit.shape)) {
    result.is_elsewhere = indicates_cameras(fit);
    result.reason = result.is_elsewhere ? elsewhere(*view, fit.shape.views[*view])
                                        : "the pictures require camera errors far beyond their priors";
    return result;
  }
  if (const auto picture = picture_of_another(problem.observations(), fit)) {
    result.reason = fmt::format("picture {} shows another object than the arm", *picture + 1);
    return result;
  }
  result.is_found =
      fit.outlier_share < 0.5 && (fit.rms < config_.most_rms || fit.scale < ShapeFit::most_scale);
  if (!result.is_found) {
    result.reason = fmt::format(
        "no shape explains the images: {:.0f} % of the points are outliers, and the residual of the others "
        "is {} px",
        100 * fit.outlier_share, fit.rms < 100 ? fmt::format("{:.2f}", fit.rms) : bounded_text(fit.rms, 100));
  }
  add_fit_warnings(fit, result);
  if (const auto section = bent_too_far(fit.shape))
    result.notes.push_back(fmt::format("section {} would be bent by {:.0f} degrees: its limit is {:.0f}",
                                       *section + 1, fit.shape.state.bends[*section].norm() / degree,
                                       fit.shape.arm.sections[*section].max_bend / degree));
  add_base_aside(prior_, problem.observations(), result);
  if (std::string warning = warning_about_ends(prior_, problem); !warning.empty())
    result.notes.push_back(std::move(warning));
  if (sigma > config_.uncertain * length)
    result.notes.push_back(fmt::format(
        "the standard deviation of the shape is {} m{}", bounded_text(sigma, length),
        prior_.is_length_known
            ? ""
            : ", if it is the right shape: because the length is unknown, another shape may also fit"));
  return result;
}

ShapePrior described_arm(const Arm& arm) {
  ShapePrior prior;
  prior.arm = arm;
  prior.is_length_known = std::ranges::none_of(arm.sections, &Section::can_stretch);
  // The pictures do not determine each of many short bends. A random walk of the curvature, with steps far
  // larger than those of most arms, keeps neighbours from bending against each other.
  constexpr std::size_t few = 12;
  constexpr double step = 10, sections = 30;  // rad per length, for this number of sections.
  const std::size_t count = arm.sections.size();
  if (count > few)
    prior.curvature_step = step / arm.length() * std::sqrt(sections / static_cast<double>(count));
  return prior;
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
  // Without a radius: borders are not used.
  prior.arm.sections.resize(sections, {.length = whole / static_cast<double>(sections), .radius = {0, 0}});
  // A radian per length, from one section to the next.
  prior.curvature_step = 1.0 / whole;
  return prior;
}

}  // namespace flexura
