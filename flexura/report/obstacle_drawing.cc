#include "flexura/report/obstacle_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <variant>
#include <vector>

#include "flexura/math/arrays.h"
#include "flexura/report/arm_curve.h"

namespace flexura {
namespace {

std::array<Eigen::Vector3d, 8> corners(const BoxConfig& box) {
  const auto& q = box.rotation;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  std::array<Eigen::Vector3d, 8> points;
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d sides((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    points[i] = vector(box.center) + turn * sides.cwiseProduct(vector(box.half_sizes));
  }
  return points;
}

Eigen::AlignedBox3d ball_box(const Eigen::Vector3d& center, double radius) {
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(radius);
  return {Eigen::Vector3d(center - around), Eigen::Vector3d(center + around)};
}

Eigen::AlignedBox3d box_around(const PlaneConfig&) { return {}; }
Eigen::AlignedBox3d box_around(const SphereConfig& sphere) {
  return ball_box(vector(sphere.center), sphere.radius);
}
Eigen::AlignedBox3d box_around(const CapsuleConfig& capsule) {
  return ball_box(vector(capsule.from), capsule.radius).merged(ball_box(vector(capsule.to), capsule.radius));
}
Eigen::AlignedBox3d box_around(const BoxConfig& box) {
  Eigen::AlignedBox3d around;
  for (const Eigen::Vector3d& corner : corners(box)) around.extend(corner);
  return around;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Returns the convex hull of points (Andrew's monotone chain).
std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points, [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector2d> chain;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = chain.size();
    for (const Eigen::Vector2d& p : points) {
      while (chain.size() >= first + 2 &&
             cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0)
        chain.pop_back();
      chain.push_back(p);
    }
    chain.pop_back();
    std::ranges::reverse(points);
  }
  return chain;
}

// One view of a scene, with the data for outlines.
struct Look {
  PlotView view;
  const PlotFrame& frame;
  const ReportMotion& motion;

  [[nodiscard]] Eigen::Vector2d page(const Eigen::Vector3d& p_W) const { return frame.page(seen(view, p_W)); }
  [[nodiscard]] double length(double metres) const { return metres * frame.scale().x(); }
};

// Returns the outline of everything within a radius of a line on the page.
std::string rod(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius) {
  Eigen::Vector2d along = b - a;
  along = along.norm() > 0 ? Eigen::Vector2d(along.normalized()) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d side = radius * Eigen::Vector2d(-along.y(), along.x());
  const std::string r = page_number(radius);
  return fmt::format("M{}L{}A{} {} 0 0 0 {}L{}A{} {} 0 0 0 {}Z", page_point(a + side), page_point(b + side),
                     r, r, page_point(b - side), page_point(a - side), r, r, page_point(a + side));
}

// Returns the side of a plane that the arm must not enter, as a rectangle larger than the plot.
std::string outline(const PlaneConfig& plane, const Look& look) {
  constexpr double from_the_side = 0.999;
  const Eigen::Vector3d normal = vector(plane.normal).normalized();
  const Eigen::Vector2d n = seen(look.view, normal);
  if (n.norm() < (look.motion.in_plane ? 1e-6 : from_the_side)) return "";
  // The line n . p = offset in the plane of the view through the arm's base.
  Eigen::Vector3d base = look.motion.arm.X_WB.position;
  base.y() = 0;
  (look.view == PlotView::xoy ? base.x() : base.z()) = 0;
  const double offset = normal.dot(vector(plane.point) - base) / n.norm();
  const Eigen::Vector2d up = n.normalized();
  const Eigen::Vector2d across(-up.y(), up.x());
  const PlotFrame& frame = look.frame;
  const Eigen::Vector2d center((frame.x.low + frame.x.high) / 2, (frame.y.low + frame.y.high) / 2);
  const Eigen::Vector2d foot = center - (up.dot(center) - offset) * up;
  const double size = frame.x.extent() + frame.y.extent();
  const double deep = size + (foot - center).norm();
  if ((foot - center).norm() > size && up.dot(center) > offset) return "";
  return polyline_path({frame.page(foot - size * across), frame.page(foot + size * across),
                        frame.page(foot + size * across - deep * up),
                        frame.page(foot - size * across - deep * up)}) +
         "Z";
}
std::string outline(const SphereConfig& sphere, const Look& look) {
  const Eigen::Vector2d center = look.page(vector(sphere.center));
  return rod(center, center, look.length(sphere.radius));
}
std::string outline(const CapsuleConfig& capsule, const Look& look) {
  return rod(look.page(vector(capsule.from)), look.page(vector(capsule.to)), look.length(capsule.radius));
}
std::string outline(const BoxConfig& box, const Look& look) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& corner : corners(box)) points.push_back(look.page(corner));
  return polyline_path(hull(std::move(points))) + "Z";
}

}  // namespace

Eigen::AlignedBox3d with_obstacles(Eigen::AlignedBox3d box, const std::vector<ObstacleConfig>& obstacles) {
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(0.25 * box.diagonal().norm());
  const Eigen::AlignedBox3d near(Eigen::Vector3d(box.min() - around), Eigen::Vector3d(box.max() + around));
  for (const ObstacleConfig& obstacle : obstacles) {
    const auto theirs = std::visit([](const auto& one) { return box_around(one); }, obstacle);
    if (!theirs.isEmpty() && theirs.intersects(near)) box.extend(theirs.intersection(near));
  }
  return box;
}

void draw_obstacles(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion) {
  if (motion.obstacles.empty()) return;
  const PlotFrame& frame = scene.frames[v];
  open_inside(svg, frame);
  const std::vector<Obstacle> named = obstacles(motion.obstacles);
  const Look look{scene.views[v], frame, motion};
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::string path =
        std::visit([&](const auto& one) { return outline(one, look); }, motion.obstacles[i]);
    if (path.empty()) continue;
    svg.open("g", {{"class", "obstacle"}});
    svg.leaf("title", {}, named[i].name);
    svg.leaf("path", {{"d", path}});
    svg.close();
  }
  svg.close();
}

}  // namespace flexura
