#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "flexura/camera/head.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/port/camera_port.h"
#include "flexura/servo/servo_error.h"

namespace flexura {

/// What two pictures of one instant told.
struct ServoSight {
  double time = 0;   ///< Middle of the exposures, s.
  ArmState desired;  ///< Then.
  /// How far goals that are recorded pictures lie from what the cameras, as they are believed to be, would
  /// see of that, in the law's own features; empty: nothing.
  Eigen::VectorXd desired_offset;
  std::array<Frame, 2> frames;   ///< Of both cameras.
  std::array<Sighting, 2> seen;  ///< Axes, bands and borders, in the views as believed, less their errors.
  ShapeEstimate estimate;        ///< Of the arm's shape at that time.
  std::array<std::string, 2> reasons;  ///< Why a picture shows no arm; "" when it does.
};

/// One command, and what it was made of.
struct ServoStep {
  double time = 0;                  ///< When it was sent, s.
  std::optional<double> seen_at;    ///< Of the sight that it goes by; none before the first.
  ArmState desired;                 ///< At the time of that sight.
  std::optional<ArmState> seen;     ///< By that sight.
  std::optional<ServoError> error;  ///< Of that, from desired.
  double sigma = 0;                 ///< Of that, standard deviation along the arm, share of its length.
  /// Of the shape that is expected after all that was sent, from what is desired when it is sent.
  std::optional<ServoError> ahead;
  ArmState sent;  ///< To the drives, by the limiter.
  /// Half the square of the law's error: Lyapunov's function of an arm that does what it is sent. In the
  /// law's own units: rad^2 of `shape` and `potential`, px^2 otherwise (docs/servo.md).
  double potential = 0;
  bool is_fresh = false;     ///< The sight is new.
  bool is_singular = false;  ///< Of the law: some motion shows in nothing that is seen.
  std::string limited;       ///< What held the law back; "": nothing.
  /// Where the heads were sent to meanwhile; none of heads that were not.
  std::array<std::optional<HeadState>, 2> heads;
};

/// Sees a servo as it goes. What it does with that changes nothing of it.
class ServoWatcher {
 public:
  virtual ~ServoWatcher() = default;
  ServoWatcher() = default;
  ServoWatcher(const ServoWatcher&) = delete;
  ServoWatcher& operator=(const ServoWatcher&) = delete;

  /// The arm was sent to `state`, to arrive `duration` s later; at `time`, s of the rig's clock. What was
  /// refused is not told.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// Two pictures of one instant were measured.
  virtual void seen(const ServoSight& /*sight*/) {}
  /// A step was done.
  virtual void stepped(const ServoStep& /*step*/) {}
  /// Something happened that is worth a line: "camera side does not see the arm: ...".
  virtual void told(double /*time*/, const std::string& /*what*/) {}
  /// Whether the servo shall end early.
  virtual bool is_cancelled() { return false; }
};

}  // namespace flexura
