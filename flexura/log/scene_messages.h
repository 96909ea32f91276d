#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/log/messages.h"

// Objects of the scene and their poses, for programs that display logs. The messages have the layout of the
// Foxglove schemas.
namespace flexura {

/// foxglove.Duration.
struct DurationMessage {
  std::int64_t sec = 0;
  std::int64_t nsec = 0;
};

struct ColorMessage {
  double r = 0, g = 0, b = 0, a = 1;
};

/// foxglove.CubePrimitive: a box whose middle is at its pose.
struct CubeMessage {
  PoseMessage pose;
  VectorMessage size;  ///< In m.
  ColorMessage color;
};

/// foxglove.SpherePrimitive.
struct SphereMessage {
  PoseMessage pose;
  VectorMessage size;  ///< Diameters, m.
  ColorMessage color;
};

/// foxglove.CylinderPrimitive: a cylinder whose middle is at its pose, with the axis along z.
struct CylinderMessage {
  PoseMessage pose;
  VectorMessage size;  ///< Two diameters and the length, m.
  double bottom_scale = 1, top_scale = 1;
  ColorMessage color;
};

/// foxglove.LinePrimitive: a polyline.
struct LineMessage {
  std::int64_t type = 0;  ///< 0: a polyline.
  PoseMessage pose;
  double thickness = 0;  ///< In m.
  bool scale_invariant = false;
  std::vector<VectorMessage> points;
  ColorMessage color;
  std::vector<ColorMessage> colors;
  std::vector<std::int64_t> indices;
};

/// foxglove.SceneEntity: replaces an earlier entity with an equal `id`.
struct EntityMessage {
  TimeMessage timestamp;
  std::string frame_id = "world";
  std::string id;
  DurationMessage lifetime;  ///< Time for which the entity is shown; 0: until it is replaced.
  bool frame_locked = false;
  std::vector<CubeMessage> cubes;
  std::vector<SphereMessage> spheres;
  std::vector<CylinderMessage> cylinders;
  std::vector<LineMessage> lines;
};

/// foxglove.SceneUpdate, on /scene.
struct SceneMessage {
  std::vector<EntityMessage> entities;
};

/// foxglove.FrameTransform.
struct FrameMessage {
  TimeMessage timestamp;
  std::string parent_frame_id = "world";
  std::string child_frame_id;
  VectorMessage translation;  ///< In m.
  QuaternionMessage rotation;
};

/// foxglove.FrameTransforms, on /frames.
struct FramesMessage {
  std::vector<FrameMessage> transforms;
};

/// foxglove.CameraCalibration, on /intrinsics/NAME. The distortion models are those of OpenCV: `plumb_bob` is
/// the lens model brown, `rational_polynomial` is rational, and `kannala_brandt` is fisheye.
struct CameraCalibrationMessage {
  TimeMessage timestamp;
  std::string frame_id;                ///< "camera/NAME"
  std::int64_t width = 0, height = 0;  ///< Of a picture, px.
  std::string distortion_model = "plumb_bob";
  std::vector<double> distortion;            ///< Coefficients of the distortion model.
  std::array<double, 9> intrinsics = {};     ///< fx 0 cx, 0 fy cy, 0 0 1, row by row, px.
  std::array<double, 9> rectification = {};  ///< The identity matrix, because pictures are not rectified.
  std::array<double, 12> projection = {};    ///< The intrinsics and a column of zeros, row by row, px.
};

inline constexpr std::string_view scene_topic = "/scene";
inline constexpr std::string_view frames_topic = "/frames";

const Table<DurationMessage>& fields_of(const DurationMessage*);
const Table<ColorMessage>& fields_of(const ColorMessage*);
const Table<CubeMessage>& fields_of(const CubeMessage*);
const Table<SphereMessage>& fields_of(const SphereMessage*);
const Table<CylinderMessage>& fields_of(const CylinderMessage*);
const Table<LineMessage>& fields_of(const LineMessage*);
const Table<EntityMessage>& fields_of(const EntityMessage*);
const Table<SceneMessage>& fields_of(const SceneMessage*);
const Table<FrameMessage>& fields_of(const FrameMessage*);
const Table<FramesMessage>& fields_of(const FramesMessage*);
const Table<CameraCalibrationMessage>& fields_of(const CameraCalibrationMessage*);

/// Returns the topic of a camera's intrinsics.
[[nodiscard]] std::string intrinsics_topic(std::string_view camera);

}  // namespace flexura
