#include "flexura/tasks/calibrate/calibration_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<CalibrationMoveMessage>& fields_of(const CalibrationMoveMessage*) {
  using M = CalibrationMoveMessage;
  static const auto table =
      Table<M>("flexura.CalibrationMove", "A command of a calibration.")
          .field("time", &M::time, {.meaning = "When it was given, since the experiment's start, s."})
          .field("device", &M::device, {.meaning = "\"arm\", or a camera's name."})
          .field("bends", &M::bends, {.meaning = "The arm: each section's bend, rad, base first."})
          .field("duration", &M::duration, {.meaning = "The arm: time of its way there, s."})
          .field("pan", &M::pan, {.meaning = "A camera: rad, to its left."})
          .field("tilt", &M::tilt, {.meaning = "A camera: rad, upwards."})
          .field("zoom", &M::zoom, {.meaning = "A camera: a ratio or a motor count."})
          .field("stage", &M::stage, {.meaning = "A camera: its stage's offset, m."});
  return table;
}

const Table<CalibrationArcMessage>& fields_of(const CalibrationArcMessage*) {
  using M = CalibrationArcMessage;
  static const auto table =
      Table<M>("flexura.CalibrationArc", "What the simulator has of an arc that a camera is to look at.")
          .field("time", &M::time, {.meaning = "When it was worked out, since the experiment's start, s."})
          .field("camera", &M::camera, {.meaning = "The camera's name."})
          .field("plane", &M::plane, {.meaning = "In which the arc lies, \"XOY\" or \"ZOY\"."})
          .field("bends", &M::bends, {.meaning = "Each section's bend, rad, base first."})
          .field("rotations", &M::rotations,
                 {.meaning = "How each bend is rotated about its section's base, from x towards y, rad."})
          .field("positions", &M::positions,
                 {.meaning = "The drives' commands: where each motor will be sent for it, microsteps."})
          .field("pose", &M::pose, {.meaning = "Of the ideal camera, in the world."})
          .field("focal", &M::focal, {.meaning = "Its focal length, px."});
  return table;
}

const Table<CircleMessage>& fields_of(const CircleMessage*) {
  using M = CircleMessage;
  static const auto table =
      Table<M>("flexura.Circle", "A circle through points of the median axis.")
          .field("u", &M::u, {.meaning = "Its centre's column, px."})
          .field("v", &M::v, {.meaning = "Its centre's row, px."})
          .field("radius", &M::radius, {.meaning = "px."})
          .field("verified", &M::verified, {.meaning = "Whether the points verify its equation."});
  return table;
}

const Table<MarkerMessage>& fields_of(const MarkerMessage*) {
  using M = MarkerMessage;
  static const auto table = Table<M>("flexura.Marker", "A marker where it was seen.")
                                .field("s", &M::s, {.meaning = "Its place along the unstretched arm, m."})
                                .field("u", &M::u, {.meaning = "Column, px."})
                                .field("v", &M::v, {.meaning = "Row, px."})
                                .field("sigma", &M::sigma, {.meaning = "Standard deviation, px."});
  return table;
}

const Table<SeenValueMessage>& fields_of(const SeenValueMessage*) {
  using M = SeenValueMessage;
  static const auto table = Table<M>("flexura.SeenValue", "A number that was read off a picture.")
                                .field("name", &M::name, {.meaning = "What it is, with its unit."})
                                .field("value", &M::value, {.meaning = "The number."});
  return table;
}

const Table<CalibrationObservationMessage>& fields_of(const CalibrationObservationMessage*) {
  using M = CalibrationObservationMessage;
  static const auto table =
      Table<M>("flexura.CalibrationSighting", "What a calibration measured in one picture.")
          .field("time", &M::time, {.meaning = "Middle of the exposure, since the experiment's start, s."})
          .field("look", &M::look, {.meaning = "Number of the look, from 1; 0: the arm is looked for."})
          .field("camera", &M::camera, {.meaning = "The camera's name."})
          .field("frame", &M::frame, {.meaning = "The frame's number."})
          .field("pan", &M::pan, {.meaning = "Measured pan of the head, rad."})
          .field("tilt", &M::tilt, {.meaning = "Measured tilt of the head, rad."})
          .field("zoom", &M::zoom, {.meaning = "Measured zoom of the head."})
          .field("stage", &M::stage, {.meaning = "Measured position of the stage, m."})
          .field("bends", &M::bends, {.meaning = "Measured bend of each section by the drives, rad."})
          .field("markers", &M::markers, {.meaning = "The markers that were recognised."})
          .field("points", &M::points, {.meaning = "Independent points of the median axis, base to tip."})
          .field("unknown", &M::unknown, {.meaning = "How many markers were not recognised."})
          .field("reason", &M::reason, {.meaning = "Why the picture is of no use."})
          .field("values", &M::values, {.meaning = "What the paper's methods measured."})
          .field("circle", &M::circle,
                 {.meaning = "The circle through the points, as the paper's methods measured it."})
          .field(
              "ideal", &M::ideal,
              {.meaning = "Methods with arcs: where the ideal camera would see the axis, base to tip, px."});
  return table;
}

const Table<CalibrationDecisionMessage>& fields_of(const CalibrationDecisionMessage*) {
  using M = CalibrationDecisionMessage;
  static const auto table =
      Table<M>("flexura.CalibrationDecision", "What a calibration knows after a look, and does next.")
          .field("time", &M::time, {.meaning = "Time since the experiment's start, s."})
          .field("looks", &M::looks, {.meaning = "Looks up to now."})
          .field("found", &M::found, {.meaning = "Whether a rig explains what was seen."})
          .field("reason", &M::reason, {.meaning = "Why there is no rig."})
          .field("rms", &M::rms, {.meaning = "Root mean square of the residuals, in standard deviations."})
          .field("doubts", &M::outliers, {.meaning = "Observations that were left out as outliers."})
          .field("angle", &M::angle,
                 {.meaning = "Between the optical axes where the cameras would be sent now, rad."})
          .field("angle_sigma", &M::angle_sigma, {.meaning = "Its standard deviation, rad."})
          .field("focal", &M::focal, {.meaning = "Both focal lengths at ratio 1, px."})
          .field("focal_sigma", &M::focal_sigma, {.meaning = "Their standard deviations, shares."})
          .field("zoom_ratio_sigma", &M::zoom_ratio_sigma,
                 {.meaning = "Of how much larger one camera shows the arm than the other, a share."})
          .field("next", &M::next, {.meaning = "What is done next, and why."})
          .field("camera", &M::camera, {.meaning = "The paper's methods only: the camera that they move."})
          .field("step", &M::step, {.meaning = "The paper's methods only: the current step."})
          .field("offset", &M::offset, {.meaning = "The paper's methods only: the remaining error."})
          .field("accepted", &M::accepted, {.meaning = "The paper's methods only: the accepted error."})
          .field("unit", &M::unit, {.meaning = "Unit of offset and accepted."})
          .field("ended", &M::ended, {.meaning = "Whether the step is over (see next)."});
  return table;
}

std::string ideal_image_topic(std::string_view camera) { return "/calibration/ideal/" + std::string(camera); }

}  // namespace flexura
