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
Eigen::Vector2d heading(const Sighting& seen, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, seen.points.size() - 1);
  return (seen.points[after].pixel - seen.points[before].pixel).normalized();
}

}  // namespace

ShapeProblem::ShapeProblem(const ShapePrior& prior, std::span<const Sighting> sightings,
                           std::vector<BandLook> looks, const ShapeBelief* belief)
    : prior_(prior),
      variables_(prior, sightings),
      sightings_(sightings),
      looks_(std::move(looks)),
      curve_(variables_, intervals_a_section(prior)) {
  std::size_t rows = 2 * prior.arm.sections.size() + looks_.size();
  for (const BandLook& look : looks_)
    if (look.marker >= first_looks_.size()) first_looks_.resize(look.marker + 1);
  for (const Sighting& seen : sightings)
    rows += seen.points.size() + seen.borders.size() + 2 + 2 * seen.markers.size() + 4;
  if (belief != nullptr && belief->covariance.cols() == variables_.count() &&
      belief->covariance.allFinite()) {
    const Cholesky known(belief->covariance);
    const Eigen::Index count = variables_.count();
    if (known.is_definite()) {
      believed_ = belief->mean;
      // Any root of the inverse works: here that of L L^T.
      belief_ = known.solve_lower(Eigen::MatrixXd::Identity(count, count));
      rows += static_cast<std::size_t>(count);
    }
  }
  residuals_.resize(static_cast<Eigen::Index>(rows));
  derivatives_.resize(static_cast<Eigen::Index>(rows), variables_.count());
  kinds_.resize(rows);
  sigmas_.resize(rows);
  of_sighting_.resize(rows);
  row_.resize(variables_.count());
}

bool ShapeProblem::linearise(const Shape& shape) {
  count_ = 0;
  curve_.set(shape);
  for (FirstLook& look : first_looks_) look.is_there = false;
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const Sighting& seen = sightings_[i];
    const ViewError error = error_of(shape, i);
    if (!image_.set(seen.view, error, curve_, variables_.of_view(i), variables_.count())) return false;
    const auto first = static_cast<std::ptrdiff_t>(count_);
    add_points(seen);
    add_borders(seen, shape.arm);
    add_ends(seen);
    add_markers(seen, shape.arm);
    add_bands(i, shape.arm);
    std::fill(of_sighting_.begin() + first, of_sighting_.begin() + static_cast<std::ptrdiff_t>(count_), i);
    if (seen.doubt.is_any() && !believed_) add_doubt(i, error);
  }
  if (std::isfinite(prior_.curvature_step)) add_prior(shape);
  if (believed_) add_belief(shape);
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
void ShapeProblem::add_points(const Sighting& seen) {
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
void ShapeProblem::add_borders(const Sighting& seen, const Arm& arm) {
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

void ShapeProblem::add_ends(const Sighting& seen) {
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    if (!seen.ends[end]) continue;
    const CurveImage::Point there = image_.at(end == 0 ? 0 : image_.last());
    add_row(RowKind::end, there.tangent, seen.ends[end]->pixel - there.pixel, there.place,
            seen.ends[end]->sigma);
  }
}

void ShapeProblem::add_markers(const Sighting& seen, const Arm& arm) {
  for (const SeenMarker& marker : seen.markers) {
    const CurveImage::Point there = image_.at(curve_.place_of(arm, marker.s));
    for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)})
      add_row(RowKind::marker, axis, marker.pixel - there.pixel, there.place, marker.sigma);
  }
}

void ShapeProblem::add_bands(std::size_t sighting, const Arm& arm) {
  for (const BandLook& look : looks_) {
    if (look.sighting != sighting) continue;
    const SeenBand& band = sightings_[sighting].bands[look.band];
    if (look.s) {
      const CurveImage::Point there = image_.at(curve_.place_of(arm, *look.s));
      add_row(RowKind::marker, there.tangent, band.pixel - there.pixel, there.place, band.sigma);
      continue;
    }
    const CurveImage::Point near = image_.nearest(band.pixel, band.heading, image_.everywhere());
    const double place = near.place + near.tangent.dot(band.pixel - near.pixel) / near.speed,
                 sigma = band.sigma / near.speed;
    // The observed position along the curve moves opposite to the curve's point.
    image_.along(near.tangent / -near.speed, near.place, row_);
    FirstLook& first = first_looks_[look.marker];
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
void ShapeProblem::add_doubt(std::size_t sighting, const ViewError& error) {
  // Replaces 0: a thousandth of a pixel at the border of a picture of a thousand.
  constexpr double least = 1e-6;
  const ViewDoubt& doubt = sightings_[sighting].doubt;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double sigma = std::max(k < 3 ? doubt.rotation_std : doubt.focal_std, least);
    residuals_[count_] = (k < 3 ? error.turn[k] : error.focal) / sigma;
    derivatives_.row(count_).setZero();
    derivatives_(count_, variables_.of_view(sighting) + k) = 1 / sigma;
    kinds_[static_cast<std::size_t>(count_)] = RowKind::prior;
    sigmas_[static_cast<std::size_t>(count_)] = 1;
    ++count_;
  }
}

void ShapeProblem::add_belief(const Shape& shape) {
  const Eigen::Index count = variables_.count();
  residuals_.segment(count_, count) = belief_ * variables_.minus(shape, *believed_);
  derivatives_.middleRows(count_, count) = belief_;
  for (Eigen::Index k = 0; k < count; ++k, ++count_) {
    kinds_[static_cast<std::size_t>(count_)] = RowKind::belief;
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
