#include "flexura/report/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <variant>

#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"
#include "flexura/model/obstacle.h"
#include "flexura/report/motion.h"

namespace flexura {
namespace {

constexpr std::size_t points_of_shape = 49;
// Points are written as whole multiples of this share of the arm's length: finer than a screen.
constexpr double grain_share = 2e-5;

// Returns a text in quotes that is valid in JSON and cannot end a script element.
std::string json_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&') {
      quoted += fmt::format("\\u{:04x}", code);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string number(double value) { return fmt::format("{:.6g}", value + 0.0); }

template <class List, class Write>
std::string list_of(const List& list, const Write& write) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : ",") + write(item);
  return '[' + text + ']';
}

std::string numbers(const Eigen::Vector3d& v) { return list_of(std::array{v.x(), v.y(), v.z()}, number); }
std::string numbers(const std::array<double, 3>& v) { return list_of(v, number); }

std::string grains(const std::vector<Eigen::Vector3d>& points, double grain) {
  std::string text;
  for (const Eigen::Vector3d& point : points)
    for (const double value : {point.x(), point.y(), point.z()})
      text += fmt::format("{}{:.0f}", text.empty() ? "" : ",", std::round(value / grain) + 0.0);
  return '[' + text + ']';
}

std::string body(const PlaneConfig& plane) {
  return fmt::format(R"("kind":"plane","point":{},"normal":{})", numbers(plane.point),
                     numbers(vector(plane.normal).normalized()));
}
std::string body(const SphereConfig& sphere) {
  return fmt::format(R"("kind":"capsule","from":{0},"to":{0},"radius":{1})", numbers(sphere.center),
                     number(sphere.radius));
}
std::string body(const CapsuleConfig& capsule) {
  return fmt::format(R"("kind":"capsule","from":{},"to":{},"radius":{})", numbers(capsule.from),
                     numbers(capsule.to), number(capsule.radius));
}
std::string body(const BoxConfig& box) {
  const Eigen::Matrix3d axes = rotation_of(box.rotation) * vector(box.half_sizes).asDiagonal();
  return fmt::format(
      R"("kind":"box","center":{},"axes":{})", numbers(box.center),
      list_of(std::array<int, 3>{0, 1, 2}, [&](int i) { return numbers(Eigen::Vector3d(axes.col(i))); }));
}

std::string obstacles_json(const std::vector<ObstacleConfig>& configs) {
  const std::vector<Obstacle> named = obstacles(configs);
  std::string text;
  for (std::size_t i = 0; i < configs.size(); ++i)
    text += std::visit(
        [&](const auto& config) {
          return fmt::format(R"({}{{"name":{},"color":{},{}}})", i == 0 ? "" : ",", json_text(named[i].name),
                             numbers(config.color), body(config));
        },
        configs[i]);
  return '[' + text + ']';
}

std::string view_json(const ReportSpace::CameraView& view) {
  const Eigen::Matrix3d& R = view.X_WC.rotation;
  std::vector<double> values = {view.time};
  values.insert(values.end(), view.X_WC.position.data(), view.X_WC.position.data() + 3);
  values.insert(values.end(), R.data(), R.data() + 9);
  values.insert(values.end(), view.window.begin(), view.window.end());
  return list_of(values, number);
}

std::string target_json(const ReportSpace::Target& target, double grain) {
  return fmt::format(R"({{"name":{},"start":{:.9g},"end":{:.9g},"line":{},"position":{}}})",
                     json_text(target.name), target.start, target.end,
                     target.shape ? grains(points_along(*target.shape, points_of_shape), grain) : "null",
                     target.position ? numbers(*target.position) : "null");
}

}  // namespace

std::vector<Eigen::Vector3d> points_along(const Backbone& backbone, std::size_t count) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(
        backbone.pose(backbone.length() * static_cast<double>(i) / static_cast<double>(count - 1)).position);
  return points;
}

std::string space_json(const ReportSpace& space, const ReportMotion& motion) {
  const double grain = grain_share * motion.arm.length();
  return fmt::format(R"({{"grain":{:.9g},"obstacles":{},"cameras":{},"targets":{},"truth":{}}})", grain,
                     obstacles_json(motion.obstacles),
                     list_of(space.cameras,
                             [](const ReportSpace::Camera& camera) {
                               return fmt::format(R"({{"name":{},"views":{}}})", json_text(camera.name),
                                                  list_of(camera.views, view_json));
                             }),
                     list_of(space.targets, [&](const auto& target) { return target_json(target, grain); }),
                     list_of(space.true_arms, [&](const ReportSpace::TrueArm& arm) {
                       return fmt::format(R"({{"time":{:.9g},"line":{}}})", arm.time,
                                          grains(arm.points, grain));
                     }));
}

}  // namespace flexura
