#include "flexura/app/jog.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/app/jog_axis.h"
#include "flexura/app/stop_signal.h"
#include "flexura/app/words.h"
#include "flexura/base/degree.h"
#include "flexura/base/node.h"
#include "flexura/camera/camera.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/rig/rig_devices.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

constexpr double between_looks = 0.01;  // s

// Where the axis was, where it should be and where it is, in its own unit.
struct JogResult {
  double from = 0, to = 0, reads = 0;
  bool is_stopped = false;  // By the user.
  double tolerance = 0;
};

// Waits until `read` returns that nothing moves. Halts by `halt` if the user stops the program, or after
// `longest` s. Returns whether the user has stopped it.
template <class Read, class Halt>
bool wait_for_rest(ClockPort& clock, const StopSignal& stop, double longest, const Read& read,
                   const Halt& halt) {
  const double end = clock.now() + longest;
  while (read()) {
    if (stop.come() != 0) {
      halt();
      return true;
    }
    if (clock.now() > end) {
      halt();
      throw std::runtime_error(fmt::format("the axis still moved after {:.0f} s and was stopped", longest));
    }
    clock.wait_until(clock.now() + between_looks);
  }
  return stop.come() != 0;
}

double bend_in(const ArmState& state, const JogAxis& axis) {
  return state.bends.at(axis.index)[axis.component];
}

// Returns an axis of the arm in the program's unit, for motor positions and the shape that the drive reports.
double arm_value(const JogAxis& axis, const Drive& drive, const ArmReading& reading) {
  if (axis.kind == JogAxis::Kind::motor) return static_cast<double>(reading.positions.at(axis.index));
  if (axis.kind == JogAxis::Kind::section) return bend_in(reading.state, axis);
  const Axis& motor = drive.axes.at(axis.index);
  const auto position = static_cast<double>(reading.positions.at(axis.index));
  return (motor.reversed ? -position : position) / motor.microsteps_a_metre();
}

JogResult jog_arm(const Experiment& experiment, const JogAxis& axis, double distance, const ArmJog& jog,
                  const StopSignal& stop) {
  const RigEquipment& equipment = *experiment.equipment;
  RealDevices devices(equipment.watchdog, [&stop] { return stop.come() != 0; });
  const ArmSetup setup(experiment.model_rig());
  const Drive& drive = setup.drive.value();
  ArmEquipment motors(equipment, setup, devices);
  motors.start();
  if (stop.come() != 0) {
    JogResult none;
    none.is_stopped = true;
    return none;
  }
  const ArmReading before = motors.arm().read().value();
  JogResult result;
  result.from = arm_value(axis, drive, before);
  result.to = result.from + distance;
  const double one_step =
      1 / drive.axes.at(axis.kind == JogAxis::Kind::section ? 0 : axis.index).microsteps_a_metre();
  if (axis.kind == JogAxis::Kind::motor) {
    std::vector<double> targets = motors.drive().read().value().values;
    targets.at(axis.index) += distance;
    (void)motors.drive().command(targets, jog.duration).value();
    result.tolerance = 1;
  } else {
    (void)motors.arm().pull(jog.pulled, jog.duration).value();
    // A tendon's motor also turns through the backlash.
    result.tolerance = axis.kind == JogAxis::Kind::tendon
                           ? one_step + drive.axes[axis.index].backlash_steps() * one_step
                           : 4 * one_step / drive.tendons.front().radius + 1e-9;
  }
  constexpr double slack = 10;  // s
  ArmReading now;
  result.is_stopped = wait_for_rest(
      devices.clock(), stop, 2 * jog.duration + slack,
      [&] {
        now = motors.arm().read().value();
        return now.moving;
      },
      [&] { (void)motors.arm().halt(); });
  if (result.is_stopped) now = motors.arm().read().value();
  result.reads = arm_value(axis, drive, now);
  return result;
}

double& head_value(HeadState& state, const JogAxis& axis) {
  if (axis.kind == JogAxis::Kind::pan) return state.pan;
  return axis.kind == JogAxis::Kind::tilt ? state.tilt : state.zoom;
}

// Returns why a head must not go to a position, or "".
std::string head_refusal(const CameraConfig& camera, const CameraEquipment& devices, const JogAxis& axis,
                         HeadState target) {
  std::size_t which = 2;
  if (axis.kind == JogAxis::Kind::pan) which = 0;
  if (axis.kind == JogAxis::Kind::tilt) which = 1;
  const AxisConfig limits = Camera(camera).head_axes().at(which);
  const double wanted = head_value(target, axis);
  const auto outside = [&](double low, double high, std::string_view whose) {
    return fmt::format("{} would go to {:.6g} {}, {} are {:.6g} to {:.6g}", axis.name, wanted / axis.scale(),
                       axis.unit(), whose, low / axis.scale(), high / axis.scale());
  };
  constexpr double rounding = 1e-9;
  if (wanted < limits.limits[0] - rounding || wanted > limits.limits[1] + rounding)
    return outside(limits.limits[0], limits.limits[1], "the limits of the camera's head in the file");
  if (!devices.visca) return "";
  const auto at = [&](double value) {
    HeadState state = target;
    head_value(state, axis) = value;
    HeadState reached = visca_state(*devices.visca, visca_counts(*devices.visca, state));
    return head_value(reached, axis);
  };
  constexpr double far = 1e9;
  const double low = std::min(at(-far), at(far)), high = std::max(at(-far), at(far));
  if (wanted < low - rounding || wanted > high + rounding) return outside(low, high, "the limits of visca");
  return "";
}

JogResult jog_head(const Experiment& experiment, const JogAxis& axis, double distance, const StopSignal& stop,
                   std::vector<std::string>& refusals) {
  const RigEquipment& equipment = *experiment.equipment;
  const CameraConfig camera = experiment.cameras().at(axis.index);
  const auto found = std::ranges::find(equipment.camera, camera.name, &CameraEquipment::name);
  RealDevices devices(equipment.watchdog);
  ViscaBuses buses;
  const std::unique_ptr<HeadPort> head = open_head(*found, devices, buses);
  HeadState state = head->read().value().state;
  JogResult result;
  result.from = head_value(state, axis);
  result.to = head_value(state, axis) += distance;
  if (const std::string why = head_refusal(camera, *found, axis, state); !why.empty()) {
    refusals.push_back(why);
    return result;
  }
  Guard& guard = *devices.guard();
  (void)guard.beat(true);
  const auto halt = [&] { (void)head->halt(); };
  constexpr double longest = 60;  // s
  HeadState now;
  try {
    (void)head->command(state).value();
    result.is_stopped = wait_for_rest(
        devices.clock(), stop, longest,
        [&] {
          const HeadReading reading = head->read().value();
          now = reading.state;
          (void)guard.beat(reading.moving);
          return reading.moving;
        },
        halt);
  } catch (const std::exception&) {
    halt();
    throw;
  }
  result.reads = head_value(now, axis);
  // The head itself verifies its counts.
  result.tolerance = axis.kind == JogAxis::Kind::zoom ? std::abs(0.02 * result.to) + 0.02 : 1 * degree;
  return result;
}

Node jog_node(const JogAxis& axis, const JogResult& result, const std::vector<std::string>& refusals) {
  const auto number = [&](double value) { return number_node(value / axis.scale()); };
  Node::Table table{{"axis", {}, text_node(axis.name)},
                    {"unit", {}, text_node(std::string(axis.unit()))},
                    {"refusals", {}, texts_node(refusals)}};
  if (refusals.empty()) {
    table.push_back({"from", {}, number(result.from)});
    table.push_back({"to", {}, number(result.to)});
    table.push_back({"reads", {}, number(result.reads)});
  }
  return {std::move(table), {}};
}

}  // namespace

int jog_command(const JogArguments& arguments, std::ostream& out, std::ostream& err) {
  Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  if (!experiment.equipment)
    throw input_error(arguments.experiment,
                      "this file has no devices, because its rig is simulated: expected a table [rig]", 1, 1);
  if (arguments.here) experiment.equipment->start = StartPositions::declared;
  const JogAxis axis = jog_axis(experiment, arguments.axis);
  const double distance = jog_distance(axis, arguments.distance);
  std::vector<std::string> refusals;
  JogResult result;
  // The first signal halts the axis. The second one ends the program, and the guard stops the devices.
  std::atomic<int> signals = 0;
  const StopSignal stop([&signals] {
    if (signals++ > 0) std::_Exit(exit_of_signal(SIGINT));
  });
  if (axis.is_of_camera()) {
    result = jog_head(experiment, axis, distance, stop, refusals);
  } else {
    const ArmJog jog = plan_arm_jog(experiment, axis, distance, refusals);
    try {
      if (refusals.empty()) result = jog_arm(experiment, axis, distance, jog, stop);
    } catch (const HomingCancelled& cancelled) {
      print_line(err, "stopped", cancelled.what());
      return exit_of_signal(stop.come());
    }
  }
  for (const std::string& why : refusals) print_line(err, "refused", why);
  if (arguments.json) out << write_json(jog_node(axis, result, refusals), 2) << '\n';
  if (!refusals.empty()) return exit_missed;
  const auto shown = [&](double value) { return fmt::format("{:.6g}", value / axis.scale()); };
  const std::string unit = axis.unit().empty() ? "" : fmt::format(" {}", axis.unit());
  if (!arguments.json)
    out << fmt::format("{}: commanded from {} to {}{}; measured position {}\n", axis.name, shown(result.from),
                       shown(result.to), unit, shown(result.reads));
  if (result.is_stopped) {
    print_line(err, "stopped", "the axis was halted before it reached its target");
    return exit_of_signal(stop.come());
  }
  if (std::abs(result.reads - result.to) > result.tolerance)
    throw std::runtime_error(fmt::format("{} is at {}{} instead of {}: check the limits of its controller",
                                         axis.name, shown(result.reads), unit, shown(result.to)));
  return exit_done;
}

}  // namespace flexura
