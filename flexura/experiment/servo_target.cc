#include "flexura/experiment/servo_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "flexura/experiment/shape_fields.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/math/direction.h"
#include "flexura/model/backbone.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// A curve whose direction has these angles at equal shares of its length, linear in between.
std::vector<Eigen::Vector3d> curve_of_angles(const std::vector<double>& azimuths,
                                             const std::vector<double>& elevations, const Arm& arm) {
  constexpr int pieces = 16;  // Between two angles; each is a straight one along its middle's direction.
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

// How far a backbone is from a curve, root mean square at equal parts of the length of both, m.
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

ServoTargetShape along(const Arm& arm, const std::vector<Eigen::Vector3d>& points, const ArmState& from) {
  InverseOptions options;
  options.start = from;
  const InverseResult found = solve_inverse(arm, CurveTarget{points}, options);
  return {found.state, distance_from(Backbone(arm, found.state), points) / arm.length()};
}

}  // namespace

ServoTargetShape servo_target_shape(const ServoTargetConfig& target, const Arm& arm, const ArmState& from) {
  if (target.azimuths) return along(arm, curve_of_angles(*target.azimuths, *target.elevations, arm), from);
  if (target.curve) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& point : *target.curve) points.push_back(vector(point));
    return along(arm, points, from);
  }
  if (!target.position) return {arm_state(arm, target), 0};
  InverseOptions options;
  options.start = from;
  const InverseResult found = solve_inverse(arm, TipTarget{.position = vector(*target.position)}, options);
  return {found.state, found.converged() ? 0 : found.position_error / arm.length()};
}

std::vector<std::optional<ServoTargetShape>> servo_target_shapes(const ServoTask& task, const Arm& arm,
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
    const Photograph photograph =
        decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, path.string());
    const SensorConfig& sensor = cameras[i].sensor;
    const Image<std::uint8_t>& bytes = photograph.bytes;
    if (bytes.width() != sensor.width || bytes.height() != sensor.height)
      throw input_error(path.string(),
                        fmt::format("{} x {} px: expected {} x {}, as camera {} takes them", bytes.width(),
                                    bytes.height(), sensor.width, sensor.height, cameras[i].name));
    if (sensor.bits > 8 && photograph.words.values().empty())
      throw input_error(path.string(), fmt::format("8 bits a value: expected {}, as camera {} takes them",
                                                   sensor.bits, cameras[i].name));
    if (sensor.bits <= 8 && !photograph.words.values().empty())
      throw input_error(path.string(),
                        fmt::format("16 bits a value: expected 8, as camera {} takes them", cameras[i].name));
    if (sensor.bits > 8) {
      views[i] = photograph.words;
    } else {
      views[i] = bytes;
    }
  }
  return views;
}

}  // namespace flexura
