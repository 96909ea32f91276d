#include "flexura/tasks/calibrate/calibration_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<CalibrationMoveMessage>& fields_of(const CalibrationMoveMessage*) {
  using M = CalibrationMoveMessage;
  static const auto table =
      Table<M>("flexura.CalibrationMove", "Command of a calibration.")
          .field("time", &M::time, {.meaning = "Time of the command since the experiment's start, s."})
          .field("device", &M::device, {.meaning = "Commanded device: \"arm\", or the name of a camera."})
          .field("bends", &M::bends, {.meaning = "For the arm: bend of each section, rad, from the base."})
          .field("duration", &M::duration, {.meaning = "For the arm: duration of the motion, s."})
          .field("pan", &M::pan, {.meaning = "For a camera: pan, rad; positive to its left."})
          .field("tilt", &M::tilt, {.meaning = "For a camera: tilt, rad; positive upwards."})
          .field("zoom", &M::zoom, {.meaning = "For a camera: zoom, as a ratio or as a motor position."})
          .field("stage", &M::stage, {.meaning = "For a camera: offset of the stage, m."});
  return table;
}

const Table<CalibrationArcMessage>& fields_of(const CalibrationArcMessage*) {
  using M = CalibrationArcMessage;
  static const auto table =
      Table<M>("flexura.CalibrationArc", "Ideal arc of the arm for a camera, computed with the simulator.")
          .field("time", &M::time, {.meaning = "Time of the computation since the experiment's start, s."})
          .field("camera", &M::camera, {.meaning = "Name of the camera."})
          .field("plane", &M::plane, {.meaning = "Plane of the arc, \"XOY\" or \"ZOY\"."})
          .field("bends", &M::bends, {.meaning = "Bend of each section, rad, from the base."})
          .field("rotations", &M::rotations,
                 {.meaning = "Rotation of each bend's direction about the axis of its section's base, from x "
                             "towards y, rad."})
          .field("positions", &M::positions,
                 {.meaning = "Commanded position of each motor for this arc, microsteps."})
          .field("pose", &M::pose, {.meaning = "Pose of the ideal camera in the world."})
          .field("focal", &M::focal, {.meaning = "Focal length of the ideal camera, px."});
  return table;
}

const Table<CircleMessage>& fields_of(const CircleMessage*) {
  using M = CircleMessage;
  static const auto table =
      Table<M>("flexura.Circle", "Circle through points of the median axis.")
          .field("u", &M::u, {.meaning = "Column of the centre, px."})
          .field("v", &M::v, {.meaning = "Row of the centre, px."})
          .field("radius", &M::radius, {.meaning = "px."})
          .field("verified", &M::verified, {.meaning = "Whether the points satisfy the circle's equation."});
  return table;
}

const Table<MarkerMessage>& fields_of(const MarkerMessage*) {
  using M = MarkerMessage;
  static const auto table =
      Table<M>("flexura.Marker", "Measured marker in a picture.")
          .field("s", &M::s, {.meaning = "Position of the marker along the unstretched arm, m."})
          .field("u", &M::u, {.meaning = "Column, px."})
          .field("v", &M::v, {.meaning = "Row, px."})
          .field("sigma", &M::sigma, {.meaning = "Standard deviation, px."});
  return table;
}

const Table<SeenValueMessage>& fields_of(const SeenValueMessage*) {
  using M = SeenValueMessage;
  static const auto table =
      Table<M>("flexura.SeenValue", "Number measured in a picture.")
          .field("name", &M::name, {.meaning = "Name of the measured number, with its unit."})
          .field("value", &M::value, {.meaning = "The number."});
  return table;
}

const Table<CalibrationObservationMessage>& fields_of(const CalibrationObservationMessage*) {
  using M = CalibrationObservationMessage;
  static const auto table =
      Table<M>("flexura.CalibrationObservation", "Measurements of a calibration in one picture.")
          .field("time", &M::time, {.meaning = "Middle of the exposure, since the experiment's start, s."})
          .field("look", &M::look,
                 {.meaning = "Number of the view, from 1; 0 during the search for the arm."})
          .field("camera", &M::camera, {.meaning = "Name of the camera."})
          .field("frame", &M::frame, {.meaning = "Number of the frame."})
          .field("pan", &M::pan, {.meaning = "Measured pan of the head, rad."})
          .field("tilt", &M::tilt, {.meaning = "Measured tilt of the head, rad."})
          .field("zoom", &M::zoom, {.meaning = "Measured zoom of the head."})
          .field("stage", &M::stage, {.meaning = "Measured position of the stage, m."})
          .field("bends", &M::bends, {.meaning = "Measured bend of each section by the drives, rad."})
          .field("markers", &M::markers, {.meaning = "Identified markers."})
          .field("points", &M::points,
                 {.meaning = "Independent points of the median axis, from base to tip."})
          .field("unknown", &M::unknown, {.meaning = "Number of detected markers that were not identified."})
          .field("reason", &M::reason, {.meaning = "Why the picture is not usable."})
          .field("values", &M::values, {.meaning = "Values measured by the paper's methods."})
          .field("circle", &M::circle,
                 {.meaning = "Circle through the points, measured by the paper's methods."})
          .field("ideal", &M::ideal,
                 {.meaning = "For methods with arcs: image of the arm's axis in the ideal camera, from base "
                             "to tip, px."});
  return table;
}

const Table<CalibrationDecisionMessage>& fields_of(const CalibrationDecisionMessage*) {
  using M = CalibrationDecisionMessage;
  static const auto table =
      Table<M>("flexura.CalibrationDecision",
               "Estimate of a calibration after a view by both cameras, and the calibration's next action.")
          .field("time", &M::time, {.meaning = "Time since the experiment's start, s."})
          .field("looks", &M::looks, {.meaning = "Number of views so far."})
          .field("found", &M::found,
                 {.meaning = "Whether a rig model was found that explains the observations."})
          .field("reason", &M::reason, {.meaning = "Why no rig model was found."})
          .field("rms", &M::rms, {.meaning = "Root mean square of the residuals, in standard deviations."})
          .field("outliers", &M::outliers,
                 {.meaning = "Number of observations that were excluded as outliers."})
          .field("angle", &M::angle,
                 {.meaning =
                      "Angle that the optical axes would have if the present result were commanded, rad."})
          .field("angle_sigma", &M::angle_sigma,
                 {.meaning = "Standard deviation of the angle between the optical axes, rad."})
          .field("focal", &M::focal, {.meaning = "Focal lengths of both cameras at the zoom ratio 1, px."})
          .field("focal_sigma", &M::focal_sigma,
                 {.meaning = "Relative standard deviations of the focal lengths."})
          .field(
              "zoom_ratio_sigma", &M::zoom_ratio_sigma,
              {.meaning = "Relative standard deviation of the ratio of the arm's sizes in the two pictures."})
          .field("next", &M::next, {.meaning = "Next action, with its reason."})
          .field("camera", &M::camera, {.meaning = "For the paper's methods: the camera that moves."})
          .field("step", &M::step, {.meaning = "For the paper's methods: the current step."})
          .field("offset", &M::offset, {.meaning = "For the paper's methods: the measured offset."})
          .field("accepted", &M::accepted,
                 {.meaning = "For the paper's methods: the tolerance of the offset."})
          .field("unit", &M::unit, {.meaning = "Unit of `offset` and `accepted`."})
          .field(
              "ended", &M::ended,
              {.meaning = "Whether this is the last message; `next` then states how the calibration ended."});
  return table;
}

std::string ideal_image_topic(std::string_view camera) { return "/calibration/ideal/" + std::string(camera); }

}  // namespace flexura
