#pragma once

#include <array>
#include <optional>
#include <string>

#include "flexura/camera/head.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_error.h"

namespace flexura {

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

}  // namespace flexura
