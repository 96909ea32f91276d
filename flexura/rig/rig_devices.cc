#include "flexura/rig/rig_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "flexura/equipment/onvif_head.h"
#include "flexura/equipment/visca_head.h"
#include "flexura/kinematics/tendons.h"

namespace flexura {
namespace {

// Returns the value, or throws the fault.
template <class T>
T value_or_throw(Outcome<T> outcome) {
  return std::move(outcome).value();
}

constexpr double between_reads = 0.005;  // s

// While it exists, the guard protects a device that moves by itself: it homes. The guard stops the device if
// the program hangs, and a stop by the user ends the wait for the device.
class GuardedHoming {
 public:
  GuardedHoming(WatchedLink& link, DeviceAccess& access)
      : link_(link), access_(access), guard_(access.guard()) {
    if (guard_ == nullptr) return;
    (void)guard_->beat(true);
    link_.set_watch([this]() -> std::optional<PortFault> {
      if (is_stopped() || access_.is_cancelled()) return PortFault{FaultKind::refused, "homing was stopped"};
      return std::nullopt;
    });
  }
  ~GuardedHoming() {
    link_.set_watch({});
    if (guard_ != nullptr) (void)guard_->beat(false);
  }
  GuardedHoming(const GuardedHoming&) = delete;
  GuardedHoming& operator=(const GuardedHoming&) = delete;

  // Throws if the device is not home, with the cause.
  void check(CommandOutcome homed) {
    if (homed) return;
    if (access_.is_cancelled()) throw HomingCancelled();
    if (is_stopped())
      throw std::runtime_error(fmt::format(
          "homing: the watchdog stopped all devices, because the program was silent for more than "
          "{:g} s",
          guard_->period()));
    value_or_throw(std::move(homed));
  }

 private:
  // Sends the guard a sign of life. Returns whether the guard has stopped the devices.
  bool is_stopped() {
    if (guard_ != nullptr && !guard_->beat(true)) was_stopped_ = true;
    return was_stopped_;
  }

  WatchedLink& link_;
  DeviceAccess& access_;
  Guard* guard_;
  bool was_stopped_ = false;
};

double sense_of_axis(const Axis& axis) { return axis.reversed ? -1 : 1; }

// The guard stops a head by the newest request, whose signature is that of the last move.
std::unique_ptr<HeadPort> open_onvif(OnvifConfig config, DeviceAccess& access) {
  if (!access.wants_logins()) config.user.clear(), config.password_file.clear(), config.profile.clear();
  const auto connect = [&access, config] { return access.open(config); };
  Guard* const guard = access.guard();
  if (guard == nullptr) return value_or_throw(open_onvif_head(config, access.clock(), {}, connect));
  const auto share =
      [guard, address = parse_link_address(config.link),
       number = std::optional<std::size_t>()](const std::string& request) mutable -> CommandOutcome {
    const StopMessages stop{{request}, 0, {}};
    try {
      if (number) {
        guard->renew(*number, stop);
      } else {
        number = guard->protect(address, stop);
      }
    } catch (const std::exception& error) {
      return PortFault{FaultKind::refused, error.what()};
    }
    return Accepted{};
  };
  return value_or_throw(open_onvif_head(config, access.clock(), share, connect));
}

// Returns whether a function ends without an exception.
template <class Function>
bool succeeds(const Function& function) noexcept {
  try {
    function();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

ArmEquipment::ArmEquipment(const RigEquipment& equipment, const ArmSetup& setup, DeviceAccess& access)
    : equipment_(equipment), setup_(setup), access_(access) {
  if (!setup.drive) throw std::runtime_error("the arm has no drive to run");
  for (const std::int64_t position : nominal_positions(setup.arm, *setup.drive, setup.initial))
    rest_.push_back(static_cast<double>(position));
  const bool is_homed = equipment.start != StartPositions::declared;
  Guard* const guard = access.guard();
  std::vector<DrivePort*> parts;
  if (equipment.cia402) {
    link_ = std::make_unique<WatchedLink>(value_or_throw(access.open(*equipment.cia402)));
    can_.emplace(*link_, access.clock(), *equipment.cia402);
    if (guard != nullptr) guard->protect(*link_, cia402_stop(*equipment.cia402));
    value_or_throw(can_->start());
    if (is_homed) {
      GuardedHoming homing(*link_, access);
      homing.check(can_->home());
    } else {
      check_declared(value_or_throw(can_->read()).values);
    }
    parts.push_back(&*can_);
  }
  std::size_t first = 0;
  for (const GrblConfig& config : equipment.grbl) {
    auto opened = std::make_unique<WatchedLink>(value_or_throw(access.open(config)));
    WatchedLink& link = *opened;
    auto drive = std::make_unique<GrblDrive>(std::move(opened), access.clock(), config);
    if (guard != nullptr) guard->protect(drive->link(), grbl_stop(config));
    value_or_throw(drive->connect());
    const auto own = std::span(is_homed ? equipment.home : rest_).subspan(first, drive->axes());
    if (is_homed) {
      GuardedHoming homing(link, access);
      homing.check(drive->home(own));
    } else {
      value_or_throw(drive->set_positions(own));
    }
    first += drive->axes();
    parts.push_back(drive.get());
    grbl_.push_back(std::move(drive));
  }
  // Simulated controllers have one clock and no threads.
  joined_.emplace(std::move(parts),
                  guard != nullptr ? JoinedDrive::Calls::at_once : JoinedDrive::Calls::one_by_one);
  if (!is_homed) return;
  guard_drive(0);
  try {
    // Otherwise the first command of a run would move the motors as fast as they can.
    equipment.start == StartPositions::pretensioned ? pull_in() : move_slowly(rest_);
  } catch (const std::exception&) {
    (void)drive_->halt();
    throw;
  }
}

void ArmEquipment::guard_drive(double time_shift) {
  drive_ = &*joined_;
  Guard* const guard = access_.guard();
  if (guard == nullptr) return;
  const auto keep_alive = [this] {
    if (can_) can_->keep_alive();
  };
  drive_ = &guarded_.emplace(*joined_, *guard, keep_alive, time_shift);
}

void ArmEquipment::start(double time_shift) {
  guard_drive(time_shift);
  arm_.emplace(*drive_, setup_.arm, *setup_.drive, setup_.initial);
}

// The positions of CAN drives cannot be declared: their first command would move the arm to the initial
// shape, as fast as they can.
void ArmEquipment::check_declared(const std::vector<double>& positions) const {
  constexpr double same = 2;  // Microsteps.
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!(std::abs(positions[i] - rest_.at(i)) <= same))
      throw std::runtime_error(fmt::format(
          "start: axis {} of the CAN drives is at {:.0f} microsteps, but at {:.0f} in the initial shape: "
          "expected start = \"homed\", or an arm in its initial shape",
          i + 1, positions[i], rest_[i]));
}

ArmEquipment::~ArmEquipment() {
  if (drive_ == nullptr) return;
  // The guard may be gone. Then the arm must be halted all the same.
  (void)succeeds([this] { finish(); });
  (void)succeeds([this] { (void)drive_->halt(); });
}

void ArmEquipment::finish() {
  // Controllers follow commands with a delay. The end of a run lets them arrive; a failure does not.
  constexpr double longest_delay = 1;
  ClockPort& clock = access_.clock();
  const double end = clock.now() + longest_delay;
  while (std::uncaught_exceptions() == 0 && clock.now() < end) {
    const auto reading = drive_->read();
    if (!reading || !reading.value().moving) break;
    clock.wait_until(clock.now() + between_reads);
  }
}

void ArmEquipment::beat() {
  if (guarded_) guarded_->beat();
}

// Backlash and friction must be taken up for pulling in, so tendons that are tighter than at rest are let out
// first.
void ArmEquipment::pull_in() {
  std::vector<double> slack = value_or_throw(drive_->read()).values;
  bool is_tight = false;
  const std::vector<double> wraps = tendon_wraps(setup_.arm, *setup_.drive, setup_.initial);
  for (std::size_t i = 0; i < slack.size(); ++i) {
    const Axis& axis = setup_.drive->axes.at(i);
    const double sense = sense_of_axis(axis);
    const double most = sense * rest_[i] - std::ceil(axis.backlash_steps() + axis.friction_steps(wraps[i]));
    is_tight = is_tight || sense * slack[i] > most;
    slack[i] = sense * std::min(sense * slack[i], most);
  }
  if (is_tight) move_slowly(slack);
  move_slowly(rest_);
}

void ArmEquipment::move_slowly(const std::vector<double>& targets) {
  const std::vector<double> now = value_or_throw(drive_->read()).values;
  double duration = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const double steps_per_second =
        equipment_.pretension_speed * setup_.drive->axes.at(i).microsteps_a_metre();
    duration = std::max(duration, std::abs(targets[i] - now.at(i)) / steps_per_second);
  }
  value_or_throw(drive_->command(targets, duration));
  ClockPort& clock = access_.clock();
  // A controller may be slower than the duration.
  const double end = clock.now() + 2 * duration + 10;
  for (;;) {
    const DriveReading reading = value_or_throw(drive_->read());
    if (!reading.moving) {
      for (std::size_t i = 0; i < targets.size(); ++i)
        if (std::abs(reading.values.at(i) - targets[i]) > 1)
          throw std::runtime_error(
              fmt::format("start: motor {} stands at {:.0f} microsteps instead of {:.0f}: check the "
                          "limits of its controller and the positions of home",
                          i + 1, reading.values[i], targets[i]));
      return;
    }
    if (access_.is_cancelled()) {
      (void)drive_->halt();
      throw HomingCancelled();
    }
    if (clock.now() > end) {
      (void)drive_->halt();
      throw std::runtime_error(fmt::format(
          "start: the motors still move after {:.0f} s: check their controllers' speeds", 2 * duration + 10));
    }
    clock.wait_until(clock.now() + between_reads);
  }
}

std::unique_ptr<HeadPort> open_head(const CameraEquipment& equipment, DeviceAccess& access, ViscaBuses& buses,
                                    std::string* about) {
  if (about != nullptr) about->clear();
  if (equipment.v4l2_head)
    return value_or_throw(V4l2Head::open(*equipment.v4l2_head, equipment.name, access.clock(),
                                         access.calls(*equipment.v4l2_head)));
  if (equipment.onvif) return open_onvif(*equipment.onvif, access);
  if (!equipment.visca) return nullptr;
  const ViscaConfig& config = *equipment.visca;
  std::shared_ptr<ViscaBus>& bus = buses[config.bus.link];
  if (!bus) {
    auto made = std::make_shared<ViscaBus>(value_or_throw(access.open(config.bus)), config.bus,
                                           [&access] { return access.clock().now(); });
    value_or_throw(made->start());
    bus = std::move(made);
  }
  if (Guard* const guard = access.guard()) guard->protect(bus->link(), visca_stop(config));
  auto head = std::make_unique<ViscaHead>(bus, config);
  const ViscaVersion version = value_or_throw(head->start());
  if (about != nullptr && version != ViscaVersion{})
    *about = fmt::format("vendor {:04X}h, model {:04X}h, revision {:04X}h", version.vendor, version.model,
                         version.revision);
  return head;
}

}  // namespace flexura
