#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/log/messages.h"

namespace flexura {

// Log messages of a calibration (log/messages.h).

/// flexura.CalibrationMove, on /calibration/moves: a command of a calibration.
struct CalibrationMoveMessage {
  double time = 0;                                          ///< In s.
  std::string device;                                       ///< Commanded device: "arm", or a camera's name.
  std::optional<std::vector<std::array<double, 2>>> bends;  ///< Commanded bends of the arm, rad.
  std::optional<double> duration;                           ///< Duration of the arm's motion, s.
  std::optional<double> pan, tilt;                          ///< Commanded pan and tilt of a camera, rad.
  std::optional<double> zoom;                  ///< Commanded zoom: a position in the lens's zoom table.
  std::optional<std::array<double, 3>> stage;  ///< Commanded stage position, m.
};

/// flexura.CalibrationArc, on /calibration/arcs: an ideal arc for a camera, computed with the simulator.
struct CalibrationArcMessage {
  double time = 0;                           ///< In s.
  std::string camera;                        ///< Name of the camera.
  std::string plane;                         ///< "XOY" or "ZOY".
  std::vector<std::array<double, 2>> bends;  ///< Bends of the arm, rad.
  std::vector<double>
      rotations;  ///< Rotation of each section's bend direction about the axis of its base, rad.
  /// Motor positions, microsteps; missing for arms without drives.
  std::optional<std::vector<std::int64_t>> positions;
  PoseMessage pose;  ///< Pose of the ideal camera.
  double focal = 0;  ///< Focal length of the ideal camera, px.
};

/// A marker as measured in a picture.
struct MarkerMessage {
  double s = 0;         ///< Position along the unstretched arm, m.
  double u = 0, v = 0;  ///< Image position, px.
  double sigma = 0;     ///< Standard deviation in each direction, px.
};

/// Another number measured in a picture.
struct SeenValueMessage {
  std::string name;  ///< Name with the unit.
  double value = 0;
};

/// A circle through measured points.
struct CircleMessage {
  double u = 0, v = 0;  ///< Centre, px.
  double radius = 0;    ///< Radius, px.
  bool verified = false;
};

/// flexura.CalibrationObservation, on /calibration/observations: measurements in one picture.
struct CalibrationObservationMessage {
  double time = 0;        ///< Middle of the exposure, s.
  std::int64_t look = 0;  ///< Number of the view, from 1; 0 during the search for the arm.
  std::string camera;
  std::int64_t frame = 0;                    ///< Number of the frame.
  double pan = 0, tilt = 0;                  ///< Measured pan and tilt of the head, rad.
  double zoom = 1;                           ///< Measured zoom of the head.
  std::array<double, 3> stage = {0, 0, 0};   ///< Measured position of the stage, m.
  std::vector<std::array<double, 2>> bends;  ///< Bends measured by the drives, rad.
  std::vector<MarkerMessage> markers;
  std::vector<AxisPointMessage> points;  ///< Points of the centerline, from base to tip.
  std::int64_t unknown = 0;              ///< Number of observed markers that were not identified.
  std::optional<std::string> reason;     ///< Why the picture is unusable.
  std::optional<std::vector<SeenValueMessage>> values;  ///< Values measured by the paper's methods.
  std::optional<CircleMessage> circle;                  ///< Circle measured by the paper's methods.
  /// Image of the arm's axis that the ideal camera would observe, from base to tip, px; only for methods with
  /// arcs.
  std::optional<std::vector<std::array<double, 2>>> ideal;
};

/// flexura.CalibrationDecision, on /calibration/decisions: results after a view, and the next action.
struct CalibrationDecisionMessage {
  double time = 0;                    ///< In s.
  std::int64_t looks = 0;             ///< Number of views so far.
  bool found = false;                 ///< Whether a rig model was found that explains the observations.
  std::optional<std::string> reason;  ///< Why no rig model was found, or why the calibration ended early.
  double rms = 0;                     ///< RMS of the residuals, in standard deviations.
  std::int64_t outliers = 0;          ///< Number of outliers.
  double angle =
      0;  ///< Angle that the optical axes would have if the result of the calibration were commanded, rad.
  double angle_sigma = 0;                ///< Standard deviation of the angle between the optical axes, rad.
  std::array<double, 2> focal = {0, 0};  ///< Focal lengths, px.
  std::array<double, 2> focal_sigma = {0, 0};  ///< Relative standard deviations of the focal lengths.
  double zoom_ratio_sigma = 0;                 ///< Relative standard deviation of the zoom ratio.
  std::string next;                            ///< Next action in words.
  /// For the paper's methods: camera that moves, and step of the method.
  std::optional<std::string> camera, step;
  std::optional<double> offset, accepted;  ///< For the paper's methods: the offset and its tolerance.
  std::optional<std::string> unit;         ///< Unit of `offset` and `accepted`.
  std::optional<bool>
      ended;  ///< Whether this is the last message; `next` then states how the calibration ended.
};

inline constexpr std::string_view calibration_moves_topic = "/calibration/moves";
inline constexpr std::string_view calibration_arcs_topic = "/calibration/arcs";
inline constexpr std::string_view calibration_observations_topic = "/calibration/observations";
inline constexpr std::string_view calibration_decisions_topic = "/calibration/decisions";

const Table<CalibrationMoveMessage>& fields_of(const CalibrationMoveMessage*);
const Table<CalibrationArcMessage>& fields_of(const CalibrationArcMessage*);
const Table<CircleMessage>& fields_of(const CircleMessage*);
const Table<MarkerMessage>& fields_of(const MarkerMessage*);
const Table<SeenValueMessage>& fields_of(const SeenValueMessage*);
const Table<CalibrationObservationMessage>& fields_of(const CalibrationObservationMessage*);
const Table<CalibrationDecisionMessage>& fields_of(const CalibrationDecisionMessage*);

/// Returns the topic of the simulator's ideal images for a camera.
[[nodiscard]] std::string ideal_image_topic(std::string_view camera);

}  // namespace flexura
