#include "flexura/equipment/cia402_config.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <set>

#include "flexura/base/table.h"
#include "flexura/equipment/link.h"

namespace flexura {
namespace {

constexpr double most_counts = 2'147'483'647;

bool is_finite_above_0(double value) { return value > 0 && std::isfinite(value); }

// Returns what is wrong with an axis, or "".
std::string cia402_axis_problem(const Cia402AxisConfig& axis) {
  const bool has_units = is_finite_above_0(std::abs(axis.position_unit)) &&
                         is_finite_above_0(axis.velocity_unit) && is_finite_above_0(axis.acceleration_unit);
  const bool has_rates = is_finite_above_0(axis.max_rate) && is_finite_above_0(axis.max_acceleration) &&
                         is_finite_above_0(axis.stop_deceleration) &&
                         is_finite_above_0(axis.homing_rates[0]) && is_finite_above_0(axis.homing_rates[1]);
  if (axis.node < 1 || axis.node > 127) return "node: expected 1 to 127";
  if (!has_units) return "units must be finite and not 0, those of rates above 0";
  if (!has_rates) return "rates and accelerations must be finite and above 0";
  if (!(axis.limits[0] < axis.limits[1])) return "limits: the first must be the smaller one";
  if (axis.homing_method < -128 || axis.homing_method > 127) return "homing_method: expected -128 to 127";
  if (!(axis.following_window >= 0)) return "following_window: expected at least 0";
  for (const double position : {axis.limits[0], axis.limits[1], axis.home, axis.following_window})
    if (!(std::abs(position * axis.position_unit) <= most_counts))
      return "positions must fit into 32 bits in the drive's units";
  if (axis.max_rate * axis.velocity_unit < 1 || axis.max_rate * axis.velocity_unit > most_counts)
    return "max_rate must be from 1 to 2147483647 in the drive's units";
  for (const double acceleration : {axis.max_acceleration, axis.stop_deceleration})
    if (acceleration * axis.acceleration_unit < 1 || acceleration * axis.acceleration_unit > most_counts)
      return "accelerations must be from 1 to 2147483647 in the drive's units";
  return "";
}

std::string cia402_times_problem(const Cia402Config& config) {
  for (const double time :
       {config.answer_timeout, config.settling, config.power_timeout, config.homing_timeout})
    if (!is_finite_above_0(time) || time > 3600) return "times must be above 0 and at most 3600 s";
  const auto is_period = [](double time) { return time >= 0.01 && time <= 60; };
  if (!is_period(config.heartbeat)) return "heartbeat: expected 0.01 to 60 s";
  if (config.host_timeout != 0 && !is_period(config.host_timeout))
    return "host_timeout: expected 0, or 0.01 to 60 s";
  if (config.tries < 1 || config.tries > 10) return "tries: expected 1 to 10";
  const bool is_window = config.window >= 0.5 && std::isfinite(config.window);
  if (!is_window) return "window: expected at least 0.5";
  return "";
}

}  // namespace

std::string problem_of(const Cia402Config& config) {
  if (config.axes.empty()) return "axes: expected at least one";
  std::set<std::int64_t> nodes{config.host_node};
  if (config.host_node < 1 || config.host_node > 127) return "host_node: expected 1 to 127";
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    if (const std::string problem = cia402_axis_problem(config.axes[i]); !problem.empty())
      return fmt::format("axes[{}]: {}", i, problem);
    if (!nodes.insert(config.axes[i].node).second)
      return fmt::format("axes[{}].node: {} is the number of another node", i, config.axes[i].node);
  }
  return cia402_times_problem(config);
}

const Table<Cia402AxisConfig>& fields_of(const Cia402AxisConfig*) {
  using Axis = Cia402AxisConfig;
  static const auto table =
      Table<Axis>("cia402_axis", "An axis with its CANopen drive (CiA 402).")
          .field("node", &Axis::node,
                 {.meaning = "Number of the drive's node.", .range = between(1, 127), .required = true})
          .field("limits", &Axis::limits, {.meaning = "Smallest and largest position, microsteps."})
          .field("max_rate", &Axis::max_rate, {.meaning = "Largest speed, microsteps/s.", .range = above(0)})
          .field("max_acceleration", &Axis::max_acceleration,
                 {.meaning = "Acceleration and deceleration of motions, microsteps/s^2.", .range = above(0)})
          .field("stop_deceleration", &Axis::stop_deceleration,
                 {.meaning = "Deceleration of a quick stop, microsteps/s^2.", .range = above(0)})
          .field("position_unit", &Axis::position_unit,
                 {.meaning = "Number of the drive's position units per microstep; negative if the drive "
                             "counts in the opposite direction."})
          .field("velocity_unit", &Axis::velocity_unit,
                 {.meaning = "Number of the drive's velocity units (object 0x6081) per microstep/s.",
                  .range = above(0)})
          .field("acceleration_unit", &Axis::acceleration_unit,
                 {.meaning = "Number of the drive's acceleration units (object 0x6083) per microstep/s^2.",
                  .range = above(0)})
          .field("homing_method", &Axis::homing_method,
                 {.meaning = "Homing method (object 0x6098); 0: the axis is not homed.",
                  .range = between(-128, 127)})
          .field("homing_rates", &Axis::homing_rates,
                 {.meaning = "Two homing speeds: towards the home switch, and near the switch, microsteps/s.",
                  .range = above(0)})
          .field("home", &Axis::home, {.meaning = "Motor position at the home position, microsteps."})
          .field("following_window", &Axis::following_window,
                 {.meaning = "Following error above which the drive reports a fault, microsteps; 0: as set "
                             "in the drive.",
                  .range = at_least(0)})
          .check([](const Axis& axis, Reader& reader) {
            if (const std::string problem = cia402_axis_problem(axis); !problem.empty())
              reader.problem(problem);
          });
  return table;
}

const Table<Cia402Config>& fields_of(const Cia402Config*) {
  using Config = Cia402Config;
  static const auto table =
      Table<Config>("cia402", "CANopen drives (CiA 402) on a bus, one per axis.")
          .field("link", &Config::link, {.meaning = "Address of the bus, such as can:can0."})
          .field("axes", &Config::axes,
                 {.meaning = "Drives in the order of the axes.", .count = {1, 15}, .required = true})
          .field("answer_timeout", &Config::answer_timeout,
                 {.meaning = "Longest wait for the answer of a node.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 3600)})
          .field("tries", &Config::tries,
                 {.meaning = "Number of times that a request is sent before the node counts as lost.",
                  .range = between(1, 10)})
          .field("heartbeat", &Config::heartbeat,
                 {.meaning = "Period of the nodes' heartbeats.",
                  .unit = Unit::second,
                  .range = between(0.01, 60)})
          .field("host_timeout", &Config::host_timeout,
                 {.meaning = "Time without a heartbeat of the program after which the drives make a quick "
                             "stop by themselves; 0: never.",
                  .unit = Unit::second,
                  .range = between(0, 60)})
          .field("host_node", &Config::host_node,
                 {.meaning = "Node ID of this program on the bus.", .range = between(1, 127)})
          .field(
              "window", &Config::window,
              {.meaning =
                   "Largest distance from the target at which an axis at rest counts as arrived, microsteps.",
               .range = at_least(0.5)})
          .field("settling", &Config::settling,
                 {.meaning = "Time by which an axis may arrive later than expected.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 3600)})
          .field("power_timeout", &Config::power_timeout,
                 {.meaning = "Longest wait until the motors are switched on.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 3600)})
          .field("homing_timeout", &Config::homing_timeout,
                 {.meaning = "Longest duration of homing an axis.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 3600)})
          .check([](const Config& config, Reader& reader) {
            try {
              if (parse_link_address(config.link).kind != LinkAddress::Kind::can)
                reader.problem_at("link", "expected a CAN bus, such as can:can0");
            } catch (const std::exception& error) {
              reader.problem_at("link", error.what());
            }
            if (const std::string problem = problem_of(config); !problem.empty()) reader.problem(problem);
          });
  return table;
}

}  // namespace flexura
