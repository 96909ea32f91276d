#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_error.h"

namespace flexura {

/// Where a camera's head was sent to.
struct HeadCommand {
  std::string camera;        ///< Its name.
  double pan = 0, tilt = 0;  ///< rad
  double zoom = 0;           ///< A position of the lens's table.
};

/// The arm as it truly was, where somebody knows that.
struct TrueShape {
  std::vector<Eigen::Vector2d> bends;  ///< Of each arc, rad.
  std::vector<double> lengths;         ///< Likewise, with its stretch, m.
  ServoError error;                    ///< From what was desired.
};

/// One command of a servo, and what it was made of: for the loop, for the log (flexura.ServoStep, on
/// /servo/steps), and for all that read either.
struct ServoStep {
  double time = 0;                  ///< When it was sent, s.
  std::optional<double> seen_at;    ///< Of the sight that it goes by, s; none before the first.
  ArmState desired;                 ///< At the time of that sight.
  std::optional<ArmState> seen;     ///< By that sight.
  ArmState sent;                    ///< To the drives, by the limiter.
  std::vector<HeadCommand> heads;   ///< That were sent on with this command.
  std::vector<double> lengths;      ///< Of the unstretched sections, as they are believed to be, m.
  std::optional<ServoError> error;  ///< Of what is seen, from desired.
  /// At the time of that sight. The servo does not know it: who simulates the rig adds it.
  std::optional<TrueShape> truth;
  /// Half the square of the law's error: Lyapunov's function of an arm that does what it is sent. In the
  /// law's own units: rad^2 of `shape` and `potential`, px^2 otherwise (docs/servo.md).
  double potential = 0;
  bool is_fresh = false;     ///< The sight is new.
  bool is_singular = false;  ///< Of the law: some motion shows in nothing that is seen.
  std::string limited;       ///< What held the law back; "": nothing.

  // What a log does not have.
  double sigma = 0;  ///< Of what is seen, standard deviation along the arm, share of its length.
  /// Of the shape that is expected after all that was sent, from what is desired when it is sent.
  std::optional<ServoError> ahead;
};

const Table<HeadCommand>& fields_of(const HeadCommand*);
const Table<ServoStep>& fields_of(const ServoStep*);

}  // namespace flexura
