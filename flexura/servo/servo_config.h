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

/// What drives the arm to the wanted shape (docs/servo.md).
enum class ServoLawKind : std::uint8_t {
  shape,        ///< The shape that both images tell, less the wanted one.
  points,       ///< Pixels of points along the arm.
  chords,       ///< Angles of the images of its chords.
  moments,      ///< Length, middle and second moments of its images.
  potential,    ///< The paper's: the errors in two image planes, an artificial potential in two angles.
  silhouettes,  ///< Where the two edges of its images lie across themselves.
};

/// Whether a law looks at chords' angles, which flow may carry.
[[nodiscard]] constexpr bool has_chords(ServoLawKind law) {
  return law == ServoLawKind::chords || law == ServoLawKind::potential;
}

/// Where the angles of chords come from.
enum class ServoMeasure : std::uint8_t {
  picture,  ///< Each picture by itself.
  flow,     ///< The picture before and the optical flow since, drawn back to each picture.
};

/// How the arm follows its drives; what its shape shows is known from the cameras.
enum class ServoJacobian : std::uint8_t {
  model,      ///< As they are believed to be.
  broyden,    ///< Learned on the way (servo/drive_response.h), beginning with the model's.
  recursive,  ///< Likewise, by recursive least squares.
};

/// Two pictures of the arm in the wanted shape, by the two cameras as they stand.
using RecordedViews = std::array<Picture, 2>;

/// What is wanted from a time on.
struct ServoGoal {
  double time = 0;                              ///< s from the start of the servo.
  std::variant<ArmState, RecordedViews> shape;  ///< A state of the arm, or what the cameras see of it then.
  /// How far the nearest shape of this arm is from what was asked for, share of its length.
  double missed = 0;
};

/// Default prior of the camera models: the images of the base and of the arm beyond it determine their
/// errors.
struct ServoDoubt : ViewDoubt {
  /// 0.02 rad, and 2 % of the focal length.
  ServoDoubt() : ViewDoubt{.rotation_std = 0.02, .focal_std = 0.02} {}
};

/// What whoever wants a servo settles of it, in a file or in code.
struct ServoSettings {
  ServoLawKind law = ServoLawKind::shape;
  ServoMeasure measure = ServoMeasure::picture;  ///< For the laws that look at chords' angles.
  double anchor = 0.1;  ///< Angles that flow carries are drawn back as exp(-t/anchor), s.
  ServoJacobian jacobian = ServoJacobian::model;
  std::int64_t points = 12;  ///< Of the laws points, chords, potential and silhouettes: places along the arm.
  double rate = 4;           ///< Errors fall as exp(-rate t), 1/s.
  double damping = 0.01;     ///< ImageLawGains::damping; not with `shape`.
  bool predict = true;       ///< What was sent after a picture was taken is counted as done.
  double tolerance = 0.005;  ///< Root mean square along the arm, share of its length: there.
  double settle = 0.5;       ///< The error has to stay below it for so long, s.
  double timeout = 20;       ///< To go on after the last goal's time, s.
  double hold_after = 0.3;   ///< Time without an observation after which the arm stops and waits, s.
  double give_up_after = 3;  ///< Time without an observation after which the servo fails, s.
  bool follow = false;       ///< Heads turn so that the arm stays in the middle of the pictures.
  ServoDoubt camera_prior;   ///< Of each camera model.
};

/// What a servo does: its settings, and what the rig and the arm make of the rest.
struct ServoConfig : ServoSettings {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Places among the rig's; the law `potential` takes the
                                                ///< first for the front (XOY) and the second for the side.
  std::vector<ServoGoal>
      goals;  ///< At least one, times rising from 0; in straight lines from one to the next.
  std::vector<double> markers = {};  ///< Middles of the arm's bands, m along the unstretched arm, rising.
  double step = 1.0 / 30;            ///< From one command to the next, s.
  bool keeps_steps = true;  ///< ServoResult::steps; of a servo that goes on for days they grow for as long.
  std::optional<Drive> drive = {};  ///< For the limiter (LimiterConfig),
  double list_step = 0;             ///< and its command list's step, s.
  /// Where the arm was sent before, if that is known: drives say that to their own steps alone.
  std::optional<ArmState> sent = {};
  std::vector<Obstacle> obstacles = {};
};

const Table<ServoDoubt>& fields_of(const ServoDoubt*);

const std::vector<std::string>& names_of(const ServoLawKind*);
const std::vector<std::string>& names_of(const ServoMeasure*);
const std::vector<std::string>& names_of(const ServoJacobian*);

/// std::invalid_argument, with what is wrong, of a task that no servo can do whatever the rig.
void check_servo(const ServoConfig& config);

/// Of the slower one of these two cameras, Hz: within a frame of it each takes a picture.
[[nodiscard]] double slower_frame_rate(const std::vector<CameraConfig>& cameras,
                                       const std::array<std::size_t, 2>& two);

/// Of the limiter behind its law.
[[nodiscard]] LimiterConfig limiter_config(const ServoConfig& config);

}  // namespace flexura
