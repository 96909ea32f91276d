#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/equipment/guard.h"

namespace flexura {

/// A motion controller with Grbl 1.1 or grblHAL.
struct GrblConfig {
  std::string link = {};     ///< Address, see parse_link_address().
  std::string axes = "XYZ";  ///< Letters of the axes that drive motors, in the order X Y Z A B C U V.
  /// Largest motor position of either sign, microsteps; default: 2^21, up to which Grbl counts exactly.
  std::optional<std::int64_t> travel = {};
  std::int64_t window = 128;     ///< Bytes that may be on the way to the controller unanswered, 80 to 4096.
  double lead = 0.1;             ///< Delay, s, at which a stream of commands is followed, 0 to 1.
  double most_lag = 0.25;        ///< A longer rest of the previous motion is canceled, s, 0 to 10.
  double answer_timeout = 0.25;  ///< Longest wait for an answer, s, above 0, at most 10.
  double connect_timeout = 5;    ///< Longest wait for a controller that starts, s.
  double stop_timeout = 2;       ///< Longest time of braking, s.
  double homing_timeout = 60;    ///< Longest homing, s.
  double brake_time = 0.3;       ///< From an emergency stop's hold to its reset, s.
  bool writes_settings = false;  ///< Whether connect() may correct settings that are wrong for a drive.
};

const Table<GrblConfig>& fields_of(const GrblConfig*);

/// Returns how to stop the controller whatever it does: a hold, which brakes, then a reset, after which it
/// needs homing or a new zero.
[[nodiscard]] StopMessages grbl_stop(const GrblConfig& config);

}  // namespace flexura
