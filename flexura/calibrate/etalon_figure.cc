#include "flexura/calibrate/etalon_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "flexura/math/arrays.h"

namespace flexura {
namespace {

constexpr double quarter = std::numbers::pi / 2;
constexpr std::size_t red_lines = 4;

// Unit vector away from the axis, at an angle from E's +Z towards its +X.
Eigen::Vector3d outwards(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

}  // namespace

EtalonFigure::EtalonFigure(const EtalonConfig& etalon)
    : X_WE_{rotation_of(etalon.rotation), vector(etalon.position)},
      radius_(etalon.radius),
      height_(etalon.height),
      // The middle of the visible part of a wide line lies slightly deeper than the line itself.
      red_radius_(etalon.radius * std::cos(0.5 * etalon.line_width / etalon.radius)) {}

std::optional<EtalonLine> EtalonFigure::line(EtalonPart part, std::size_t number, const Eigen::Vector3d& p_WC,
                                             RimHalf half) const {
  const Eigen::Vector3d p_EC = X_WE_.inverse() * p_WC;
  const double distance = std::hypot(p_EC.x(), p_EC.z());
  if (!(distance > radius_)) return std::nullopt;
  const double towards = std::atan2(p_EC.x(), p_EC.z()), grazing = std::acos(radius_ / distance);
  const auto along = [&](double angle, double radius) {
    return EtalonLine{X_WE_ * (radius * outwards(angle)), up()};
  };
  // A rim is measured a quarter of the width to either side of the middle, at equal angles around the rim.
  // The mean of the two shows the point halfway between them.
  const auto rim = [&](double height) {
    const double side = (half == RimHalf::seen ? half_seen(part, p_WC) : half) == RimHalf::near ? 1 : -1;
    double around = std::numbers::pi / 6;
    for (int i = 0; i < 20; ++i)
      around = std::asin(std::clamp(0.5 * (distance - side * radius_ * std::cos(around)) /
                                        std::sqrt(distance * distance - radius_ * radius_),
                                    -1.0, 1.0));
    const Eigen::Vector3d edge = side * radius_ * std::cos(around) * outwards(towards);
    return EtalonLine{X_WE_ * Eigen::Vector3d(edge.x(), height, edge.z()),
                      X_WE_.rotation * outwards(towards + quarter)};
  };
  switch (part) {
    case EtalonPart::left_side:
      return along(towards - grazing, radius_);
    case EtalonPart::right_side:
      return along(towards + grazing, radius_);
    case EtalonPart::upper_rim:
      return rim(height_);
    case EtalonPart::lower_rim:
      return rim(0);
    case EtalonPart::red_line:
      break;
  }
  return along(quarter * static_cast<double>(number), red_radius_);
}

RimHalf EtalonFigure::half_seen(EtalonPart part, const Eigen::Vector3d& p_WC) const {
  const double up = (X_WE_.inverse() * p_WC).y();
  if (part == EtalonPart::upper_rim) return up < height_ ? RimHalf::near : RimHalf::far;
  if (part == EtalonPart::lower_rim) return up > 0 ? RimHalf::near : RimHalf::far;
  return RimHalf::seen;
}

std::optional<Eigen::Vector3d> EtalonFigure::nearest(const EtalonPoint& seen, const View& view) const {
  const auto known = line(seen.part, seen.number, view.X_WC.position, seen.half);
  const auto ray = view.lens.unproject(seen.pixel);
  if (!known || !ray) return std::nullopt;
  // Shortest segment between the line and the line of sight.
  const Eigen::Vector3d sight = view.X_WC.rotation * Eigen::Vector3d(ray->x(), ray->y(), 1).normalized();
  const Eigen::Vector3d from = known->point - view.X_WC.position;
  const double cosine = sight.dot(known->direction), square = 1 - cosine * cosine;
  constexpr double parallel = 1e-12;
  if (!(square > parallel)) return std::nullopt;
  const double along = (cosine * sight.dot(from) - known->direction.dot(from)) / square;
  return known->point + along * known->direction;
}

double EtalonFigure::bearing(std::size_t number, const Eigen::Vector3d& p_WC) const {
  const Eigen::Vector3d p_EC = X_WE_.inverse() * p_WC;
  return std::remainder(quarter * static_cast<double>(number) - std::atan2(p_EC.x(), p_EC.z()),
                        2 * std::numbers::pi);
}

std::optional<std::array<Eigen::Vector2d, 2 * EtalonFigure::rim_points>> EtalonFigure::outline(
    const View& view, double margin) const {
  const Eigen::Vector3d p_EC = X_WE_.inverse() * view.X_WC.position;
  if (!(std::hypot(p_EC.x(), p_EC.z()) > radius_)) return std::nullopt;
  const double towards = std::atan2(p_EC.x(), p_EC.z()), step = 2 * std::numbers::pi / rim_points;
  std::array<Eigen::Vector2d, 2 * rim_points> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t place = i / 2;
    const Eigen::Vector3d rim = radius_ * outwards(towards + step * static_cast<double>(place));
    const auto pixel = view.project(X_WE_ * Eigen::Vector3d(rim.x(), i % 2 == 0 ? 0 : height_, rim.z()));
    if (!pixel || pixel->minCoeff() < margin || pixel->x() > view.width - 1 - margin ||
        pixel->y() > view.height - 1 - margin)
      return std::nullopt;
    points[i] = *pixel;
  }
  return points;
}

std::optional<std::vector<EtalonPoint>> EtalonFigure::expected(const View& view, double margin) const {
  if (!outline(view, margin)) return std::nullopt;
  std::vector<EtalonPoint> points;
  const auto add = [&](EtalonPart part, std::size_t number, double share) {
    const auto known = line(part, number, view.X_WC.position);
    if (const auto pixel = view.project(known->point + share * height_ * known->direction))
      points.push_back({part, number, *pixel, 0});
  };
  constexpr std::array<double, 2> places = {0.25, 0.75};
  for (const EtalonPart side : {EtalonPart::left_side, EtalonPart::right_side})
    for (const double place : places) add(side, 0, place);
  for (const EtalonPart rim : {EtalonPart::upper_rim, EtalonPart::lower_rim}) add(rim, 0, 0);
  constexpr double facing = std::numbers::pi / 3;
  for (std::size_t i = 0; i < red_lines; ++i)
    if (std::abs(bearing(i, view.X_WC.position)) <= facing)
      for (const double place : places) add(EtalonPart::red_line, i, place);
  return points;
}

Eigen::Vector3d EtalonFigure::middle() const { return X_WE_ * Eigen::Vector3d(0, 0.5 * height_, 0); }

}  // namespace flexura
