#include "flexura/view/calibration_extras.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace flexura {
namespace {

const LayerMark measured{"calibration-seen", "Seen", "#22b8cf", ""},
    marks{"calibration-marks", "Markers", "#da77f2", ""},
    ideal_arc{"calibration-ideal", "Ideal", "#ff922b", ""},
    fitted{"calibration-circle", "Circle", "#51cf66", ""};

using Curve = std::vector<Eigen::Vector2d>;

Curve circle_of(const CircleMessage& circle) {
  constexpr int sides = 72;
  Curve curve;
  for (int i = 0; i <= sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    curve.emplace_back(circle.u + circle.radius * std::cos(angle),
                       circle.v + circle.radius * std::sin(angle));
  }
  return curve;
}

PictureLayers layers_of(const CalibrationPicture& picture) {
  const CalibrationObservationMessage& observation = picture.observation;
  PictureLayers overlay{observation.camera, picture.number, observation.reason.value_or(""), {}};
  Curve seen_at, marks_at, ideal_at;
  for (const AxisPointMessage& point : observation.points) seen_at.emplace_back(point.u, point.v);
  for (const MarkerMessage& marker : observation.markers) marks_at.emplace_back(marker.u, marker.v);
  if (observation.ideal)
    for (const auto& pixel : *observation.ideal) ideal_at.emplace_back(pixel[0], pixel[1]);
  if (observation.circle) overlay.layers.push_back(lines_layer(fitted, {circle_of(*observation.circle)}));
  if (!seen_at.empty()) overlay.layers.push_back(points_layer(measured, seen_at));
  if (!marks_at.empty()) overlay.layers.push_back(points_layer(marks, marks_at));
  if (!ideal_at.empty()) overlay.layers.push_back(lines_layer(ideal_arc, {ideal_at}, true));
  return overlay;
}

std::string caption(const CalibrationDecisionMessage& decision) {
  if (decision.step)
    return fmt::format("{} of {}: offset {:.4g} {}; {}", *decision.step, decision.camera.value_or(""),
                       decision.offset.value_or(0), decision.unit.value_or(""), decision.next);
  const std::string known = decision.found
                                ? fmt::format("standard deviation of the angle between the axes: {:.4f} deg",
                                              decision.angle_sigma * 180 / std::numbers::pi)
                                : decision.reason.value_or("no rig was found");
  return fmt::format("after {} views: {}{}{}", decision.looks, known,
                     decision.next.empty() ? "" : "; next: ", decision.next);
}

}  // namespace

Extras calibration_extras(const ShownCalibration& calibration) {
  Extras extras;
  extras.title = "Calibration", extras.text = "first view";
  if (calibration.decision)
    extras.time = calibration.decision->time, extras.text = caption(*calibration.decision);
  for (const CalibrationPicture& picture : calibration.pictures) {
    extras.time = std::max(extras.time, picture.observation.time);
    extras.overlays.push_back(layers_of(picture));
  }
  return extras;
}

}  // namespace flexura
