#include "flexura/render/flat.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "flexura/render/ray.h"

namespace flexura {
namespace {

// Intersection of a ray with a circle's plane in homogeneous coordinates: x^2 + y^2 = (radius z)^2 on the
// circle.
struct PlanePoint {
  double x, y, z;
};
PlanePoint plane_point(const Circle& circle, const Eigen::Vector3d& direction) {
  return {circle.by_x.dot(direction), circle.by_y.dot(direction), circle.by_z.dot(direction)};
}

// Returns the border where the circle's image crosses the line from the ray along `way`, `distance` px away.
Border rim_border(const Circle& circle, const Ray& ray, const Eigen::Vector2d& way, double distance) {
  Border border;
  Eigen::Vector3d direction = ray.direction;
  direction.head<2>() += ray.by_pixel * (distance * way);
  const auto [x, y, z] = plane_point(circle, direction);
  const double length = std::sqrt(x * x + y * y);
  if (!(z > 0) || !(length > 0)) return border;
  border.depth = circle.center.z() + circle.radius / length * (x * circle.x.z() + y * circle.y.z());
  const Eigen::Vector3d slope =
      x * circle.by_x + y * circle.by_y - circle.radius * circle.radius * z * circle.by_z;
  const Eigen::Vector2d normal = (ray.by_pixel.transpose() * slope.head<2>()).normalized();
  const double across = distance * normal.dot(way);
  if (!(border.depth > 0) || !normal.allFinite()) return border;
  border.distance = std::abs(across);
  border.towards = across < 0 ? Eigen::Vector2d(-normal) : normal;
  return border;
}

// Returns the borders at which the circle's image crosses the line along `way`, the nearer border first;
// infinitely far without a crossing.
std::array<Border, 2> crossings(const Circle& circle, const Ray& ray, const Eigen::Vector2d& way) {
  std::array<Border, 2> borders;
  Eigen::Vector3d step(0, 0, 0);
  step.head<2>() = ray.by_pixel * way;
  const PlanePoint at = plane_point(circle, ray.direction), by = plane_point(circle, step);
  const double square = circle.radius * circle.radius;
  const double A = by.x * by.x + by.y * by.y - square * by.z * by.z;
  const double B = at.x * by.x + at.y * by.y - square * at.z * by.z;
  const double C = at.x * at.x + at.y * at.y - square * at.z * at.z;
  const double discriminant = B * B - A * C;
  if (!(discriminant >= 0)) return borders;
  const double q = -(B + std::copysign(std::sqrt(discriminant), B));
  if (A != 0) borders[0] = rim_border(circle, ray, way, q / A);
  if (q != 0) borders[1] = rim_border(circle, ray, way, C / q);
  if (borders[1] < borders[0]) std::swap(borders[0], borders[1]);
  return borders;
}

// Returns the direction in (a, b) across which the circle's image is narrowest.
Eigen::Vector2d narrow_way(const Circle& circle) {
  const Eigen::Vector2d x = circle.by_x.head<2>(), y = circle.by_y.head<2>(),
                        z = circle.radius * circle.by_z.head<2>();
  const double difference =
      x.x() * x.x() + y.x() * y.x() - z.x() * z.x() - (x.y() * x.y() + y.y() * y.y() - z.y() * z.y());
  const double mixed = x.x() * x.y() + y.x() * y.y() - z.x() * z.y();
  const double angle = 0.5 * std::atan2(2 * mixed, difference);
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Circle circle_at(const Eigen::Matrix3d& R_CS, const Eigen::Vector3d& p_CS, double radius, bool is_turned) {
  Circle circle;
  circle.center = p_CS;
  circle.normal = (is_turned ? -1.0 : 1.0) * R_CS.col(2);
  circle.x = R_CS.col(0), circle.y = R_CS.col(1);
  circle.radius = radius;
  const double height = circle.normal.dot(p_CS);  // Height of the plane over the camera.
  const double side = height < 0 ? -1 : 1;
  circle.by_x = side * (circle.x * height - circle.normal * circle.x.dot(p_CS));
  circle.by_y = side * (circle.y * height - circle.normal * circle.y.dot(p_CS));
  circle.by_z = side * circle.normal;
  circle.narrow_way = narrow_way(circle);
  circle.steepness = std::sqrt(circle.by_x.squaredNorm() + circle.by_y.squaredNorm()) + radius;
  return circle;
}

CircleView view_of(const Circle& circle, const Ray& ray) {
  const auto [x, y, z] = plane_point(circle, ray.direction);
  const double length = std::sqrt(x * x + y * y);
  CircleView view;
  view.value = length - circle.radius * z;
  if (!(std::abs(view.value) < border_reach * circle.steepness * ray.by_pixel.norm())) return view;
  const auto narrow = crossings(circle, ray, circle.narrow_way);
  if (!(length > 0)) {
    view.borders = narrow;
    return view;
  }
  const Eigen::Vector3d slope = (x * circle.by_x + y * circle.by_y) / length - circle.radius * circle.by_z;
  const Border steepest = border_of(view.value, slope.head<2>(), ray, 0);
  view.borders = crossings(circle, ray, steepest.towards);
  // In the middle of a flat image, the steepest direction points to its far tips.
  if (narrow[0].distance < 0.8 * view.borders[0].distance) view.borders = narrow;
  if (view.borders[0].distance == infinity) {
    // The ray is beyond the tip of a flat image.
    view.borders[0] = steepest;
    view.borders[0].depth = std::max(1e-300, circle.center.z() - circle.radius);
  }
  return view;
}

std::optional<double> meet_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                 const Ray& ray) {
  const double depth = normal.dot(point) / normal.dot(ray.direction);
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return depth;
}

Border line_border(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Ray& ray) {
  const Eigen::Vector3d across = p.cross(q);
  Border border = border_of(across.dot(ray.direction), across.head<2>(), ray, 0);
  // The point of the edge nearest to the ray.
  const Eigen::Vector3d edge = q - p, d = ray.direction;
  const double square = d.squaredNorm(), mixed = d.dot(edge), along = d.dot(p);
  const double scale = square * edge.squaredNorm() - mixed * mixed;
  const double part = scale > 0 ? (mixed * along - square * edge.dot(p)) / scale : 0;
  border.depth = (p + std::clamp(part, 0.0, 1.0) * edge).z();
  if (!(border.depth > 0)) border.depth = std::max(p.z(), q.z());
  if (!(border.depth > 0)) border.distance = infinity;
  return border;
}

Face face_of(const std::array<Eigen::Vector3d, 4>& corners) {
  Face face;
  face.corners = corners;
  face.normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
  face.is_front = face.normal.dot(corners[0]) < 0;
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Vector3d inwards = corners[i].cross(corners[(i + 1) % 4]);
    if (face.is_front) inwards = -inwards;
    const double scale = inwards.head<2>().norm();
    face.edges[i] = scale > 0 ? Eigen::Vector3d(inwards / scale) : inwards;
  }
  return face;
}

FaceView view_of(const Face& face, const Ray& ray) {
  FaceView view{true, {}};
  std::array<double, 4> inside{};
  std::size_t first = 0, second = 4;
  for (std::size_t i = 0; i < 4; ++i) {
    inside[i] = face.edges[i].dot(ray.direction);
    view.is_hit = view.is_hit && inside[i] > 0;
    if (inside[i] < inside[first]) first = i;
  }
  if (std::abs(inside[first]) > border_reach * ray.by_pixel.norm()) return view;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i != first && (second == 4 || std::abs(inside[i]) < std::abs(inside[second]))) second = i;
  }
  view.borders[0] = line_border(face.corners[first], face.corners[(first + 1) % 4], ray);
  view.borders[1] = line_border(face.corners[second], face.corners[(second + 1) % 4], ray);
  view.borders[1].distance = std::max(view.borders[1].distance, view.borders[0].distance);
  return view;
}

}  // namespace flexura
