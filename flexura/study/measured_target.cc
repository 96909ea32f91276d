#include "flexura/study/measured_target.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/vision/border.h"

namespace flexura {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double dark = 0.1, bright = 0.85;

// Corners of the square, in order around it.
constexpr std::array<std::size_t, 4> corners = {bottom_right, top_right, top_left, bottom_left};

SensorConfig gray_sensor(SensorConfig sensor) {
  sensor.pixels = PixelKind::gray, sensor.bits = 8;
  // No lens is sharper than its pixels: the borders of a sharper image have no position within a pixel.
  constexpr double sharpest = 0.6;
  sensor.psf = std::max(sensor.psf, sharpest);
  return sensor;
}

// Returns the line n . x = 1 with the least squares of the distances, fitted again twice without outliers.
// Points are directions (a, b, 1) of an ideal lens. Returns std::nullopt for fewer than 8 points.
std::optional<Vector3d> line_through(std::vector<Vector2d> points) {
  constexpr std::size_t fewest = 8;
  Vector3d line;
  for (int round = 0; round < 3; ++round) {
    if (points.size() < fewest) return std::nullopt;
    Vector2d mean = Vector2d::Zero();
    for (const Vector2d& point : points) mean += point / static_cast<double>(points.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Vector2d& point : points) spread += (point - mean) * (point - mean).transpose();
    const auto [values, vectors] = symmetric_eigen(spread);
    const Vector2d normal = vectors.col(0);
    line << normal, -normal.dot(mean);
    const double rms = std::sqrt(std::max(0.0, values[0]) / static_cast<double>(points.size()));
    std::erase_if(
        points, [&](const Vector2d& point) { return std::abs(normal.dot(point - mean)) > 3 * rms + 1e-12; });
  }
  return line;
}

// Returns the edge near a point, counted by its first corner, if the point is away from its ends;
// std::nullopt near a corner.
std::optional<std::size_t> edge_of(const std::array<Vector2d, 4>& expected, const Vector2d& point) {
  constexpr double end = 0.1, near = 0.1;  // Shares of the edge's length.
  std::optional<std::size_t> best;
  double least = near;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d& from = expected[i];
    const Vector2d way = expected[(i + 1) % 4] - from, to = point - from;
    const double share = to.dot(way) / way.squaredNorm();
    const double off = std::abs(way.x() * to.y() - way.y() * to.x()) / way.squaredNorm();
    if (share < end || share > 1 - end || off >= least) continue;
    least = off, best = i;
  }
  return best;
}

// Returns the homography of the plane (x, y, 1) that maps four points to four others (R. Hartley, A.
// Zisserman, 2004).
std::optional<Eigen::Matrix3d> homography(const std::array<Vector2d, 4>& from,
                                          const std::array<Vector2d, 4>& to) {
  Eigen::Matrix<double, 8, 8> left;
  Eigen::Vector<double, 8> right;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    const double x = from[i].x(), y = from[i].y(), u = to[i].x(), v = to[i].y();
    left.row(row) << x, y, 1, 0, 0, 0, -u * x, -u * y;
    left.row(row + 1) << 0, 0, 0, x, y, 1, -v * x, -v * y;
    right.segment<2>(row) << u, v;
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, 8, 8>> solver(left);
  if (!solver.isInvertible()) return std::nullopt;
  const Eigen::Vector<double, 8> h = solver.solve(right);
  Eigen::Matrix3d map;
  map << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return map;
}

}  // namespace

MeasuredTarget::MeasuredTarget(const StudyTarget& target, const SensorConfig& sensor,
                               const NoiseStream& stream)
    : target_(target), sensor_(gray_sensor(sensor)), stream_(stream) {
  const double side = std::numbers::sqrt2 * target.radius();
  Screen& square = scene_.screens.emplace_back();
  square.X_WS = target.frame();
  square.size = {side, side};
  square.brightness = Color::Constant(dark);
  scene_.background = Color::Constant(bright);
  picture_ = Image<std::uint8_t>(static_cast<int>(sensor_.config().width),
                                 static_cast<int>(sensor_.config().height));
}

TargetImage MeasuredTarget::image(const View& view, std::uint64_t frame) {
  std::array<Vector2d, 4> expected;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d p_CP = view.X_WC.inverse() * target_.point(corners[i]);
    if (!(p_CP.z() > 0) || !view.lens.project(p_CP)) return {};
    expected[i] = p_CP.head<2>() / p_CP.z();
  }
  renderer_.render(scene_, view, PixelKind::gray, light_);
  stream_.frame = frame;
  sensor_.read(light_.light, stream_, rows_, picture_);
  const FigureBorder figure = largest_figure(picture_);
  if (!figure.reason.empty() || figure.touches_border) return {};
  std::array<std::vector<Vector2d>, 4> edges;
  for (const BorderPoint& border : figure.points) {
    const auto point = view.lens.unproject(border.pixel);
    if (!point) continue;
    if (const auto edge = edge_of(expected, *point)) edges[*edge].push_back(*point);
  }
  std::array<Vector3d, 4> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto line = line_through(edges[i]);
    if (!line) return {};
    lines[i] = *line;
  }
  std::array<Vector2d, 4> found, plane;
  const double half = target_.radius() / std::numbers::sqrt2;
  constexpr std::array<std::array<double, 2>, 4> signs = {{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d corner = lines[(i + 3) % 4].cross(lines[i]);
    found[i] = corner.head<2>() / corner.z();
    if (!found[i].allFinite()) return {};
    plane[i] = half * Vector2d(signs[i][0], signs[i][1]);
  }
  const auto map = homography(plane, found);
  if (!map) return {};
  const auto pixel_of = [&](const Vector2d& p_F) -> std::optional<Vector2d> {
    const Vector3d there = *map * Vector3d(p_F.x(), p_F.y(), 1);
    if (!(there.z() > 0)) return std::nullopt;
    return view.lens.project(Vector3d(there.x() / there.z(), there.y() / there.z(), 1));
  };
  TargetImage image;
  image.center = pixel_of({0, 0});
  for (std::size_t i = 0; i < circle_points; ++i) image.circle[i] = pixel_of(target_.plane_point(i));
  return image;
}

}  // namespace flexura
