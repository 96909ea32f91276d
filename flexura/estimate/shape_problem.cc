#include "flexura/estimate/shape_problem.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/estimate/shape_silhouette.h"
#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Unit direction of the points at point i.
Eigen::Vector2d heading(const Observation& seen, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, seen.points.size() - 1);
  return (seen.points[after].pixel - seen.points[before].pixel).normalized();
}

}  // namespace

ShapeProblem::ShapeProblem(const ShapePrior& prior, std::span<const Observation> observations,
                           std::vector<BandObservation> band_observations, const ShapePrediction* prediction)
    : prior_(prior),
      variables_(prior, observations),
      observations_(observations),
      band_observations_(std::move(band_observations)),
      curve_(variables_, intervals_a_section(prior)) {
  std::size_t rows = 2 * prior.arm.sections.size() + band_observations_.size();
  for (const BandObservation& band_observation : band_observations_)
    if (band_observation.marker >= first_observations_.size())
      first_observations_.resize(band_observation.marker + 1);
  for (const Observation& seen : observations)
    rows += seen.points.size() + seen.borders.size() + 2 + 2 * seen.markers.size() + 4;
  if (prediction != nullptr && prediction->covariance.cols() == variables_.count() &&
      prediction->covariance.allFinite()) {
    const Cholesky known(prediction->covariance);
    const Eigen::Index count = variables_.count();
    if (known.is_definite()) {
      predicted_ = prediction->mean, is_filtered_ = !prediction->is_guess;
      // Any root of the inverse works: here that of L L^T.
      prediction_ = known.solve_lower(Eigen::MatrixXd::Identity(count, count));
      rows += static_cast<std::size_t>(count);
    }
  }
  residuals_.resize(static_cast<Eigen::Index>(rows));
  derivatives_.resize(static_cast<Eigen::Index>(rows), variables_.count());
  kinds_.resize(rows);
  sigmas_.resize(rows);
  of_observation_.resize(rows);
  row_.resize(variables_.count());
}

bool ShapeProblem::linearise(const Shape& shape) {
  count_ = 0;
  curve_.set(shape);
  for (FirstObservation& band_observation : first_observations_) band_observation.is_there = false;
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const Observation& seen = observations_[i];
    const ViewError error = error_of(shape, i);
    if (!image_.set(seen.view, error, curve_, variables_.of_view(i), variables_.count())) return false;
    const auto first = static_cast<std::ptrdiff_t>(count_);
    add_points(seen);
    add_borders(seen, shape.arm);
    add_ends(seen);
    add_markers(seen, shape.arm);
    add_bands(i, shape.arm);
    std::fill(of_observation_.begin() + first, of_observation_.begin() + static_cast<std::ptrdiff_t>(count_),
              i);
    if (seen.view_prior.is_any() && !predicted_) add_view_prior(i, error);
  }
  if (std::isfinite(prior_.curvature_step)) add_prior(shape);
  if (predicted_) add_prediction(shape);
  return residuals_.head(count_).allFinite() && derivatives_.topRows(count_).allFinite();
}

void ShapeProblem::add_row(RowKind kind, const Eigen::Vector2d& direction, const Eigen::Vector2d& off,
                           double place, double sigma) {
  image_.along(direction / -sigma, place, derivatives_.row(count_));
  residuals_[count_] = direction.dot(off) / sigma;
  kinds_[static_cast<std::size_t>(count_)] = kind;
  sigmas_[static_cast<std::size_t>(count_)] = sigma;
  ++count_;
}

// Points follow each other along the curve, so each is searched a little way on from the previous one. Where
// the curve's image crosses itself, the nearest point may be on the wrong branch.
void ShapeProblem::add_points(const Observation& seen) {
  const auto knots = static_cast<std::size_t>(image_.last());
  const std::size_t back = 1 + knots / 16, ahead = 2 + knots / 6;
  CurveImage::Window window{0, seen.ends[0] ? ahead : knots, 0};
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const CurvePoint& point = seen.points[i];
    const CurveImage::Point near = image_.nearest(point.pixel, heading(seen, i), window);
    const auto at = static_cast<std::size_t>(near.place);
    window = {at > back ? at - back : 0, at + ahead, at};
    const Eigen::Vector2d off = point.pixel - near.pixel;
    Eigen::Vector2d direction(-near.tangent.y(), near.tangent.x());
    // Beyond the curve's end, the direction is towards the end.
    const bool is_beyond = near.place <= 0 || near.place >= image_.last();
    if (is_beyond && off.squaredNorm() > 0) direction = off.normalized();
    add_row(RowKind::point, direction, off, near.place, point.sigma);
  }
}

// A tube's silhouette is about its radius away from its backbone's image. Beyond the curve's ends caps are
// visible, at the same distance.
void ShapeProblem::add_borders(const Observation& seen, const Arm& arm) {
  for (const SeenBorder& border : seen.borders) {
    const CurveImage::Point near = image_.nearest(border.pixel, Eigen::Vector2d::Zero(), image_.everywhere());
    const auto section = std::min(static_cast<std::size_t>(near.place) / curve_.intervals_a_section(),
                                  arm.sections.size() - 1);
    const auto [at_base, at_end] = arm.sections[section].radius;
    const double share =
        near.place / static_cast<double>(curve_.intervals_a_section()) - static_cast<double>(section);
    const Eigen::Vector2d off = border.pixel - near.pixel;
    const double distance = off.norm(), radius = (at_base + share * (at_end - at_base)) * near.scale;
    const bool is_beyond = near.place <= 0 || near.place >= image_.last();
    if (!(distance > 0) || !(radius > 0) || (is_beyond && distance < radius)) continue;
    add_row(RowKind::border, off / distance, off * (1 - radius / distance), near.place, border.sigma);
  }
}

void ShapeProblem::add_ends(const Observation& seen) {
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    if (!seen.ends[end]) continue;
    const CurveImage::Point there = image_.at(end == 0 ? 0 : image_.last());
    add_row(RowKind::end, there.tangent, seen.ends[end]->pixel - there.pixel, there.place,
            seen.ends[end]->sigma);
  }
}

void ShapeProblem::add_markers(const Observation& seen, const Arm& arm) {
  for (const SeenMarker& marker : seen.markers) {
    const CurveImage::Point there = image_.at(curve_.place_of(arm, marker.s));
    for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)})
      add_row(RowKind::marker, axis, marker.pixel - there.pixel, there.place, marker.sigma);
  }
}

void ShapeProblem::add_bands(std::size_t observation, const Arm& arm) {
  for (const BandObservation& band_observation : band_observations_) {
    if (band_observation.observation != observation) continue;
    const SeenBand& band = observations_[observation].bands[band_observation.band];
    if (band_observation.s) {
      const CurveImage::Point there = image_.at(curve_.place_of(arm, *band_observation.s));
      add_row(RowKind::marker, there.tangent, band.pixel - there.pixel, there.place, band.sigma);
      continue;
    }
    const CurveImage::Point near = image_.nearest(band.pixel, band.heading, image_.everywhere());
    const double place = near.place + near.tangent.dot(band.pixel - near.pixel) / near.speed,
                 sigma = band.sigma / near.speed;
    // The observed position along the curve moves opposite to the curve's point.
    image_.along(near.tangent / -near.speed, near.place, row_);
    FirstObservation& first = first_observations_[band_observation.marker];
    if (!first.is_there) {
      first.is_there = true, first.place = place, first.sigma = sigma, first.unknowns = row_;
      continue;
    }
    const double both = std::hypot(sigma, first.sigma);
    residuals_[count_] = (place - first.place) / both;
    derivatives_.row(count_) = (row_ - first.unknowns) / both;
    kinds_[static_cast<std::size_t>(count_)] = RowKind::marker;
    sigmas_[static_cast<std::size_t>(count_)] = both;
    ++count_;
  }
}

// Prior of a view's error.
void ShapeProblem::add_view_prior(std::size_t observation, const ViewError& error) {
  // Replaces 0: a thousandth of a pixel at the border of a picture of a thousand.
  constexpr double least = 1e-6;
  const ViewPrior& view_prior = observations_[observation].view_prior;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double sigma = std::max(k < 3 ? view_prior.rotation_std : view_prior.focal_std, least);
    residuals_[count_] = (k < 3 ? error.turn[k] : error.focal) / sigma;
    derivatives_.row(count_).setZero();
    derivatives_(count_, variables_.of_view(observation) + k) = 1 / sigma;
    kinds_[static_cast<std::size_t>(count_)] = RowKind::prior;
    sigmas_[static_cast<std::size_t>(count_)] = 1;
    ++count_;
  }
}

void ShapeProblem::add_prediction(const Shape& shape) {
  const Eigen::Index count = variables_.count();
  residuals_.segment(count_, count) = prediction_ * variables_.minus(shape, *predicted_);
  derivatives_.middleRows(count_, count) = prediction_;
  for (Eigen::Index k = 0; k < count; ++k, ++count_) {
    kinds_[static_cast<std::size_t>(count_)] = RowKind::prediction;
    sigmas_[static_cast<std::size_t>(count_)] = 1;
  }
}

// Neighbouring sections bend alike.
void ShapeProblem::add_prior(const Shape& shape) {
  const Eigen::Index bends = variables_.bends_a_section();
  for (std::size_t i = 0; i + 1 < shape.arm.sections.size(); ++i) {
    const double here = 1 / (shape.arm.sections[i].length * prior_.curvature_step),
                 next = 1 / (shape.arm.sections[i + 1].length * prior_.curvature_step);
    for (Eigen::Index k = 0; k < bends; ++k) {
      residuals_[count_] = next * shape.state.bends[i + 1][k] - here * shape.state.bends[i][k];
      derivatives_.row(count_).setZero();
      derivatives_(count_, static_cast<Eigen::Index>(i) * bends + k) = -here;
      derivatives_(count_, static_cast<Eigen::Index>(i + 1) * bends + k) = next;
      kinds_[static_cast<std::size_t>(count_)] = RowKind::prior;
      sigmas_[static_cast<std::size_t>(count_)] = 1;
      ++count_;
    }
  }
}

}  // namespace flexura
