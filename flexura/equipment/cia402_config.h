#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// An axis with its CANopen drive (CiA 402).
struct Cia402AxisConfig {
  std::int64_t node = 1;                                   ///< Number of the node, 1 to 127.
  std::array<double, 2> limits = {-1'000'000, 1'000'000};  ///< Smallest and largest position, microsteps.
  double max_rate = 20'000;                                ///< Largest speed, microsteps/s, > 0.
  double max_acceleration = 100'000;   ///< Acceleration and deceleration of motions, microsteps/s^2, > 0.
  double stop_deceleration = 400'000;  ///< Deceleration of a quick stop, microsteps/s^2, > 0.
  double position_unit = 1;            ///< Number of the drive's position units per microstep, not 0.
  double velocity_unit = 1;        ///< Number of the drive's velocity units (0x6081) per microstep/s, > 0.
  double acceleration_unit = 1;    ///< Number of its acceleration units (0x6083) per microstep/s^2, > 0.
  std::int64_t homing_method = 0;  ///< Object 0x6098, -128 to 127; 0: home() does not home this axis.
  std::array<double, 2> homing_rates = {2'000,
                                        500};  ///< Speeds towards and at the switch, microsteps/s, > 0.
  double home = 0;                             ///< Motor position at the home position, microsteps (0x607C).
  double following_window =
      0;  ///< Following error above which the drive reports a fault, microsteps; 0: as set in the drive.
};

/// CANopen drives on a bus, one per axis, in the order of the axes.
struct Cia402Config {
  std::string link = "can:can0";  ///< Address of the bus (link.h).
  std::vector<Cia402AxisConfig> axes = {};
  double answer_timeout = 0.05;  ///< Longest wait for the answer of a node, s, > 0.
  std::int64_t tries =
      3;  ///< Number of times that a request is sent before the node counts as lost, 1 to 10.
  double heartbeat = 0.1;  ///< Period of the nodes' heartbeats, s, 0.01 to 60.
  /// Drives make a quick stop by themselves if the program has sent no heartbeat for this time, s; 0: never.
  double host_timeout = 0;
  std::int64_t host_node = 127;  ///< Node number of the program, 1 to 127.
  /// Largest distance from the target at which an axis at rest counts as arrived, microsteps, >= 0.5.
  double window = 2;
  double settling = 1;         ///< Time by which an axis may arrive later than expected, s, > 0.
  double power_timeout = 3;    ///< Longest wait until the motors are switched on, s, > 0.
  double homing_timeout = 60;  ///< Longest duration of homing an axis, s, > 0.
};

const Table<Cia402AxisConfig>& fields_of(const Cia402AxisConfig*);
const Table<Cia402Config>& fields_of(const Cia402Config*);

/// Returns the first reason why a configuration cannot be used, or "". Use this function for configurations
/// that were not read from a file: the file reader checks all values.
[[nodiscard]] std::string problem_of(const Cia402Config& config);

}  // namespace flexura
