#include "flexura/estimate/shape_start.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Points joined by lines, by the share of the length.
class Polyline {
 public:
  explicit Polyline(std::span<const Eigen::Vector3d> points) : points_(points) {
    for (std::size_t i = 0; i < points.size(); ++i)
      way_.push_back(i == 0 ? 0.0 : way_.back() + (points[i] - points[i - 1]).norm());
    if (points.size() < 2 || !(way_.back() > 0))
      throw std::invalid_argument("a shape along points needs at least two different points");
  }
  [[nodiscard]] double length() const { return way_.back(); }
  [[nodiscard]] Eigen::Vector3d at(double share) const {
    const double way = std::clamp(share, 0.0, 1.0) * length();
    const auto next = std::ranges::lower_bound(way_, way);
    const auto i = std::clamp<std::ptrdiff_t>(next - way_.begin(), 1, std::ssize(way_) - 1);
    const auto after = static_cast<std::size_t>(i);
    const double piece = way_[after] - way_[after - 1];
    const double f = piece > 0 ? (way - way_[after - 1]) / piece : 0.0;
    return points_[after - 1] + f * (points_[after] - points_[after - 1]);
  }
  [[nodiscard]] Eigen::Vector3d direction(double share, double reach) const {
    return at(share + reach) - at(share - reach);
  }

 private:
  std::span<const Eigen::Vector3d> points_;
  std::vector<double> way_;
};

Eigen::Vector2d bend_to(const Eigen::Vector3d& tangent, ArmKind kind) {
  if (kind == ArmKind::planar) return {std::atan2(tangent.x(), tangent.z()), 0};
  const double across = tangent.head<2>().norm();
  if (!(across > 0)) return Eigen::Vector2d::Zero();
  return std::atan2(across, tangent.z()) / across * tangent.head<2>();
}

}  // namespace

Shape straight_shape(const ShapePrior& prior) {
  return {prior.arm, ArmState::straight(prior.arm.sections.size())};
}

Shape shape_along(const ShapePrior& prior, std::span<const Eigen::Vector3d> points) {
  const Polyline line(points);
  Shape shape = straight_shape(prior);
  const double length = prior.arm.length();
  // If an arm of known length is cut in a picture, the points cover a part of it: it is extended straight.
  constexpr double cut = 0.95;
  const bool is_cut = prior.is_length_known && line.length() < cut * length;
  const double whole = is_cut ? line.length() : length;
  double shortest = length;
  for (const Section& section : prior.arm.sections) shortest = std::min(shortest, section.length);
  const double reach = std::max(0.03, 0.2 * shortest / length);
  if (!prior.is_base_position_known) shape.arm.X_WB.position = line.at(0);
  if (!prior.is_base_direction_known) shape.arm.X_WB.rotation = rotation_from_z(line.direction(0, reach));
  Eigen::Matrix3d R_WS = shape.arm.X_WB.rotation;
  double s = 0;
  for (std::size_t i = 0; i < prior.arm.sections.size(); ++i) {
    s += prior.arm.sections[i].length;
    const Eigen::Vector2d bend = bend_to(
        R_WS.transpose() * line.direction(std::min(s / whole, 1.0), reach).normalized(), prior.arm.kind);
    shape.state.bends[i] = bend;
    if (!prior.is_length_known) shape.state.stretches[i] = line.length() / length;
    R_WS *= arc_pose(bend, prior.arm.sections[i].length).rotation;
  }
  return shape;
}

std::vector<Shape> bent_otherwise(const Shape& shape, std::size_t section, double bend, int ways) {
  std::vector<Shape> shapes;
  const bool is_planar = shape.arm.kind == ArmKind::planar;
  const int count = is_planar ? std::min(2, ways) : ways;
  for (int k = 0; k < count; ++k) {
    const double way = 2 * std::numbers::pi * k / count;
    shapes.push_back(shape);
    shapes.back().state.bends[section] = {bend * std::cos(way), is_planar ? 0 : bend * std::sin(way)};
  }
  return shapes;
}

Shape mirrored(const ShapePrior& prior, const Shape& shape, std::size_t section, const View& view) {
  const Backbone backbone(shape.arm, shape.state);
  double s = 0;
  for (std::size_t i = 0; i < section; ++i) s += shape.arm.sections[i].length * shape.state.stretches[i];
  const Eigen::Vector3d joint = backbone.pose(std::min(s, backbone.length())).position,
                        sight = (joint - view.X_WC.position).normalized();
  constexpr int count = 60;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= count; ++k) {
    const double at = backbone.length() * k / count;
    Eigen::Vector3d p = backbone.pose(std::min(at, backbone.length())).position;
    if (at > s) p -= 2 * sight.dot(p - joint) * sight;
    points.push_back(p);
  }
  Shape result = shape_along(prior, points);
  result.views = shape.views;
  return result;
}

}  // namespace flexura
