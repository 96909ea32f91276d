#include "flexura/render/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

// A cross-section of the tube in C, and the equation of the angles at which rays are tangent: across_x
// cos(angle) + across_y sin(angle) + radius - widening / shrink(angle) * along = 0.
struct Section2d {
  Pose X_CS;
  double s = 0, radius = 0, widening = 0;
  Eigen::Vector2d curvature;  // Towards x and y, 1/m.
  // Of the center, from the camera, in the section's frame.
  double across_x = 0, across_y = 0, along = 0;

  [[nodiscard]] Eigen::Vector3d point(double angle) const {
    return X_CS * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  [[nodiscard]] double touching(double angle) const {
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
    return across_x * n.x() + across_y * n.y() + radius - widening / (1 - radius * curvature.dot(n)) * along;
  }
  // Positive if there are such angles: the distance from a section without such angles. With taper, to first
  // order.
  [[nodiscard]] double openness() const {
    return std::hypot(across_x, across_y) - std::abs(radius - widening * along);
  }
};

Section2d section_at(const Arc& tube, double distance, const Pose& X_CW) {
  Section2d section;
  section.X_CS = X_CW * tube.carried(distance);
  section.s = tube.s + distance;
  section.widening = (tube.radius[1] - tube.radius[0]) / tube.length;
  section.radius = tube.radius[0] + section.widening * distance;
  section.curvature = tube.bend / tube.length;
  const Eigen::Vector3d center = section.X_CS.rotation.transpose() * section.X_CS.position;
  section.across_x = center.x(), section.across_y = center.y(), section.along = center.z();
  return section;
}

// Returns the tangent angle on one side (1 or -1) of the direction away from the camera. Uses the closed form
// for constant radius, otherwise Newton's method started from the closed form.
double touching_angle(const Section2d& section, double side) {
  const double reach = std::hypot(section.across_x, section.across_y);
  const double level = -(section.radius - section.widening * section.along);
  double angle = std::atan2(section.across_y, section.across_x) +
                 side * std::acos(std::clamp(reach > 0 ? level / reach : 0.0, -1.0, 1.0));
  if (section.widening == 0) return angle;
  constexpr double small = 1e-6;
  for (int step = 0; step < 30; ++step) {
    const double value = section.touching(angle);
    const double slope = (section.touching(angle + small) - section.touching(angle - small)) / (2 * small);
    const double move = slope != 0 ? std::clamp(-value / slope, -0.3, 0.3) : 0;
    angle += move;
    if (std::abs(move) < 1e-13) break;
  }
  return angle;
}

class OutlineMaker {
 public:
  OutlineMaker(const Renderer& renderer, double step)
      : renderer_(renderer),
        step_(step),
        X_CW_(renderer.prepared().view.X_WC.inverse()),
        tracer_(renderer.prepared().stage, renderer.prepared().tiles.all_parts()) {}

  std::vector<Outline> make() {
    const ArmLook& arm = renderer_.prepared().stage.scene->arm;
    for (std::size_t i = 0; i < arm.tube.size(); ++i) {
      // A jump of the radius interrupts the contour.
      if (i > 0 && std::abs(arm.tube[i].radius[0] - arm.tube[i - 1].radius[1]) > 1e-12) close();
      add_arc(arm.tube[i]);
    }
    close();
    add_rim(section_at(arm.tube.front(), 0, X_CW_));
    const Arc& last = arm.tube.back();
    const Section2d tip = section_at(last, last.length, X_CW_);
    if (arm.tip == TipKind::flat) {
      add_rim(tip);
    } else {
      add_ball(tip);
    }
    return std::move(result_);
  }

 private:
  int count_for(const Arc& tube) const {
    double pixels = 0;
    std::optional<Eigen::Vector2d> before;
    constexpr int parts = 8;
    for (int i = 0; i <= parts; ++i) {
      const Pose X_WS = tube.pose(tube.length * i / parts);
      const auto pixel = renderer_.prepared().view.project(X_WS.position);
      if (before && pixel) pixels += (*pixel - *before).norm();
      before = pixel;
    }
    return static_cast<int>(std::clamp(std::ceil(pixels / step_), 8.0, 2000.0));
  }

  void add_arc(const Arc& tube) {
    const int count = count_for(tube);
    double before = 0;
    for (int i = 0; i <= count; ++i) {
      const double distance = tube.length * i / count;
      const bool is_open = section_at(tube, distance, X_CW_).openness() > 0;
      if (i > 0 && is_open != was_open_)
        add_turn(tube, is_open ? distance : before, is_open ? before : distance);
      if (!is_open) close();
      // An arc's first point is the last of the previous one.
      if (is_open && (i > 0 || sides_[0].points.empty())) add_pair(section_at(tube, distance, X_CW_));
      was_open_ = is_open;
      before = distance;
    }
  }

  // Adds the point between an open and a closed section where both sides meet.
  void add_turn(const Arc& tube, double open, double closed) {
    const double began = open;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (open + closed);
      (section_at(tube, middle, X_CW_).openness() > 0 ? open : closed) = middle;
    }
    if (open != began) add_pair(section_at(tube, open, X_CW_));
  }

  void add_pair(const Section2d& section) {
    sides_[0].points.push_back(point_at(section, touching_angle(section, 1)));
    sides_[1].points.push_back(point_at(section, touching_angle(section, -1)));
  }

  void close() {
    for (Outline& side : sides_) {
      if (side.points.size() > 1) result_.push_back(side);
      side.points.clear();
    }
  }

  void add_rim(const Section2d& section) {
    Outline rim;
    rim.kind = OutlineKind::rim;
    const double pixels =
        2 * std::numbers::pi * section.radius /
        (std::max(section.X_CS.position.z(), 1e-9) * renderer_.prepared().rays.largest_step());
    const int count = static_cast<int>(std::clamp(std::ceil(pixels / step_), 16.0, 2000.0));
    for (int i = 0; i <= count; ++i)
      rim.points.push_back(point_at(section, 2 * std::numbers::pi * i / count));
    result_.push_back(rim);
  }

  // Adds the contour of the hemispherical tip: the circle on which the line from the hemisphere's middle is
  // perpendicular to the ray.
  void add_ball(const Section2d& tip) {
    const Eigen::Vector3d center = tip.X_CS.position;
    const double square = center.squaredNorm(), radius = tip.radius;
    if (!(square > radius * radius)) return;
    const Eigen::Vector3d middle = center * (1 - radius * radius / square);
    const double circle_radius = radius * std::sqrt(1 - radius * radius / square);
    const Eigen::Vector3d x = center.unitOrthogonal(), y = center.normalized().cross(x);
    // Starts at the side of the tube, so that the part beyond it is one piece.
    const Eigen::Vector3d axis = tip.X_CS.rotation.col(2);
    const double start = std::atan2(-axis.dot(y), -axis.dot(x));
    Outline contour;
    constexpr int count = 256;
    for (int i = 0; i <= count; ++i) {
      const double turn = start + 2 * std::numbers::pi * i / count;
      const Eigen::Vector3d p = middle + circle_radius * (std::cos(turn) * x + std::sin(turn) * y);
      const Eigen::Vector3d p_S = tip.X_CS.inverse() * p;
      if (p_S.z() < 0) continue;
      contour.points.push_back(judged({tip.s, std::atan2(p_S.y(), p_S.x()), p, {}, false}, radius));
    }
    if (contour.points.size() > 1) result_.push_back(contour);
  }

  OutlinePoint point_at(const Section2d& section, double angle) const {
    return judged({section.s, std::remainder(angle, 2 * std::numbers::pi), section.point(angle), {}, false},
                  section.radius);
  }

  // Adds pixel and visibility.
  OutlinePoint judged(OutlinePoint point, double radius) const {
    point.pixel = renderer_.prepared().view.lens.project(point.p_CP);
    if (!point.pixel) return point;
    Ray ray;
    ray.direction = point.p_CP / point.p_CP.z();
    ray.by_pixel = Eigen::Matrix2d::Identity() * renderer_.prepared().rays.largest_step();
    // Because of rounding, a tangent ray may enter the tube slightly before the point.
    const double tolerance = 1e-3 * radius + 1e-6 * point.p_CP.z();
    point.is_visible = tracer_.hit(ray).depth > point.p_CP.z() - tolerance;
    return point;
  }

  const Renderer& renderer_;
  double step_;
  Pose X_CW_;
  Tracer tracer_;
  std::array<Outline, 2> sides_;
  bool was_open_ = false;
  std::vector<Outline> result_;
};

}  // namespace

std::vector<Outline> outlines(const Renderer& renderer, double step) {
  if (!(step > 0)) throw std::invalid_argument("the distance between points of an outline must be positive");
  if (renderer.prepared().stage.scene->arm.tube.empty()) return {};
  return OutlineMaker(renderer, step).make();
}

}  // namespace flexura
