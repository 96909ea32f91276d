#include "flexura/view/servo_extras.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/model/backbone.h"
#include "flexura/servo/servo_error.h"

namespace flexura {
namespace {

constexpr ExtraName desired{"target", "Target", "#ff922b"};
constexpr ExtraName seen{"seen", "Seen", "#22b8cf"};
constexpr ExtraName features{"features", "Features", "#da77f2"};

struct Shape {
  Arm arm;
  ArmState state;
};

// Returns a shape from the log; `lengths` are those of the sections without stretch. Logged values are
// validated.
Shape shape_of(const Arm& base, const std::vector<double>& lengths, const ArmState& state) {
  Shape shape{base, state};
  const std::size_t count = base.sections.size();
  constexpr double largest = 1e6;
  const auto is_size = [](double size) { return size > 1 / largest && size < largest; };
  const auto is_bend = [](const Eigen::Vector2d& bend) { return std::hypot(bend.x(), bend.y()) < largest; };
  // In logs without lengths, those of the file apply.
  const bool fits = (lengths.empty() || lengths.size() == count) && state.bends.size() == count &&
                    state.stretches.size() == count && std::ranges::all_of(lengths, is_size) &&
                    std::ranges::all_of(state.stretches, is_size) &&
                    std::ranges::all_of(state.bends, is_bend);
  if (!fits) throw input_error("the log", "a servo's shape does not fit the arm");
  for (std::size_t i = 0; i < lengths.size(); ++i) shape.arm.sections[i].length = lengths[i];
  return shape;
}

struct Shapes {
  Shape desired;
  std::optional<Shape> seen, truth;
};

Shapes shapes_of(const ViewedRig& rig, const ServoStep& step) {
  Shapes shapes{shape_of(rig.model.shaped(), step.lengths, step.desired), {}, {}};
  if (step.seen) shapes.seen = shape_of(rig.model.shaped(), step.lengths, *step.seen);
  // A rod has as many arcs as its plant uses, which the rig's arm does not know. It is drawn by the code that
  // has its poses.
  if (step.truth && step.truth->bends.size() == rig.truth.shaped().sections.size())
    shapes.truth = shape_of(rig.truth.shaped(), step.truth->lengths,
                            {step.truth->bends, std::vector<double>(rig.truth.shaped().sections.size(), 1)});
  return shapes;
}

GhostArm ghost_of(const ExtraName& mark, const Shape& shape) {
  return {mark.id, mark.label, mark.color, arm_samples(Backbone(shape.arm, shape.state))};
}

// Returns the distances between points at equal fractions of both lengths, mm.
AlongCurve distances(const ExtraName& mark, const Shape& shape, const Shape& target) {
  AlongCurve curve{mark.id, mark.label, mark.color, {}};
  for (const double off :
       shape_distances(Backbone(shape.arm, shape.state), Backbone(target.arm, target.state)))
    curve.values.push_back(1000 * off);
  return curve;
}

using Pixels = std::vector<Eigen::Vector2d>;

// Adds the features that the control law compares, for one side (measured or target): pixels as crosses, and
// lines.
void add_marks(const ExtraName& side, bool is_dashed, const Pixels& crosses, const std::vector<Pixels>& lines,
               Node::Array& layers) {
  const LayerMark mark{features.id, features.label, side.color, side.id};
  if (!crosses.empty()) layers.push_back(points_layer(mark, crosses));
  if (!lines.empty()) layers.push_back(lines_layer(mark, lines, is_dashed));
}

// Adds the features with a line from each pixel to its target.
void add_features(const std::vector<FeatureMarkMessage>& marks, Node::Array& layers) {
  const auto pixels_of = [](const std::vector<std::array<double, 2>>& list) {
    Pixels pixels;
    for (const auto& pixel : list) pixels.emplace_back(pixel[0], pixel[1]);
    return pixels;
  };
  Pixels seen_at, desired_at;
  std::vector<Pixels> between, seen_lines, desired_lines;
  for (const FeatureMarkMessage& mark : marks) {
    const Pixels is = pixels_of(mark.seen), shall = pixels_of(mark.desired);
    if (is.size() == 1 && shall.size() == 1) {
      seen_at.push_back(is[0]), desired_at.push_back(shall[0]), between.push_back({is[0], shall[0]});
    } else {
      seen_lines.push_back(is), desired_lines.push_back(shall);
    }
  }
  if (!between.empty())
    layers.push_back(lines_layer({features.id, features.label, features.color, ""}, between));
  add_marks(seen, false, seen_at, seen_lines, layers);
  add_marks(desired, true, desired_at, desired_lines, layers);
}

PictureLayers layers_of(const ServoPicture& picture) {
  const ServoObservationMessage& observation = picture.observation;
  PictureLayers overlay{observation.camera, picture.number, observation.reason.value_or(""), {}};
  std::vector<Eigen::Vector2d> line;
  line.reserve(std::max(observation.points.size(), observation.desired.size()));
  for (const AxisPointMessage& point : observation.points) line.emplace_back(point.u, point.v);
  if (!line.empty()) overlay.layers.push_back(line_layer(seen.id, seen.color, line));
  line.clear();
  // Dashed and on top: both stay visible where they coincide.
  for (const auto& pixel : observation.desired) line.emplace_back(pixel[0], pixel[1]);
  if (!line.empty()) overlay.layers.push_back(line_layer(desired.id, desired.color, line, true));
  if (observation.features) add_features(*observation.features, overlay.layers);
  return overlay;
}

std::string caption(const ServoStep& step) {
  std::string line = step.error ? fmt::format("error {:.2f} % of the length, at the tip {:.2f} %",
                                              100 * step.error->rms, 100 * step.error->tip)
                                : "the arm is not visible";
  if (!step.limited.empty()) line += "; limited by: " + step.limited;
  return line;
}

}  // namespace

Extras servo_extras(const ViewedRig& rig, const ShownServo& servo) {
  const ServoStep& step = servo.step;
  const Shapes shapes = shapes_of(rig, step);
  Extras extras;
  extras.time = step.time, extras.title = "Servo", extras.text = caption(step);
  extras.ghosts.push_back(ghost_of(desired, shapes.desired));
  extras.along_label = "Distance from target", extras.along_unit = "mm",
  extras.length = shapes.desired.arm.length();
  if (shapes.seen) {
    extras.ghosts.push_back(ghost_of(seen, *shapes.seen));
    extras.along.push_back(distances(seen, *shapes.seen, shapes.desired));
  }
  if (shapes.truth) {
    extras.ghosts.push_back(ghost_of(true_arm, *shapes.truth));
    extras.along.push_back(distances(true_arm, *shapes.truth, shapes.desired));
  }
  for (const ServoPicture& picture : servo.pictures) extras.overlays.push_back(layers_of(picture));
  const auto names = servo_quantities();
  const auto values = servo_values(step);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (values[i]) extras.values.emplace_back(names[i].name, *values[i]);
  return extras;
}

std::vector<Quantity> servo_quantities() {
  std::vector<Quantity> list;
  for (const char* name : {"servo_rms", "servo_tip", "servo_true_rms", "servo_true_tip"})
    list.push_back({name, "%", "servo_error"});
  return list;
}

std::vector<std::optional<double>> servo_values(const ServoStep& step) {
  std::vector<std::optional<double>> values(4);
  if (step.error) values[0] = 100 * step.error->rms, values[1] = 100 * step.error->tip;
  if (step.truth) values[2] = 100 * step.truth->error.rms, values[3] = 100 * step.truth->error.tip;
  return values;
}

}  // namespace flexura
