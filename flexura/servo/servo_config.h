#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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

struct ArmScene;

/// Control law of a servo (docs/servo.md).
enum class ServoLawKind : std::uint8_t {
  shape,    ///< Difference between the shape estimated from both images and the target shape.
  points,   ///< Pixels of points along the arm.
  chords,   ///< Directions of the arm's chords in the images, as angles.
  moments,  ///< Length, centroid and second moments of the arm's images.
  /// The paper's law: an artificial potential of two angles, whose errors are measured in two image planes.
  potential,
  silhouettes,  ///< Positions of the two edges of the arm's images, perpendicular to the edges.
  /// The estimated shape, by model predictive control that includes the arm's oscillation (PredictiveLaw).
  predictive,
  /// The estimated shape, by computed forces in the modes of the arm's oscillation (ModalLaw).
  computed_torque,
  shape_potential,  ///< The estimated shape, by an artificial potential of its error, with dissipation.
};

/// Returns true if a law compares angles of chords. Optical flow can track these angles.
[[nodiscard]] constexpr bool has_chords(ServoLawKind law) {
  return law == ServoLawKind::chords || law == ServoLawKind::potential;
}

/// Returns true for laws that predict the arm's motion, including its oscillation, with a model (ModelLaw).
[[nodiscard]] constexpr bool predicts_motion(ServoLawKind law) {
  return law == ServoLawKind::predictive || law == ServoLawKind::computed_torque ||
         law == ServoLawKind::shape_potential;
}

/// Source of the chord angles.
enum class ServoMeasure : std::uint8_t {
  picture,  ///< Each picture is measured by itself.
  flow,  ///< Sum of the angle in the previous picture and its change by optical flow, corrected towards the
         ///< angle in each new picture.
};

/// Way to find the arm in a picture.
enum class ServoTracking : std::uint8_t {
  finder,  ///< By its brightness, and by what separates it from its surroundings (ServoConfig::scenes).
  model,   ///< The tube of the predicted shape is fitted to the pictures (TubeFitter); then as `finder`.
};

/// Source of the derivative of the arm's shape with respect to its drives. The derivatives of features with
/// respect to the shape are always computed from the camera models.
enum class ServoJacobian : std::uint8_t {
  model,      ///< Nominal model of the arm.
  broyden,    ///< Learned online (servo/drive_response.h), starting from the model.
  recursive,  ///< Learned online by recursive least squares, starting from the model.
};

/// Pictures of the arm in the target shape by the two cameras, at the cameras' current axis positions.
using RecordedViews = std::array<Picture, 2>;

/// A target at a time.
struct ServoGoal {
  double time = 0;  ///< Time from the servo's start, s.
  std::variant<ArmState, RecordedViews>
      shape;  ///< Target shape as a state of the arm, or as pictures of the arm in that shape.
  /// Distance between the requested target and the nearest shape that the arm can take, share of the arm's
  /// length.
  double missed = 0;
};

/// Default prior of the camera models' errors. The servo estimates these errors from the pictures of the arm
/// and its base.
struct ServoCameraPrior : ViewPrior {
  /// The default standard deviations are 0.02 rad for rotations and 2 % for the focal length.
  ServoCameraPrior() : ViewPrior{.rotation_std = 0.02, .focal_std = 0.02} {}
};

/// Settings of a servo that a user chooses, in a file or in code.
struct ServoSettings {
  ServoLawKind law = ServoLawKind::shape;
  ServoTracking track = ServoTracking::finder;
  ServoMeasure measure = ServoMeasure::picture;  ///< Source of the chord angles, for laws that compare them.
  double anchor = 0.1;  ///< Time constant with which angles tracked by flow approach the measured angles, s.
  ServoJacobian jacobian = ServoJacobian::model;
  /// Number of points along the arm, for the laws `points`, `chords`, `potential` and `silhouettes`.
  std::int64_t points = 12;
  double rate = 4;        ///< Rate at which errors decay, as exp(-rate t), 1/s.
  double damping = 0.01;  ///< ImageLawGains::damping; not used by the law `shape`.
  /// Whether the law predicts the effect of commands that were sent after the picture was taken.
  bool predict = true;
  double tolerance =
      /// Largest error at which the target counts as reached: root mean square along the arm, share of its
      /// length.
      0.005;
  double settle = 0.5;  ///< Time for which the error has to stay below `tolerance`, s.
  double timeout =
      /// Time after the last target's time at which the servo fails if it has not reached the target, s.
      20;
  double hold_after = 0.3;   ///< Time without an observation after which the arm stops and waits, s.
  double give_up_after = 3;  ///< Time without an observation after which the servo fails, s.
  /// Change of the arm's shape, not explained by the drives' motion, above which the servo stops the arm. RMS
  /// along the arm, as a share of its length (DisturbanceWatch). Default:
  /// 0.05 for an arm with a dynamic model and the Jacobian
  /// `model`; otherwise such changes are not detected.
  std::optional<double> disturbance = {};
  bool follow = false;            ///< Whether the heads turn and zoom to keep the arm in the pictures.
  ServoCameraPrior camera_prior;  ///< Prior of the errors of each camera model.
};

/// Configuration of a servo: its settings, and data of the rig and the arm.
struct ServoConfig : ServoSettings {
  /// Indices of the cameras in the rig. The law `potential` uses the first camera as the view of XOY and the
  /// second as the view of ZOY.
  std::array<std::size_t, 2> cameras = {0, 1};
  std::vector<ServoGoal>
      /// At least one target, with times that increase from 0. Between these times, targets are interpolated
      /// linearly.
      goals;
  /// Increasing arc lengths of the middles of the arm's bands on the unstretched arm, m.
  std::vector<double> markers = {};
  double step = 1.0 / 30;  ///< Time between commands, s.
  bool keeps_steps =
      true;  ///< Whether to keep ServoResult::steps. The memory of these steps grows with the duration.
  std::optional<Drive> drive = {};  ///< Drive for the limiter (LimiterConfig).
  double list_step = 0;             ///< LimiterConfig::list_step, s.
  /// Last commanded state, if known. This state is more exact than readings of the drives, which are rounded
  /// to motor steps.
  std::optional<ArmState> sent = {};
  std::vector<Obstacle> obstacles = {};
  /// What separates the arm from its surroundings, for both cameras; null: brightness alone.
  std::array<std::shared_ptr<const ArmScene>, 2> scenes = {};
};

const Table<ServoCameraPrior>& fields_of(const ServoCameraPrior*);

const std::vector<std::string>& names_of(const ServoLawKind*);
const std::vector<std::string>& names_of(const ServoTracking*);
const std::vector<std::string>& names_of(const ServoMeasure*);
const std::vector<std::string>& names_of(const ServoJacobian*);

/// Throws std::invalid_argument, with the reason, for values that are invalid for every rig.
void check_servo(const ServoConfig& config);

/// Returns the frame rate of the slower of two cameras, Hz. Within one period of this rate, both cameras take
/// a picture.
[[nodiscard]] double slower_frame_rate(const std::vector<CameraConfig>& cameras,
                                       const std::array<std::size_t, 2>& two);

/// Returns the configuration of the limiter that checks the law's commands.
[[nodiscard]] LimiterConfig limiter_config(const ServoConfig& config);

}  // namespace flexura
