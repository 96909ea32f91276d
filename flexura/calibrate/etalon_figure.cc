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

// From the axis, at an angle from E's +Z towards its +X.
Eigen::Vector3d outwards(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

}  // namespace

EtalonFigure::EtalonFigure(const EtalonConfig& etalon)
    : X_WE_{rotation_of(etalon.rotation), vector(etalon.position)},
      radius_(etalon.radius),
      height_(etalon.height) {}

std::optional<EtalonLine> EtalonFigure::line(EtalonPart part, std::size_t number,
                                             const Eigen::Vector3d& p_WC) const {
  const Eigen::Vector3d p_EC = X_WE_.inverse() * p_WC;
  const double distance = std::hypot(p_EC.x(), p_EC.z());
  if (!(distance > radius_)) return std::nullopt;
  const double towards = std::atan2(p_EC.x(), p_EC.z()), grazing = std::acos(radius_ / distance);
  const auto along = [&](double angle) {
    return EtalonLine{X_WE_ * (radius_ * outwards(angle)), X_WE_.rotation.col(1)};
  };
  // Of a rim at this height the camera sees the near edge as the silhouette's end where it stands beyond the
  // cylinder's end that way, else the far one.
  const auto rim = [&](double height, bool is_near) {
    const Eigen::Vector3d edge = (is_near ? radius_ : -radius_) * outwards(towards);
    return EtalonLine{X_WE_ * Eigen::Vector3d(edge.x(), height, edge.z()),
                      X_WE_.rotation * outwards(towards + quarter)};
  };
  switch (part) {
    case EtalonPart::left_side:
      return along(towards - grazing);
    case EtalonPart::right_side:
      return along(towards + grazing);
    case EtalonPart::upper_rim:
      return rim(height_, p_EC.y() < height_);
    case EtalonPart::lower_rim:
      return rim(0, p_EC.y() > 0);
    case EtalonPart::red_line:
      break;
  }
  return along(quarter * static_cast<double>(number));
}

std::optional<Eigen::Vector3d> EtalonFigure::nearest(const EtalonPoint& seen, const View& view) const {
  const auto known = line(seen.part, seen.number, view.X_WC.position);
  const auto ray = view.lens.unproject(seen.pixel);
  if (!known || !ray) return std::nullopt;
  // The shortest way between the line and the ray of sight.
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

std::optional<std::vector<EtalonPoint>> EtalonFigure::expected(const View& view, double margin) const {
  std::vector<EtalonPoint> points;
  const auto add = [&](EtalonPart part, std::size_t number, double share) {
    const auto known = line(part, number, view.X_WC.position);
    if (!known) return false;
    const double up = part == EtalonPart::upper_rim || part == EtalonPart::lower_rim ? 0 : share * height_;
    const auto pixel = view.project(known->point + up * known->direction);
    if (!pixel || pixel->minCoeff() < margin || pixel->x() > view.width - 1 - margin ||
        pixel->y() > view.height - 1 - margin)
      return false;
    points.push_back({part, number, *pixel, 0});
    return true;
  };
  constexpr std::array<double, 2> ends = {0, 1}, places = {0.25, 0.75};
  for (const EtalonPart side : {EtalonPart::left_side, EtalonPart::right_side}) {
    for (const double end : ends)
      if (!add(side, 0, end)) return std::nullopt;
    points.resize(points.size() - 2);  // These were to see whether all of it is inside.
    for (const double place : places)
      if (!add(side, 0, place)) return std::nullopt;
  }
  for (const EtalonPart rim : {EtalonPart::upper_rim, EtalonPart::lower_rim})
    if (!add(rim, 0, 0)) return std::nullopt;
  constexpr double facing = std::numbers::pi / 3;
  for (std::size_t i = 0; i < red_lines; ++i) {
    if (std::abs(bearing(i, view.X_WC.position)) > facing) continue;
    for (const double place : places)
      if (!add(EtalonPart::red_line, i, place)) return std::nullopt;
  }
  return points;
}

Eigen::Vector3d EtalonFigure::middle() const { return X_WE_ * Eigen::Vector3d(0, 0.5 * height_, 0); }

}  // namespace flexura
