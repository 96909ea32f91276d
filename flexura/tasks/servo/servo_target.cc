#include "flexura/tasks/servo/servo_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "flexura/base/bytes.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/math/direction.h"
#include "flexura/model/backbone.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/shape_fields.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// Returns a curve whose direction has these angles at equal shares of its length, linear in between.
std::vector<Eigen::Vector3d> curve_of_angles(const std::vector<double>& azimuths,
                                             const std::vector<double>& elevations, const Arm& arm) {
  constexpr int pieces = 16;  // Between two angles; each is straight, along the direction of its middle.
  std::vector<Eigen::Vector3d> points = {arm.X_WB.position};
  const std::size_t spans = azimuths.size() - 1;
  const double length = arm.length() / static_cast<double>(spans * pieces);
  for (std::size_t i = 0; i < spans; ++i) {
    for (int k = 0; k < pieces; ++k) {
      const double share = (k + 0.5) / pieces;
      const Eigen::Vector2d angles(azimuths[i] + share * (azimuths[i + 1] - azimuths[i]),
                                   elevations[i] + share * (elevations[i + 1] - elevations[i]));
      const Eigen::Vector3d before = points.back();
      points.emplace_back(before + length * direction_of_angles(angles));
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> vectors(const std::vector<std::array<double, 3>>& points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const auto& point : points) result.push_back(vector(point));
  return result;
}

// Returns the smooth curve through the points: a cubic between each two of them. The tangent at a point is
// that of the parabola through it and its neighbours (Catmull-Rom). At corners of 60 degrees or more it is
// along the chord.
std::vector<Eigen::Vector3d> smooth_curve(const std::vector<Eigen::Vector3d>& given) {
  std::vector<Eigen::Vector3d> points;  // Without repetitions.
  for (const Eigen::Vector3d& point : given)
    if (points.empty() || point != points.back()) points.push_back(point);
  if (points.size() < 3) return given;
  constexpr int pieces = 16;
  constexpr double corner = 0.5;  // cos 60 degrees.
  const auto chord = [&](std::size_t i) -> Eigen::Vector3d { return points[i + 1] - points[i]; };
  // Tangent per chord length at point i of the chord that begins at k.
  const auto tangent = [&](std::size_t i, std::size_t k) -> Eigen::Vector3d {
    Eigen::Vector3d own = chord(k).normalized();
    if (i == 0 || i + 1 == points.size()) {
      // From a parabola through the nearest three points.
      const std::size_t other = i == 0 ? 1 : points.size() - 3;
      const Eigen::Vector3d there = chord(other).normalized();
      if (own.dot(there) < corner) return own;
      const double a = chord(k).norm(), b = chord(other).norm();
      return own + (own - there) * a / (a + b);
    }
    const Eigen::Vector3d before = chord(i - 1), after = chord(i);
    if (before.normalized().dot(after.normalized()) < corner) return own;
    const double a = before.norm(), b = after.norm();
    return (before / a * b + after / b * a) / (a + b);
  };
  std::vector<Eigen::Vector3d> curve = {points.front()};
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double length = chord(k).norm();
    const Eigen::Vector3d from = length * tangent(k, k), to = length * tangent(k + 1, k);
    for (int j = 1; j <= pieces; ++j) {
      const double t = static_cast<double>(j) / pieces, u = 1 - t;
      curve.emplace_back((1 + 2 * t) * u * u * points[k] + t * u * u * from +
                         t * t * (3 - 2 * t) * points[k + 1] - t * t * u * to);
    }
  }
  return curve;
}

// Returns the distance of a backbone from a curve, root mean square at equal shares of both lengths, m.
double distance_from(const Backbone& backbone, const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> lengths = {0};  // Up to each point.
  for (std::size_t i = 1; i < points.size(); ++i)
    lengths.push_back(lengths.back() + (points[i] - points[i - 1]).norm());
  constexpr int parts = 200;
  double squares = 0;
  std::size_t after = 1;
  for (int k = 0; k <= parts; ++k) {
    const double share = static_cast<double>(k) / parts, length = share * lengths.back();
    while (after + 1 < points.size() && lengths[after] < length) ++after;
    const double piece = lengths[after] - lengths[after - 1];
    const double within = piece > 0 ? std::clamp((length - lengths[after - 1]) / piece, 0.0, 1.0) : 0;
    const Eigen::Vector3d point = points[after - 1] + within * (points[after] - points[after - 1]);
    squares += (backbone.pose(share * backbone.length()).position - point).squaredNorm() / (parts + 1);
  }
  return std::sqrt(squares);
}

ServoTargetShape along(const ArmModel& arm, const std::vector<Eigen::Vector3d>& points,
                       const ArmState& from) {
  InverseConfig config;
  config.start = from;
  const InverseResult found = solve_inverse(arm, CurveTarget{points}, config);
  return {found.state, distance_from(arm.backbone(found.state), points) / arm.shaped().length()};
}

}  // namespace

double curve_length(const std::vector<std::array<double, 3>>& points) {
  const std::vector<Eigen::Vector3d> curve = smooth_curve(vectors(points));
  double length = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) length += (curve[i] - curve[i - 1]).norm();
  return length;
}

ServoTargetShape servo_target_shape(const ServoTargetConfig& target, const ArmModel& arm,
                                    const ArmState& from) {
  if (target.azimuths)
    return along(arm, curve_of_angles(*target.azimuths, *target.elevations, arm.shaped()), from);
  if (target.curve) return along(arm, smooth_curve(vectors(*target.curve)), from);
  if (!target.position) return {arm_state(arm.driven(), target), 0};
  InverseConfig config;
  config.start = from;
  const InverseResult found = solve_inverse(arm, TipTarget{.position = vector(*target.position)}, config);
  return {found.state, found.converged() ? 0 : found.position_error / arm.shaped().length()};
}

std::vector<std::optional<ServoTargetShape>> servo_target_shapes(const ServoTask& task, const ArmModel& arm,
                                                                 ArmState from) {
  std::vector<std::optional<ServoTargetShape>> shapes;
  for (const ServoTargetConfig& target : task.target) {
    auto& shape = shapes.emplace_back();
    if (!target.pictures.empty()) continue;
    shape = servo_target_shape(target, arm, from);
    from = shape->state;
  }
  return shapes;
}

RecordedViews recorded_views(const ServoTargetConfig& target, const std::array<CameraConfig, 2>& cameras,
                             const std::filesystem::path& folder) {
  RecordedViews views;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::filesystem::path path = file_inside(folder, target.pictures[i]);
    const std::string file = read_text_file(path, most_picture_bytes);
    const Photograph photograph = decode_picture(bytes_of(file), path.string());
    const SensorConfig& sensor = cameras[i].sensor;
    const Image<std::uint8_t>& bytes = photograph.bytes;
    if (bytes.width() != sensor.width || bytes.height() != sensor.height)
      throw input_error(
          path.string(),
          fmt::format("{} x {} px: expected {} x {} px, the picture size of camera {}", bytes.width(),
                      bytes.height(), sensor.width, sensor.height, cameras[i].name));
    if (sensor.bits > 8 && photograph.words.values().empty())
      throw input_error(path.string(),
                        fmt::format("8 bits per value: expected {}, as in the pictures of camera {}",
                                    sensor.bits, cameras[i].name));
    if (sensor.bits <= 8 && !photograph.words.values().empty())
      throw input_error(
          path.string(),
          fmt::format("16 bits per value: expected 8, as in the pictures of camera {}", cameras[i].name));
    if (sensor.bits > 8) {
      views[i] = photograph.words;
    } else {
      views[i] = bytes;
    }
  }
  return views;
}

}  // namespace flexura
