#include "flexura/render/flat.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Depth of the circle's point in the local direction (x, y), not zero; and, when the circle is seen so flat
// that the point opposite to it (across the image's long axis) is as near to the ray, that one's if smaller.
double rim_depth(const Circle& circle, double x, double y, const Ray& ray) {
  const double to_camera_x = circle.x.dot(circle.center), to_camera_y = circle.y.dot(circle.center);
  const double square = to_camera_x * to_camera_x + to_camera_y * to_camera_y;
  const double length = std::hypot(x, y);
  x /= length, y /= length;
  const Eigen::Vector3d near = circle.center + circle.radius * (x * circle.x + y * circle.y);
  if (!(square > 0)) return near.z();
  const double along = 2 * (x * to_camera_x + y * to_camera_y) / square;
  const Eigen::Vector3d other = circle.center + circle.radius * ((x - along * to_camera_x) * circle.x +
                                                                 (y - along * to_camera_y) * circle.y);
  if (other.z() >= near.z() || !(other.z() > 0)) return near.z();
  if (!(near.z() > 0)) return other.z();
  constexpr double close = 3;  // px
  const Eigen::Vector2d apart = (other / other.z() - near / near.z()).head<2>();
  const double pixel = ray.by_pixel.norm() * 0.7;
  return apart.norm() < close * pixel ? other.z() : near.z();
}

}  // namespace

Circle circle_at(const Eigen::Matrix3d& R_CS, const Eigen::Vector3d& p_CS, double radius, bool is_turned) {
  Circle circle;
  circle.center = p_CS;
  circle.normal = (is_turned ? -1.0 : 1.0) * R_CS.col(2);
  circle.x = R_CS.col(0), circle.y = R_CS.col(1);
  circle.radius = radius;
  const double height = circle.normal.dot(p_CS);  // of the plane over the camera
  const double side = height < 0 ? -1 : 1;
  circle.by_x = side * (circle.x * height - circle.normal * circle.x.dot(p_CS));
  circle.by_y = side * (circle.y * height - circle.normal * circle.y.dot(p_CS));
  circle.by_z = side * circle.normal;
  circle.steepness = std::sqrt(circle.by_x.squaredNorm() + circle.by_y.squaredNorm()) + radius;
  return circle;
}

CircleView view_of(const Circle& circle, const Ray& ray) {
  const double x = circle.by_x.dot(ray.direction), y = circle.by_y.dot(ray.direction);
  const double w = circle.by_z.dot(ray.direction), length = std::sqrt(x * x + y * y);
  CircleView view;
  view.value = length - circle.radius * w;
  if (!(std::abs(view.value) < border_reach * circle.steepness * ray.by_pixel.norm())) return view;
  if (!(length > 0)) return view;
  const Eigen::Vector3d slope =
      (x * circle.by_x + y * circle.by_y) / length - circle.radius * circle.by_z;
  view.border = border_of(view.value, slope.head<2>(), ray, 0);
  if (view.border.distance < border_reach) {
    const double sign = w < 0 ? -1 : 1;
    view.border.depth = rim_depth(circle, sign * x, sign * y, ray);
    if (!(view.border.depth > 0)) view.border.distance = infinity;
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
