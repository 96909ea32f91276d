#include "flexura/estimate/tube_image.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/estimate/shape_silhouette.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Distance of cross-sections in a picture, px, and their greatest number.
constexpr double section_distance = 3;
constexpr std::size_t fewest_sections = 24, most_sections = 100;

// Returns where a line of sight touches the tube at a cross-section, in camera axes relative to the backbone.
// `side`: 1 or -1. Zero if the camera looks along the tube.
Eigen::Vector3d rim_of(const Eigen::Vector3d& center, const Eigen::Vector3d& tangent, double radius,
                       double side) {
  const Eigen::Vector3d across = center - center.dot(tangent) * tangent;
  const double distance = across.norm();
  if (!(distance > 1.05 * radius)) return Eigen::Vector3d::Zero();
  const double toward = radius / distance;
  return radius * (-toward / distance * across +
                   side * std::sqrt(1 - toward * toward) * tangent.cross(across / distance));
}

}  // namespace

TubeImage::TubeImage(const ShapePrior& prior, std::span<const Observation> observations)
    : prior_(prior),
      observations_(observations),
      variables_(prior, observations),
      curve_(variables_, intervals_a_section(prior)),
      images_(observations.size()) {
  row_.resize(variables_.count());
}

bool TubeImage::set(const Shape& shape, const Eigen::MatrixXd& covariance) {
  covariance_ = covariance;
  curve_.set(shape);
  views_.clear();
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const ViewError error = error_of(shape, i);
    views_.push_back(corrected(observations_[i].view, error));
    if (!images_[i].set(observations_[i].view, error, curve_, variables_.of_view(i), variables_.count()))
      return false;
  }
  if (count_ == 0) {
    double longest = 0;
    for (const CurveImage& image : images_) {
      double length = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(image.last()); ++k)
        length +=
            (image.at(static_cast<double>(k + 1)).pixel - image.at(static_cast<double>(k)).pixel).norm();
      longest = std::max(longest, length);
    }
    count_ = std::clamp(static_cast<std::size_t>(std::min(longest / section_distance, 1e6)), fewest_sections,
                        most_sections);
  }
  set_places(shape);
  return true;
}

void TubeImage::set_places(const Shape& shape) {
  const Backbone backbone(shape.arm, shape.state);
  places_.clear();
  for (std::size_t k = 0; k < count_; ++k) {
    const double s = backbone.length() * (static_cast<double>(k) + 0.5) / static_cast<double>(count_);
    const auto arcs = backbone.arcs();
    std::size_t i = 0;
    while (i + 1 < arcs.size() && s > arcs[i].s + arcs[i].length) ++i;
    const double share = (s - arcs[i].s) / arcs[i].length;
    const Pose X_WS = arcs[i].pose(s - arcs[i].s);
    places_.push_back({X_WS.position, X_WS.rotation.col(2),
                       arcs[i].radius[0] + share * (arcs[i].radius[1] - arcs[i].radius[0]),
                       (static_cast<double>(i) + share) * static_cast<double>(curve_.intervals_a_section())});
  }
}

TubeSection TubeImage::section(const Place& place, const View& view, const CurveImage& image) {
  TubeSection result;
  const Pose X_CW = view.X_WC.inverse();
  const Eigen::Vector3d center = X_CW * place.position, tangent = X_CW.rotation * place.tangent;
  // Where the camera looks nearly along the tube, its rims are far from the backbone's cross-section.
  constexpr double least_slant = 0.25;
  if (tangent.cross(center.normalized()).norm() < least_slant) return result;
  const CurveImage::Point at = image.at(place.knot);
  result.pixel = at.pixel;
  for (std::size_t rim = 0; rim < 2; ++rim) {
    const Eigen::Vector3d off = rim_of(center, tangent, place.radius, rim == 0 ? -1 : 1);
    const double step = 0.01 * place.radius;
    const auto pixel = view.lens.project(center + off),
               before = view.lens.project(center + off - step * tangent),
               after = view.lens.project(center + off + step * tangent);
    if (off.isZero() || !pixel || !before || !after) return result;
    const Eigen::Vector2d along = (*after - *before).normalized();
    Eigen::Vector2d outward(-along.y(), along.x());
    if (outward.dot(*pixel - result.pixel) < 0) outward = -outward;
    result.expected.rims[rim] = {*pixel, outward, true};
    if (pixel->x() < 0 || pixel->y() < 0 || pixel->x() > view.width - 1 || pixel->y() > view.height - 1)
      result.expected.rims[rim].is_visible = false;
  }
  const auto& rims = result.expected.rims;
  result.normal = Eigen::Vector2d(-at.tangent.y(), at.tangent.x());
  if (result.normal.dot(rims[1].pixel - rims[0].pixel) < 0) result.normal = -result.normal;
  result.expected.width = (rims[1].pixel - rims[0].pixel).norm();
  image.along(result.normal, place.knot, row_);
  const double variance = row_ * covariance_ * row_.transpose();
  result.expected.reach = std::sqrt(std::max(variance, 0.0));
  result.is_measurable = (rims[0].is_visible || rims[1].is_visible) && result.expected.width > 2 &&
                         std::isfinite(result.expected.reach);
  return result;
}

// A rim has no edge where another part of the tube is before it or behind it.
void TubeImage::hide_overlaps(std::vector<TubeSection>& sections) {
  constexpr double margin = 3;  // px
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!sections[i].is_measurable) continue;
    double way = 0;
    for (std::size_t j = i; j + 1 < sections.size(); ++j) {
      way += (sections[j + 1].pixel - sections[j].pixel).norm();
      TubeSection &a = sections[i], &b = sections[j + 1];
      if (!b.is_measurable || way < 1.5 * std::max(a.expected.width, b.expected.width)) continue;
      for (std::size_t rim = 0; rim < 2; ++rim) {
        if ((a.expected.rims[rim].pixel - b.pixel).norm() < 0.5 * b.expected.width + margin)
          a.expected.rims[rim].is_visible = false;
        if ((b.expected.rims[rim].pixel - a.pixel).norm() < 0.5 * a.expected.width + margin)
          b.expected.rims[rim].is_visible = false;
      }
    }
  }
}

void TubeImage::sections(std::size_t i, std::vector<TubeSection>& result) {
  result.clear();
  for (const Place& place : places_) result.push_back(section(place, views_[i], images_[i]));
  hide_overlaps(result);
}

}  // namespace flexura
