#include "flexura/experiment/scene_log.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "flexura/experiment/space_record.h"
#include "flexura/log/logged_message.h"
#include "flexura/math/arrays.h"
#include "flexura/math/so3.h"
#include "flexura/render/scene_maker.h"

namespace flexura {
namespace {

constexpr double flat = 0.001;  // Drawn thickness of flat objects, m.

// Rounds to the micrometre: texts of numbers as short as a drawing needs.
double rounded(double metres) { return std::round(metres * 1e6) / 1e6 + 0.0; }

VectorMessage point_message(const Eigen::Vector3d& p) {
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

ColorMessage color_message(const Color& color) { return {color.x(), color.y(), color.z(), 1}; }

// Returns a pose in `p` whose z has this direction.
Pose along(const Eigen::Vector3d& p, const Eigen::Vector3d& z) { return {rotation_from_z(z), p}; }

EntityMessage entity(const std::string& id, double time) {
  EntityMessage message;
  message.timestamp = time_message(nanoseconds(time));
  message.id = id;
  return message;
}

void draw(const Screen& screen, EntityMessage& out) {
  out.cubes.push_back(
      {pose_message(screen.X_WS), {screen.size[0], screen.size[1], flat}, color_message(screen.brightness)});
}

void draw(const Etalon& etalon, EntityMessage& out) {
  CylinderMessage cylinder;
  cylinder.pose = pose_message(along(etalon.X_WE.position, etalon.X_WE.rotation.col(1)));
  cylinder.size = {2 * etalon.radius, 2 * etalon.radius, etalon.height};
  cylinder.color = color_message(etalon.albedo);
  out.cylinders.push_back(cylinder);
}

void draw_ball(const Eigen::Vector3d& center, double radius, const ColorMessage& color, EntityMessage& out) {
  const double size = 2 * radius;
  out.spheres.push_back({pose_message({Eigen::Matrix3d::Identity(), center}), {size, size, size}, color});
}

// A plane is drawn `reach` m to every side.
void draw(const VisibleObstacle& obstacle, double reach, EntityMessage& out) {
  const ColorMessage color = color_message(obstacle.albedo);
  std::visit(
      [&]<class Shape>(const Shape& shape) {
        if constexpr (std::is_same_v<Shape, PlaneConfig>) {
          out.cubes.push_back({pose_message(along(vector(shape.point), vector(shape.normal).normalized())),
                               {2 * reach, 2 * reach, flat},
                               color});
        } else if constexpr (std::is_same_v<Shape, SphereConfig>) {
          draw_ball(vector(shape.center), shape.radius, color, out);
        } else if constexpr (std::is_same_v<Shape, CapsuleConfig>) {
          const Eigen::Vector3d from = vector(shape.from), to = vector(shape.to);
          draw_ball(from, shape.radius, color, out);
          draw_ball(to, shape.radius, color, out);
          if (from == to) return;
          CylinderMessage cylinder;
          cylinder.pose = pose_message(along((from + to) / 2, (to - from).normalized()));
          cylinder.size = {2 * shape.radius, 2 * shape.radius, (to - from).norm()};
          cylinder.color = color;
          out.cylinders.push_back(cylinder);
        } else {
          const Eigen::Vector3d size = 2 * vector(shape.half_sizes);
          out.cubes.push_back({pose_message({rotation_of(shape.rotation), vector(shape.center)}),
                               {size.x(), size.y(), size.z()},
                               color});
        }
      },
      obstacle.shape);
}

FrameMessage frame(const std::string& name, const Pose& X_WF) {
  const PoseMessage pose = pose_message(X_WF);
  FrameMessage message;
  message.child_frame_id = name;
  message.translation = pose.position;
  message.rotation = pose.orientation;
  return message;
}

// Adds points along an arc after its start, dense enough for a strip through them to look like it.
void add_points(const Arc& arc, std::vector<VectorMessage>& points) {
  constexpr double largest_turn = 0.2, most = 64;  // rad.
  const auto pieces = static_cast<int>(std::clamp(std::ceil(arc.bend.norm() / largest_turn), 1.0, most));
  for (int i = 1; i <= pieces; ++i)
    points.push_back(point_message(arc.pose(arc.length * i / pieces).position));
}

}  // namespace

SceneMessage stand_message(const Experiment& experiment) {
  const RigConfig rig = experiment.true_rig();
  const Arm arm = rig.arm.arm();
  const SceneMaker maker(arm, rig.arm.look, experiment.true_stand(), experiment.obstacle);
  EntityMessage stand = entity("stand", 0);
  for (const Screen& screen : maker.stand().screens) draw(screen, stand);
  if (maker.stand().etalon) draw(*maker.stand().etalon, stand);
  EntityMessage obstacles = entity("obstacles", 0);
  for (const VisibleObstacle& obstacle : maker.stand().obstacles) draw(obstacle, arm.length(), obstacles);
  return {{std::move(stand), std::move(obstacles)}};
}

FramesMessage frames_message(const Experiment& experiment) {
  const RigConfig rig = experiment.true_rig();
  FramesMessage frames;
  frames.transforms.push_back(frame("base", rig.arm.arm().X_WB));
  for (const CameraConfig& config : rig.cameras) {
    const Camera camera(config);
    frames.transforms.push_back(
        frame(image_topic(config.name).substr(1), camera.pose(camera.initial_stance())));
  }
  Pose upright;
  upright.rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  frames.transforms.push_back(frame("upright", upright));
  return frames;
}

CameraCalibrationMessage calibration_message(const Camera& camera, double time, double zoom) {
  const SensorConfig& sensor = camera.config().sensor;
  const Intrinsics lens = camera.lens().at(zoom);
  CameraCalibrationMessage message;
  message.timestamp = time_message(nanoseconds(time));
  message.frame_id = image_topic(camera.config().name).substr(1);
  message.width = sensor.width;
  message.height = sensor.height;
  const LensModel model = lens.distortion.model();
  if (model == LensModel::rational) message.distortion_model = "rational_polynomial";
  if (model == LensModel::fisheye) message.distortion_model = "kannala_brandt";
  message.distortion.assign(lens.distortion.begin(), lens.distortion.end());
  message.intrinsics = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  message.rectification = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.projection = {lens.fx, 0, lens.cx, 0, 0, lens.fy, lens.cy, 0, 0, 0, 1, 0};
  return message;
}

CameraDrawing::CameraDrawing(const CameraConfig& camera, const CameraConfig& model, Recorder& recorder)
    : camera_(camera), first_report_(Camera(model).initial_stance()), logged_(camera_.initial_stance()) {
  log_lens(0, logged_.head.zoom, recorder);
}

void CameraDrawing::log_lens(double time, double zoom, Recorder& recorder) {
  const CameraCalibrationMessage message = calibration_message(camera_, time, zoom);
  recorder.write({intrinsics_topic(name()), time, message});
}

void CameraDrawing::report(double time, const CameraStance& reported, Recorder& recorder) {
  const CameraStance now = true_stance(camera_, first_report_, reported);
  constexpr double rounding = 1e-9;
  const double interval = 1 / camera_.config().sensor.frame_rate - rounding;
  if (now == logged_ || time < logged_at_ + interval) return;
  if (now.head.zoom != logged_.head.zoom) log_lens(time, now.head.zoom, recorder);
  FrameMessage moved = frame(image_topic(name()).substr(1), camera_.pose(now));
  moved.timestamp = time_message(nanoseconds(time));
  const FramesMessage frames{{std::move(moved)}};
  recorder.write({frames_topic, time, frames});
  logged_at_ = time;
  logged_ = now;
}

SceneMessage arm_message(const ColorConfig& color, double time, const Backbone& backbone) {
  EntityMessage drawn = entity("arm", time);
  const std::array<double, 2>* radius = nullptr;  // Of the line being drawn.
  for (const Arc& arc : backbone.arcs()) {
    if (radius == nullptr || arc.radius != *radius) {
      LineMessage line;
      line.thickness = arc.radius[0] + arc.radius[1];
      line.color = {color[0], color[1], color[2], 1};
      line.points.push_back(point_message(arc.X_WS.position));
      drawn.lines.push_back(std::move(line));
      radius = &arc.radius;
    }
    add_points(arc, drawn.lines.back().points);
  }
  return {{std::move(drawn)}};
}

bool SceneTimes::is_next(double time) {
  constexpr double interval = 0.1, rounding = 1e-9;  // In s.
  if (last_ && time < *last_ + interval - rounding) return false;
  last_ = time;
  return true;
}

}  // namespace flexura
