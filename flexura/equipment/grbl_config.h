#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/equipment/guard.h"

namespace flexura {

/// A motion controller with Grbl 1.1 or grblHAL.
struct GrblConfig {
  std::string link = {};     ///< Address as in parse_link_address().
  std::string axes = "XYZ";  ///< Letters of the axes that drive motors, in the order X Y Z A B C U V.
  /// Largest motor position of either sign, microsteps. Default: 2^21, because up to this number Grbl counts
  /// exactly.
  std::optional<std::int64_t> travel = {};
  std::int64_t window =
      128;  ///< Largest number of bytes that are sent before the controller has answered them, 80 to 4096.
  double lead = 0.1;  ///< Delay with which the motors follow a stream of commands, s, 0 to 1.
  double most_lag =
      0.25;  ///< Longest rest of the previous motion at a new command, s, 0 to 10; a longer rest is canceled.
  double answer_timeout = 0.25;  ///< Longest wait for an answer, s, above 0, at most 10.
  double connect_timeout = 5;    ///< Longest wait for a controller that is starting, s.
  double stop_timeout = 2;       ///< Longest duration of braking, s.
  double homing_timeout = 60;    ///< Longest duration of homing, s.
  double brake_time = 0.3;       ///< Time between the hold and the reset of an emergency stop, s.
  bool writes_settings = false;  ///< Whether connect() may correct wrong settings in the controller's memory.
};

const Table<GrblConfig>& fields_of(const GrblConfig*);

/// Returns the messages of an emergency stop: a hold, which brakes the motors, then a reset. Afterwards the
/// controller must be homed, or its positions be set.
[[nodiscard]] StopMessages grbl_stop(const GrblConfig& config);

}  // namespace flexura
