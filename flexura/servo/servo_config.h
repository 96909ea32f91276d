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
  shape,        ///< Difference between the shape estimated from both images and the target shape.
  points,       ///< Pixels of points along the arm.
  chords,       ///< Directions of the arm's chords in the images, as angles.
  moments,      ///< Length, centroid and second moments of the arm's images.
  potential,    ///< The paper's law: errors in two image planes, an artificial potential of two angles.
  silhouettes,  ///< Positions of the two edges of the arm's images, perpendicular to the edges.
  /// The estimated shape, by model predictive control of commands and swing (PredictiveLaw).
  predictive,
  computed_torque,  ///< The estimated shape, by the forces in the modes of the arm's swing (ModalLaw).
  shape_potential,  ///< The estimated shape, by an artificial potential of the shape's error with
                    ///< dissipation.
};

/// Returns true if a law compares angles of chords, so that optical flow can carry them.
[[nodiscard]] constexpr bool has_chords(ServoLawKind law) {
  return law == ServoLawKind::chords || law == ServoLawKind::potential;
}

/// Returns true for laws that predict the arm's motion by its model, swing included (ModelLaw).
[[nodiscard]] constexpr bool predicts_motion(ServoLawKind law) {
  return law == ServoLawKind::predictive || law == ServoLawKind::computed_torque ||
         law == ServoLawKind::shape_potential;
}

/// Source of the chord angles.
enum class ServoMeasure : std::uint8_t {
  picture,  ///< Each picture alone.
  flow,     ///< Angle of the previous picture plus its change by optical flow, corrected towards the angle in
            ///< each new picture.
};

/// Model of how the arm's shape follows its drives. The derivatives of features with respect to the shape
/// always follow from the camera models.
enum class ServoJacobian : std::uint8_t {
  model,      ///< Nominal model of the arm.
  broyden,    ///< Learned online (servo/drive_response.h), starting from the model.
  recursive,  ///< Learned online by recursive least squares, starting from the model.
};

/// Two pictures of the arm in the target shape, from the two cameras at their current axis positions.
using RecordedViews = std::array<Picture, 2>;

/// A target at a time.
struct ServoGoal {
  double time = 0;  ///< Time from the start of the servo, s.
  std::variant<ArmState, RecordedViews>
      shape;  ///< Target shape as a state of the arm, or as pictures of the arm in that shape.
  /// Distance between the requested target and the nearest shape of this arm, as a share of its length.
  double missed = 0;
};

/// Default prior of the errors of the camera models, which the servo estimates from the pictures of the arm
/// and its base.
struct ServoCameraPrior : ViewPrior {
  /// Standard deviations of 0.02 rad, and 2 % of the focal length.
  ServoCameraPrior() : ViewPrior{.rotation_std = 0.02, .focal_std = 0.02} {}
};

/// Settings of a servo that a user chooses, in a file or in code.
struct ServoSettings {
  ServoLawKind law = ServoLawKind::shape;
  ServoMeasure measure =
      ServoMeasure::picture;  ///< Source of the angles, for the laws that compare chord angles.
  double anchor = 0.1;  ///< Time constant with which angles carried by flow approach the measured ones, s.
  ServoJacobian jacobian = ServoJacobian::model;
  std::int64_t points = 12;  ///< Number of places along the arm, for the laws `points`, `chords`, `potential`
                             ///< and `silhouettes`.
  double rate = 4;           ///< Rate at which errors decay, as exp(-rate t), 1/s.
  double damping = 0.01;     ///< ImageLawGains::damping; not used by the law `shape`.
  bool predict = true;       ///< Whether the law takes commands sent after a picture was taken as executed.
  double tolerance =
      0.005;  ///< Largest error at the target: root mean square along the arm, as a share of its length.
  double settle = 0.5;  ///< Time for which the error has to stay below `tolerance`, s.
  double timeout =
      20;  ///< Time after the last goal at which the servo fails if the target is not reached, s.
  double hold_after = 0.3;   ///< Time without an observation after which the arm stops and waits, s.
  double give_up_after = 3;  ///< Time without an observation after which the servo fails, s.
  /// Unexplained change of the arm's shape at which the servo holds the arm, root mean square along the arm,
  /// share of its length (DisturbanceWatch). Empty: 0.05 for an arm with a model that swings and no learned
  /// Jacobian, otherwise not watched.
  std::optional<double> disturbance = {};
  bool follow = false;            ///< Whether the heads turn to keep the arm in the middle of the pictures.
  ServoCameraPrior camera_prior;  ///< Prior of the errors of each camera model.
};

/// Configuration of a servo: its settings, and data of the rig and the arm.
struct ServoConfig : ServoSettings {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Indices in the rig. The law `potential` uses the first as
                                                ///< front (XOY) and the second as side view.
  std::vector<ServoGoal>
      goals;  ///< Targets, at least one, with increasing times from 0; interpolated linearly.
  std::vector<double> markers = {};  ///< Middles of the arm's bands, m along the unstretched arm, increasing.
  double step = 1.0 / 30;            ///< Time between commands, s.
  bool keeps_steps = true;  ///< Whether to keep ServoResult::steps, whose number grows with the duration.
  std::optional<Drive> drive = {};  ///< Drive for the limiter (LimiterConfig).
  double list_step = 0;             ///< Step of the limiter's command list, s.
  /// Last commanded state, if known. Readings of drives give it only rounded to steps.
  std::optional<ArmState> sent = {};
  std::vector<Obstacle> obstacles = {};
};

const Table<ServoCameraPrior>& fields_of(const ServoCameraPrior*);

const std::vector<std::string>& names_of(const ServoLawKind*);
const std::vector<std::string>& names_of(const ServoMeasure*);
const std::vector<std::string>& names_of(const ServoJacobian*);

/// Throws std::invalid_argument, with the reason, if the configuration is invalid for every rig.
void check_servo(const ServoConfig& config);

/// Returns the frame rate of the slower of two cameras, Hz. Both cameras take a picture within one period of
/// this rate.
[[nodiscard]] double slower_frame_rate(const std::vector<CameraConfig>& cameras,
                                       const std::array<std::size_t, 2>& two);

/// Returns the configuration of the limiter that checks the law's commands.
[[nodiscard]] LimiterConfig limiter_config(const ServoConfig& config);

}  // namespace flexura
