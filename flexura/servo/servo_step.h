#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_error.h"

namespace flexura {

/// Command of a camera's head.
struct HeadCommand {
  std::string camera;        ///< Name of the camera.
  double pan = 0, tilt = 0;  ///< rad
  double zoom = 0;           ///< Zoom: position in the lens's zoom table.
};

/// True shape of the arm, if it is known.
struct TrueShape {
  std::vector<Eigen::Vector2d> bends;  ///< Bend_x and bend_y of each arc, rad.
  std::vector<double> lengths;         ///< Stretched length of each arc, m.
  ServoError error;                    ///< Error relative to the target.
};

/// One command of a servo, and its inputs. The log contains it as flexura.ServoStep on the topic
/// /servo/steps.
struct ServoStep {
  double time = 0;                  ///< Time of the command, s.
  std::optional<double> seen_at;    ///< Time of the observation used, s; empty before the first observation.
  ArmState desired;                 ///< Target at the time of the observation.
  std::optional<ArmState> seen;     ///< Shape estimated from the observation.
  ArmState sent;                    ///< Command to the drives, after the limiter.
  std::vector<HeadCommand> heads;   ///< Commands of the heads in this step.
  std::vector<double> lengths;      ///< Nominal lengths of the unstretched sections, m.
  std::optional<ServoError> error;  ///< Error of the observed shape relative to the target.
  /// True shape at the time of the observation. The simulator adds this shape; the servo does not know it.
  std::optional<TrueShape> truth;
  /// Half the squared error of the law. This value is a Lyapunov function if the arm follows its commands.
  /// The unit of this value is rad^2 for the laws `shape` and `potential`, otherwise px^2 (docs/servo.md).
  double potential = 0;
  bool is_fresh = false;     ///< Whether the observation is new since the last step.
  bool is_singular = false;  ///< Whether the law is singular: some motion of the arm changes no feature.
  /// Reason why the limiter changed the law's command, or limit that restricts the law, or "".
  std::string limited;

  // The following members are not in logs.
  double sigma =
      0;  ///< Standard deviation of the observed shape, root mean square along the arm, share of its length.
  /// Error of the predicted shape after all previous commands, relative to the target at the time of this
  /// command.
  std::optional<ServoError> ahead;
};

const Table<HeadCommand>& fields_of(const HeadCommand*);
const Table<ServoStep>& fields_of(const ServoStep*);

}  // namespace flexura
