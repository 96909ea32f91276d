#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/image.h"
#include "flexura/camera/camera_config.h"
#include "flexura/camera/view.h"
#include "flexura/control/limiter.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// Control law of a servo (docs/servo.md).
enum class ServoLawKind : std::uint8_t {
  shape,        ///< Shape estimated from both images, minus the target shape.
  points,       ///< Pixels of points along the arm.
  chords,       ///< Angles of the images of its chords.
  moments,      ///< Length, centroid and second moments of its images.
  potential,    ///< The paper's law: errors in two image planes, an artificial potential of two angles.
  silhouettes,  ///< Positions of the two edges of its images, across the edges.
  /// The estimated shape, by model predictive control of commands and swing (PredictiveLaw).
  predictive,
};

/// Returns true if a law compares chord angles, which optical flow may carry.
[[nodiscard]] constexpr bool has_chords(ServoLawKind law) {
  return law == ServoLawKind::chords || law == ServoLawKind::potential;
}

/// Source of the chord angles.
enum class ServoMeasure : std::uint8_t {
  picture,  ///< Each picture alone.
  flow,     ///< Previous picture plus optical flow, pulled towards each picture.
};

/// Model of how the arm follows its drives. The cameras give the features' derivatives by the shape.
enum class ServoJacobian : std::uint8_t {
  model,      ///< Nominal.
  broyden,    ///< Learned online (servo/drive_response.h), starting from the model.
  recursive,  ///< Learned online by recursive least squares, starting from the model.
};

/// Two pictures of the arm in the target shape, from the two cameras at their current axis positions.
using RecordedViews = std::array<Picture, 2>;

/// A target at a time.
struct ServoGoal {
  double time = 0;                              ///< s from the start of the servo.
  std::variant<ArmState, RecordedViews> shape;  ///< A state of the arm, or what the cameras observe of it.
  /// Distance of the nearest shape of this arm from the requested target, share of its length.
  double missed = 0;
};

/// Default prior of the camera models: the images of the base and of the arm beyond it determine their
/// errors.
struct ServoCameraPrior : ViewPrior {
  /// 0.02 rad, and 2 % of the focal length.
  ServoCameraPrior() : ViewPrior{.rotation_std = 0.02, .focal_std = 0.02} {}
};

/// Settings of a servo that a user chooses, in a file or in code.
struct ServoSettings {
  ServoLawKind law = ServoLawKind::shape;
  ServoMeasure measure = ServoMeasure::picture;  ///< For the laws that compare chord angles.
  double anchor = 0.1;  ///< Angles carried by flow approach the measured ones as exp(-t/anchor), s.
  ServoJacobian jacobian = ServoJacobian::model;
  std::int64_t points = 12;  ///< Number of places along the arm (points, chords, potential, silhouettes).
  double rate = 4;           ///< Errors fall as exp(-rate t), 1/s.
  double damping = 0.01;     ///< ImageLawGains::damping; not with `shape`.
  bool predict = true;       ///< What was sent after a picture was taken is counted as done.
  double tolerance = 0.005;  ///< Root mean square along the arm, share of its length: there.
  double settle = 0.5;       ///< The error has to stay below it for so long, s.
  double timeout = 20;       ///< To go on after the last goal's time, s.
  double hold_after = 0.3;   ///< Time without an observation after which the arm stops and waits, s.
  double give_up_after = 3;  ///< Time without an observation after which the servo fails, s.
  bool follow = false;       ///< Heads turn so that the arm stays in the middle of the pictures.
  ServoCameraPrior camera_prior;  ///< Of each camera model.
};

/// Configuration of a servo: its settings, and data of the rig and the arm.
struct ServoConfig : ServoSettings {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Indices in the rig. The law `potential` uses the first as
                                                ///< front (XOY) and the second as side view.
  std::vector<ServoGoal> goals;      ///< At least one, with increasing times from 0; interpolated linearly.
  std::vector<double> markers = {};  ///< Middles of the arm's bands, m along the unstretched arm, increasing.
  double step = 1.0 / 30;            ///< Time between commands, s.
  bool keeps_steps = true;           ///< Keep ServoResult::steps, which grow with the duration.
  std::optional<Drive> drive = {};   ///< Drive for the limiter (LimiterConfig).
  double list_step = 0;              ///< Step of the limiter's command list, s.
  /// Last commanded state, if known. Drives report it only in their steps.
  std::optional<ArmState> sent = {};
  std::vector<Obstacle> obstacles = {};
};

const Table<ServoCameraPrior>& fields_of(const ServoCameraPrior*);

const std::vector<std::string>& names_of(const ServoLawKind*);
const std::vector<std::string>& names_of(const ServoMeasure*);
const std::vector<std::string>& names_of(const ServoJacobian*);

/// Throws std::invalid_argument, with the reason, if no servo can do this task with any rig.
void check_servo(const ServoConfig& config);

/// Returns the frame rate of the slower of these two cameras, Hz: within its frame time each camera takes a
/// picture.
[[nodiscard]] double slower_frame_rate(const std::vector<CameraConfig>& cameras,
                                       const std::array<std::size_t, 2>& two);

/// Returns the configuration of the limiter behind the law.
[[nodiscard]] LimiterConfig limiter_config(const ServoConfig& config);

}  // namespace flexura
