#include "flexura/report/arm_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/report/obstacle_drawing.h"

namespace flexura {
namespace {

constexpr double warning_border = 5.0;  // Around a tube, page units.
constexpr double warning_gap = 1.8;     // Between tube and border, for tubes as red as the border.
constexpr double thinnest_tube = 5.0;   // Least width of a tube, page units.

std::string moment(const ReportMotion& motion, std::size_t i) {
  return "t = " + fixed(motion.times[i], 3) + " s";
}

// Draws the arm's base: a line across the tube, hatched on the side away from the arm.
void draw_base(XmlWriter& svg, const PlotFrame& frame, PlotView view, const Arm& arm) {
  const Eigen::Vector2d at = frame.page(seen(view, arm.X_WB.position));
  const Eigen::Vector2d tangent = seen(view, arm.X_WB.rotation.col(2));
  const double turn = tangent.norm() < 1e-6 ? 0.0 : std::atan2(tangent.x(), tangent.y()) / degree;
  svg.leaf("path", {{"class", "base"},
                    {"transform", fmt::format("translate({}) rotate({})", page_point(at), page_number(turn))},
                    {"d", "M-14 0H14M-12 0l-5 6M-5 0l-5 6M2 0l-5 6M9 0l-5 6"}});
}

void draw_tube(XmlWriter& svg, const PlotScene& scene, std::size_t v, const Arc& arc, bool is_unsafe) {
  const auto draw = [&](const std::string& css_class, double border) {
    std::array<double, 2> radius = arc.radius;
    for (double& r : radius) r = std::max(r * scene.scale(), thinnest_tube / 2) + border;
    svg.leaf("path", {{"class", css_class}, {"d", tube_path(arc, scene.views[v], scene.frames[v], radius)}});
  };
  if (is_unsafe) {
    draw("warning", warning_border);
    draw("gap", warning_gap);
  }
  draw(fmt::format("tube s{}", arc.section % 8), 0);
}

// Draws the chosen curve as a line; arcs are the tube itself.
void draw_curve(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion,
                const Backbone& backbone) {
  std::string path;
  const auto page = [&](const Eigen::Vector3d& p_WP) {
    return page_point(scene.frames[v].page(seen(scene.views[v], p_WP)));
  };
  for (const CubicBezier& piece : drawn_curve(backbone, motion.curve, motion.tension)) {
    const auto& p = piece.points;
    if (path.empty()) path = 'M' + page(p[0]);
    path += fmt::format("C{} {} {}", page(p[1]), page(p[2]), page(p[3]));
  }
  if (!path.empty()) svg.leaf("path", {{"class", "spline"}, {"d", path}});
}

// Returns how near the middle of an arc is to the view's camera.
double nearness(PlotView view, const Arc& arc) {
  const Eigen::Vector3d middle = arc.pose(arc.length / 2).position;
  return view == PlotView::xoy ? middle.z() : -middle.x();
}

// Returns the backbone's arcs, the farthest first.
std::vector<std::size_t> back_to_front(PlotView view, const Backbone& backbone) {
  std::vector<std::size_t> order(backbone.arcs().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return nearness(view, backbone.arcs()[a]) < nearness(view, backbone.arcs()[b]);
  });
  return order;
}

void draw_joints(XmlWriter& svg, const PlotScene& scene, std::size_t v, const Backbone& backbone) {
  std::size_t section = 0;
  for (const Arc& arc : backbone.arcs()) {
    if (std::exchange(section, arc.section) == arc.section) continue;
    svg.circle(scene.frames[v].page(seen(scene.views[v], arc.X_WS.position)), "joint", 2.8);
  }
}

std::vector<Eigen::Vector2d> tip_points(const ReportMotion& motion, const PlotFrame& frame, PlotView view) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(motion.count());
  for (std::size_t i = 0; i < motion.count(); ++i) points.push_back(frame.page(seen(view, motion.tip(i))));
  return points;
}

std::string backbone_path(const PlotScene& scene, std::size_t v, const Backbone& backbone) {
  std::string path;
  for (const Arc& arc : backbone.arcs())
    path += polyline_path(arc_points(arc, scene.views[v], scene.frames[v]));
  return path;
}

// Returns labels for the start, the middle and the end of the tip's path; one label for points that coincide
// on the page.
std::vector<std::pair<Eigen::Vector2d, std::string>> named_tips(const ReportMotion& motion,
                                                                const PlotFrame& frame, PlotView view) {
  constexpr double together = 20.0;
  std::vector<std::pair<Eigen::Vector2d, std::string>> names;
  const std::pair<std::size_t, const char*> all[] = {
      {0, "start"}, {motion.middle, "middle"}, {motion.end(), "end"}};
  for (const auto& [i, name] : all) {
    const Eigen::Vector2d at = frame.page(seen(view, motion.tip(i)));
    const auto same =
        std::ranges::find_if(names, [&](const auto& other) { return (other.first - at).norm() < together; });
    if (same == names.end()) {
      names.emplace_back(at, name);
    } else {
      same->second += std::string(", ") + name;
    }
  }
  return names;
}

bool is_inside(const PlotFrame& frame, const Eigen::Vector2d& page) {
  const Eigen::Vector2d in = page - frame.corner;
  return in.minCoeff() >= 0 && in.x() <= frame.size.x() && in.y() <= frame.size.y();
}

// Returns where the line from a point in the plot to another leaves the plot, if it does.
Eigen::Vector2d cut_off(const PlotFrame& frame, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  double part = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to[axis] - from[axis];
    const double border = frame.corner[axis] + (way > 0 ? frame.size[axis] : 0.0);
    if (way != 0) part = std::clamp((border - from[axis]) / way, 0.0, part);
  }
  return from + part * (to - from);
}

// Draws a cross at a position that the tip does not reach; nothing if it is outside the plot.
void draw_target(XmlWriter& svg, const PlotFrame& frame, const Eigen::Vector2d& at) {
  if (!is_inside(frame, at)) return;
  svg.open("g", {{"class", "target"}, {"transform", fmt::format("translate({})", page_point(at))}});
  svg.leaf("title", {}, "target");
  svg.leaf("path", {{"d", "M-7 -7L7 7M-7 7L7 -7"}});
  svg.close();
}

// Draws the targets that the tip does not reach in this picture, and their distances.
void draw_missed_targets(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion,
                         std::size_t i, const std::vector<std::size_t>& shown) {
  const PlotFrame& frame = scene.frames[v];
  const Eigen::Vector2d tip = frame.page(seen(scene.views[v], motion.tip(i)));
  for (std::size_t k = 0; k < motion.violations.size(); ++k) {
    const auto& violation = motion.violations[k];
    const bool is_now = violation.start <= motion.times[i] && motion.times[i] <= violation.end;
    if (!violation.target || (!is_now && std::ranges::count(shown, k) == 0)) continue;
    const Eigen::Vector2d at = frame.page(seen(scene.views[v], *violation.target));
    svg.leaf("path", {{"class", "target-way"}, {"d", polyline_path({tip, cut_off(frame, tip, at)})}});
    draw_target(svg, frame, at);
  }
}

// Returns the arm in state i, with a warning around the sections of these violations and of those that are
// unsafe at that time.
Drawing picture_of_arm(const ReportMotion& motion, const PlotScene& scene, std::size_t i,
                       std::string_view when, const std::vector<std::size_t>& shown) {
  const auto is_shown = [&](std::size_t section) {
    return std::ranges::any_of(
        shown, [&](std::size_t k) { return std::ranges::count(motion.violations[k].sections, section) > 0; });
  };
  const std::string tip = motion.tip_text(i);
  const bool one_view = scene.views.size() == 1;
  const std::string heading = fmt::format("{}, {}{}", when, moment(motion, i), one_view ? "" : ": " + tip);
  XmlWriter svg;
  draw_scene_axes(svg, scene, heading);
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    const Backbone& backbone = motion.backbones[i];
    draw_obstacles(svg, scene, v, motion);
    draw_base(svg, scene.frames[v], scene.views[v], motion.arm);
    for (const std::size_t k : back_to_front(scene.views[v], backbone)) {
      const Arc& arc = backbone.arcs()[k];
      draw_tube(svg, scene, v, arc, motion.is_unsafe(arc.section, i) || is_shown(arc.section));
    }
    draw_curve(svg, scene, v, motion, backbone);
    if (scene.has_room_for_joints(backbone.length(), motion.arm.sections.size()))
      draw_joints(svg, scene, v, backbone);
    draw_missed_targets(svg, scene, v, motion, i, shown);
    const Eigen::Vector2d at = scene.frames[v].page(seen(scene.views[v], motion.tip(i)));
    svg.circle(at, "tip", 5);
    label_beside(svg, scene.frames[v], at, one_view ? tip : "E");
  }
  return {scene.width, scene.height,
          fmt::format("The arm at the {}, {}, with its end effector at {} m", when, moment(motion, i), tip),
          svg.text()};
}

}  // namespace

Drawing arm_picture(const ReportMotion& motion, const PlotScene& scene, std::size_t i,
                    std::string_view when) {
  return picture_of_arm(motion, scene, i, when, {});
}

std::string moment_text(const ReportMotion& motion, const UnsafeMoment& moment) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, moment.violations.size()); ++k)
    text += (k == 0 ? "" : "; ") + motion.violations[moment.violations[k]].text;
  if (moment.violations.size() > most) text += fmt::format("; and {} more", moment.violations.size() - most);
  return text;
}

Drawing unsafe_picture(const ReportMotion& motion, const PlotScene& scene, const UnsafeMoment& moment) {
  Drawing drawing = picture_of_arm(motion, scene, moment.state, "worst moment", moment.violations);
  drawing.label += ": " + moment_text(motion, moment);
  return drawing;
}

Drawing two_shapes_picture(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                           const Backbone& shape, const Backbone& ghost, std::string_view heading) {
  Eigen::AlignedBox3d box;
  extend_by_tube(box, shape);
  extend_by_tube(box, ghost);
  ReportMotion around;
  around.arm = arm;
  around.obstacles = obstacles;
  around.in_plane = lies_in_xoy(arm);
  const PlotScene scene = scene_of(with_obstacles(box, obstacles), around.in_plane, 0.1 * arm.length());
  XmlWriter svg;
  draw_scene_axes(svg, scene, heading);
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    draw_obstacles(svg, scene, v, around);
    svg.leaf("path", {{"class", "ghost"}, {"d", backbone_path(scene, v, ghost)}});
    draw_base(svg, scene.frames[v], scene.views[v], arm);
    for (const std::size_t k : back_to_front(scene.views[v], shape))
      draw_tube(svg, scene, v, shape.arcs()[k], false);
    svg.circle(scene.frames[v].page(seen(scene.views[v], shape.tip().position)), "tip", 5);
  }
  return {scene.width, scene.height, std::string(heading), svg.text()};
}

Drawing tip_path_picture(const ReportMotion& motion) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < motion.count(); ++i) box.extend(motion.tip(i));
  const PlotScene scene = scene_of(box, motion.in_plane, 0.02 * motion.arm.length());
  XmlWriter svg;
  draw_scene_axes(svg, scene, "path of the end effector");
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    const std::vector<Eigen::Vector2d> path =
        simplified(tip_points(motion, scene.frames[v], scene.views[v]), 0.05);
    svg.leaf("path", {{"class", "path"}, {"d", polyline_path(path)}});
    for (const auto& [at, name] : named_tips(motion, scene.frames[v], scene.views[v])) {
      svg.circle(at, "tip", 5);
      label_beside(svg, scene.frames[v], at, name);
    }
  }
  return {scene.width, scene.height,
          fmt::format("The end effector's path from {} to {} m", motion.tip_text(0),
                      motion.tip_text(motion.end())),
          svg.text()};
}

Drawing player_picture(const ReportMotion& motion, const PlotScene& scene) {
  XmlWriter svg;
  draw_scene_axes(svg, scene, "");
  const bool joints = scene.has_room_for_joints(motion.arm.length(), motion.arm.sections.size());
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    const PlotFrame& frame = scene.frames[v];
    draw_obstacles(svg, scene, v, motion);
    for (const std::size_t i : {std::size_t{0}, motion.end()}) {
      svg.leaf("path", {{"class", "ghost"}, {"d", backbone_path(scene, v, motion.backbones[i])}});
    }
    for (const auto& violation : motion.violations) {
      if (violation.target) draw_target(svg, frame, frame.page(seen(scene.views[v], *violation.target)));
    }
    draw_base(svg, frame, scene.views[v], motion.arm);
    const Eigen::Vector2d origin = frame.page({0.0, 0.0});
    svg.open("g", {{"class", "view"},
                   {"data-view", scene.views[v] == PlotView::xoy ? "xoy" : "zoy"},
                   {"data-x", fmt::format("{:.9g}", origin.x())},
                   {"data-y", fmt::format("{:.9g}", origin.y())},
                   {"data-joints", joints ? "yes" : "no"},
                   {"data-scale", fmt::format("{:.9g}", scene.scale())}});
    svg.close();
  }
  return {scene.width, scene.height, "The arm in motion, between its start and its end", svg.text()};
}

}  // namespace flexura
