#include "flexura/estimate/hidden_tip.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "flexura/estimate/shape_silhouette.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

constexpr int places = 24;           // Of the arm, compared with the tip.
constexpr double most_radii = 20.0;  // Of a hidden tip's standard deviation.

double distance_from_line(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = b - a;
  const double share = way.squaredNorm() > 0 ? (point - a).dot(way) / way.squaredNorm() : 0.0;
  return (a + std::clamp(share, 0.0, 1.0) * way - point).norm();
}

}  // namespace

void distrust_hidden_tip(const Shape& predicted, std::size_t observation, Observation& seen) {
  if (!seen.ends[1] || predicted.arm.sections.empty()) return;
  const double radius = predicted.arm.sections.back().radius[1];
  if (!(radius > 0)) return;
  const View view = corrected(seen.view, error_of(predicted, observation));
  const Backbone backbone(predicted.arm, predicted.state);
  const double length = backbone.length();
  const Eigen::Vector3d tip = backbone.pose(length).position;
  const std::optional<Eigen::Vector2d> image = view.project(tip);
  const double depth = (view.X_WC.inverse() * tip).z();
  if (!image || !(depth > 0)) return;
  const double radius_px = view.lens.intrinsics().fx * radius / depth;
  // Parts of the arm nearer to the tip than its diameter always lie beside it in the picture.
  const double last = length - 2 * radius;
  double distance = radius_px;
  std::optional<Eigen::Vector2d> before;
  for (int k = 0; k < places && last > 0; ++k) {
    const auto pixel = view.project(backbone.pose(last * k / (places - 1)).position);
    if (pixel) distance = std::min(distance, distance_from_line(*image, before ? *before : *pixel, *pixel));
    before = pixel;
  }
  const double hidden = 1 - distance / radius_px;
  const double doubt = radius_px * std::min(most_radii, hidden / (1 - hidden + 1 / most_radii));
  seen.ends[1]->sigma = std::hypot(seen.ends[1]->sigma, doubt);
}

}  // namespace flexura
