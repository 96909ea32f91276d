#include "flexura/log/scene_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<DurationMessage>& fields_of(const DurationMessage*) {
  static const auto table = Table<DurationMessage>("foxglove.Duration", "A time span.")
                                .field("sec", &DurationMessage::sec, {.meaning = "Whole seconds."})
                                .field("nsec", &DurationMessage::nsec, {.meaning = "Remaining nanoseconds."});
  return table;
}

const Table<ColorMessage>& fields_of(const ColorMessage*) {
  static const auto table = Table<ColorMessage>("foxglove.Color", "Colour and opacity, each from 0 to 1.")
                                .field("r", &ColorMessage::r, {})
                                .field("g", &ColorMessage::g, {})
                                .field("b", &ColorMessage::b, {})
                                .field("a", &ColorMessage::a, {});
  return table;
}

const Table<CubeMessage>& fields_of(const CubeMessage*) {
  static const auto table =
      Table<CubeMessage>("foxglove.CubePrimitive", "A box.")
          .field("pose", &CubeMessage::pose, {.meaning = "Pose of the object's middle."})
          .field("size", &CubeMessage::size, {.meaning = "Lengths of the sides, m."})
          .field("color", &CubeMessage::color, {});
  return table;
}

const Table<SphereMessage>& fields_of(const SphereMessage*) {
  static const auto table =
      Table<SphereMessage>("foxglove.SpherePrimitive", "A ball.")
          .field("pose", &SphereMessage::pose, {.meaning = "Pose of the object's middle."})
          .field("size", &SphereMessage::size, {.meaning = "Diameters, m."})
          .field("color", &SphereMessage::color, {});
  return table;
}

const Table<CylinderMessage>& fields_of(const CylinderMessage*) {
  static const auto table =
      Table<CylinderMessage>("foxglove.CylinderPrimitive", "A cylinder along z.")
          .field("pose", &CylinderMessage::pose, {.meaning = "Pose of the object's middle."})
          .field("size", &CylinderMessage::size, {.meaning = "Two diameters and the length, m."})
          .field("bottom_scale", &CylinderMessage::bottom_scale, {})
          .field("top_scale", &CylinderMessage::top_scale, {})
          .field("color", &CylinderMessage::color, {});
  return table;
}

const Table<LineMessage>& fields_of(const LineMessage*) {
  static const auto table =
      Table<LineMessage>("foxglove.LinePrimitive", "A line through points.")
          .field("type", &LineMessage::type, {.meaning = "0: a strip."})
          .field("pose", &LineMessage::pose, {.meaning = "Pose of the frame of the points."})
          .field("thickness", &LineMessage::thickness, {.meaning = "m"})
          .field("scale_invariant", &LineMessage::scale_invariant,
                 {.meaning = "Whether the thickness is in pixels."})
          .field("points", &LineMessage::points, {.meaning = "m"})
          .field("color", &LineMessage::color, {})
          .field("colors", &LineMessage::colors,
                 {.meaning = "Colours of the points; empty: all have `color`."})
          .field("indices", &LineMessage::indices,
                 {.meaning = "Indices of points; empty: all points, in order."});
  return table;
}

const Table<EntityMessage>& fields_of(const EntityMessage*) {
  static const auto table =
      Table<EntityMessage>("foxglove.SceneEntity", "An object in the scene.")
          .field("timestamp", &EntityMessage::timestamp, {})
          .field("frame_id", &EntityMessage::frame_id, {.meaning = "Frame of reference."})
          .field("id", &EntityMessage::id,
                 {.meaning = "Identifier; the entity replaces an earlier one with an equal identifier."})
          .field("lifetime", &EntityMessage::lifetime,
                 {.meaning = "Time for which the entity is shown; 0: until it is replaced."})
          .field("frame_locked", &EntityMessage::frame_locked, {})
          .field("cubes", &EntityMessage::cubes, {})
          .field("spheres", &EntityMessage::spheres, {})
          .field("cylinders", &EntityMessage::cylinders, {})
          .field("lines", &EntityMessage::lines, {});
  return table;
}

const Table<SceneMessage>& fields_of(const SceneMessage*) {
  static const auto table = Table<SceneMessage>("foxglove.SceneUpdate", "Changes of the scene.")
                                .field("entities", &SceneMessage::entities, {});
  return table;
}

const Table<FrameMessage>& fields_of(const FrameMessage*) {
  static const auto table =
      Table<FrameMessage>("foxglove.FrameTransform", "Pose of a frame relative to another frame.")
          .field("timestamp", &FrameMessage::timestamp, {})
          .field("parent_frame_id", &FrameMessage::parent_frame_id, {})
          .field("child_frame_id", &FrameMessage::child_frame_id, {})
          .field("translation", &FrameMessage::translation, {.meaning = "m"})
          .field("rotation", &FrameMessage::rotation, {});
  return table;
}

const Table<FramesMessage>& fields_of(const FramesMessage*) {
  static const auto table =
      Table<FramesMessage>("foxglove.FrameTransforms", "Poses of the arm's base and of the cameras.")
          .field("transforms", &FramesMessage::transforms, {});
  return table;
}

const Table<CameraCalibrationMessage>& fields_of(const CameraCalibrationMessage*) {
  using M = CameraCalibrationMessage;
  static const auto table =
      Table<M>("foxglove.CameraCalibration", "A camera's lens at its present zoom.")
          .field("timestamp", &M::timestamp, {})
          .field("frame_id", &M::frame_id, {.meaning = "The camera's optical frame."})
          .field("width", &M::width, {.meaning = "px"})
          .field("height", &M::height, {.meaning = "px"})
          .field("distortion_model", &M::distortion_model, {})
          .field("D", &M::distortion, {.meaning = "Coefficients of the distortion model."})
          .field("K", &M::intrinsics, {.meaning = "fx 0 cx, 0 fy cy, 0 0 1; px."})
          .field("R", &M::rectification,
                 {.meaning = "The identity matrix, because pictures are not rectified."})
          .field("P", &M::projection, {.meaning = "The intrinsic matrix K and a column of zeros, px."});
  return table;
}

std::string intrinsics_topic(std::string_view camera) { return "/intrinsics/" + std::string(camera); }

}  // namespace flexura
