#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// An axis with a CANopen drive (CiA 402) of its own.
struct Cia402AxisConfig {
  std::int64_t node = 1;                                   ///< Number of the node, 1 to 127.
  std::array<double, 2> limits = {-1'000'000, 1'000'000};  ///< Smallest and largest position, microsteps.
  double max_rate = 20'000;                                ///< Largest speed, microsteps/s, > 0.
  double max_acceleration = 100'000;                       ///< Acceleration and braking, microsteps/s^2, > 0.
  double stop_deceleration = 400'000;                      ///< Braking of a quick stop, microsteps/s^2, > 0.
  double position_unit = 1;        ///< Units of the drive's positions per microstep, not 0.
  double velocity_unit = 1;        ///< Units of the drive's velocities (0x6081) per microstep/s, > 0.
  double acceleration_unit = 1;    ///< Units of its accelerations (0x6083) per microstep/s^2, > 0.
  std::int64_t homing_method = 0;  ///< Object 0x6098, -128 to 127; 0: home() leaves this axis alone.
  std::array<double, 2> homing_rates = {2'000,
                                        500};  ///< Speeds towards and at the switch, microsteps/s, > 0.
  double home = 0;                             ///< Position at the home position, microsteps (0x607C).
  double following_window = 0;  ///< Following error that is a fault, microsteps; 0: as set in the drive.
};

/// CANopen drives on a bus, one per axis, in the order of the axes.
struct Cia402Config {
  std::string link = "can:can0";  ///< Address of the bus (link.h).
  std::vector<Cia402AxisConfig> axes = {};
  double answer_timeout = 0.05;  ///< Time that a node has to answer, s, > 0.
  std::int64_t tries = 3;        ///< How often a request is sent before the node counts as lost, 1 to 10.
  double heartbeat = 0.1;        ///< Period of the nodes' heartbeats, s, 0.01 to 60.
  /// Drives make a quick stop by themselves if the program has sent no heartbeat for this time, s; 0: never.
  double host_timeout = 0;
  std::int64_t host_node = 127;  ///< Number of the program as a node, 1 to 127.
  double window = 2;             ///< Largest distance to the target at rest, microsteps, >= 0.5.
  double settling = 1;           ///< Time that an axis may take longer than expected, s, > 0.
  double power_timeout = 3;      ///< Time to switch the motors on, s, > 0.
  double homing_timeout = 60;    ///< Time to home an axis, s, > 0.
};

const Table<Cia402AxisConfig>& fields_of(const Cia402AxisConfig*);
const Table<Cia402Config>& fields_of(const Cia402Config*);

/// Returns the first reason why a configuration cannot be used, or "". Files are checked by the tables of
/// fields; this is for configurations made by code.
[[nodiscard]] std::string problem_of(const Cia402Config& config);

}  // namespace flexura
