#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/grbl_drive.h"
#include "flexura/equipment/guarded_drive.h"
#include "flexura/equipment/joined_drive.h"
#include "flexura/equipment/visca_head.h"
#include "flexura/equipment/wall_clock.h"
#include "flexura/log/recorder.h"
#include "flexura/port/clocked_ports.h"
#include "flexura/port/driven_arm.h"
#include "flexura/rig/rig.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// Returns the value, or throws the fault.
template <class T>
T must(Outcome<T> outcome) {
  return std::move(outcome).value();
}

// The head of a camera, with times on the rig's clock. An answer takes tens of milliseconds, so a head that
// stands is not asked each time.
class RigHead : public HeadPort {
 public:
  // `time_shift`, s, is added to the times of readings.
  RigHead(std::unique_ptr<HeadPort> head, double time_shift)
      : head_(std::move(head)), time_shift_(time_shift) {}
  ~RigHead() override { (void)head_->halt(); }
  CommandOutcome command(const HeadState& state) override {
    standing_.reset();
    return head_->command(state);
  }
  CommandOutcome halt() override {
    standing_.reset();
    return head_->halt();
  }
  Outcome<HeadReading> read() override {
    constexpr double fresh = 0.2;  // s
    const double now = steady_seconds();
    if (standing_ && now - asked_ < fresh) return *standing_;
    standing_.reset();
    auto taken = head_->read();
    if (!taken) return taken;
    HeadReading reading = taken.value();
    reading.time += time_shift_;
    if (!reading.moving) standing_ = reading, asked_ = now;
    return reading;
  }

 private:
  std::unique_ptr<HeadPort> head_;
  double time_shift_;
  std::optional<HeadReading> standing_;  // The last reading, if the head stood.
  double asked_ = 0;
};

// The controllers of an arm.
class ArmEquipment {
 public:
  ArmEquipment(const RigEquipment& equipment, const ArmSetup& setup, const ClockPort& clock, Guard& guard) {
    if (!setup.drive) throw std::runtime_error("the arm has no drive to run");
    std::vector<double> start;
    for (const std::int64_t position : nominal_positions(setup.arm, *setup.drive, setup.initial))
      start.push_back(static_cast<double>(position));
    std::vector<DrivePort*> parts;
    if (equipment.cia402) {
      link_ = must(open_link(parse_link_address(equipment.cia402->link)));
      can_.emplace(*link_, clock, *equipment.cia402);
      guard.protect(*link_, cia402_stop(*equipment.cia402));
      must(can_->start());
      if (equipment.start == StartPositions::homed) must(can_->home());
      parts.push_back(&*can_);
    }
    std::size_t first = 0;
    for (const GrblConfig& config : equipment.grbl) {
      auto drive =
          std::make_unique<GrblDrive>(must(open_link(parse_link_address(config.link))), clock, config);
      guard.protect(drive->link(), grbl_stop(config));
      must(drive->connect());
      const bool is_homed = equipment.start == StartPositions::homed;
      const auto own = std::span(is_homed ? equipment.home : start).subspan(first, drive->axes());
      must(is_homed ? drive->home(own) : drive->set_positions(own));
      first += drive->axes();
      parts.push_back(drive.get());
      grbl_.push_back(std::move(drive));
    }
    joined_.emplace(std::move(parts));
  }
  // From now on the drives may move. `time_shift`, s, is added to the times of readings.
  void start(const ArmSetup& setup, Guard& guard, double time_shift) {
    guarded_.emplace(
        *joined_, guard,
        [this] {
          if (can_) can_->keep_alive();
        },
        time_shift);
    arm_.emplace(*guarded_, setup.arm, *setup.drive, setup.initial);
  }
  ~ArmEquipment() {
    if (!guarded_) return;
    // Controllers follow commands with a delay. The end of a run lets them arrive; a failure does not.
    constexpr double longest_delay = 1;
    const double end = steady_seconds() + longest_delay;
    while (std::uncaught_exceptions() == 0 && steady_seconds() < end) {
      const auto reading = guarded_->read();
      if (!reading || !reading.value().moving) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    (void)guarded_->halt();
  }
  ArmEquipment(const ArmEquipment&) = delete;
  ArmEquipment& operator=(const ArmEquipment&) = delete;

  [[nodiscard]] ArmPort& port() { return *arm_; }
  void beat() {
    if (guarded_) guarded_->beat();
  }

 private:
  std::unique_ptr<Link> link_;
  std::optional<Cia402Drive> can_;
  std::vector<std::unique_ptr<GrblDrive>> grbl_;
  std::optional<JoinedDrive> joined_;
  std::optional<GuardedDrive> guarded_;
  std::optional<DrivenArm> arm_;
};

// The devices of a camera.
struct CameraDevices {
  std::string name;
  std::unique_ptr<CountedCamera> source;
  DeviceClock time;
  std::optional<ClockedCamera> camera;
  std::unique_ptr<RigHead> head;  // Null if the camera has none.
};

using Buses = std::map<std::string, std::shared_ptr<ViscaBus>>;

std::unique_ptr<HeadPort> head_of(const CameraEquipment& equipment, const ClockPort& clock, Guard& guard,
                                  Buses& buses) {
  if (equipment.v4l2_head) return must(V4l2Head::open(*equipment.v4l2_head, equipment.name, clock));
  if (!equipment.visca) return nullptr;
  const ViscaConfig& config = *equipment.visca;
  std::shared_ptr<ViscaBus>& bus = buses[config.bus.link];
  if (!bus) bus = must(open_visca_bus(config.bus, [&clock] { return clock.now(); }));
  guard.protect(bus->link(), visca_stop(config));
  auto head = std::make_unique<ViscaHead>(bus, config);
  must(head->start());
  return head;
}

std::unique_ptr<CountedCamera> source_of(const CameraEquipment& equipment, const CameraConfig& camera,
                                         const ClockPort& clock) {
  if (equipment.gstreamer) return must(open_gstreamer_camera(*equipment.gstreamer, camera, clock));
  if (equipment.aravis) return must(open_aravis_camera(*equipment.aravis, camera, clock));
  return must(open_v4l2_camera(equipment.v4l2.value(), camera, clock));
}

// Returns the age of a picture that arrives as quickly as the model says: from the middle of its exposure on.
double youngest_age(const SensorConfig& sensor) {
  const FrameTimes times = frame_times(sensor, 0);
  return times.received - times.middle;
}

class EquipmentRig : public Rig {
 public:
  explicit EquipmentRig(const Setup& setup)
      : equipment_(setup.equipment.value()), guard_(equipment_.watchdog) {
    const ArmSetup arm(setup.model_rig());
    arm_ = std::make_unique<ArmEquipment>(equipment_, arm, device_clock_, guard_);
    const std::vector<CameraConfig> cameras = setup.cameras();
    std::vector<std::unique_ptr<HeadPort>> heads;
    heads.reserve(cameras.size());
    for (const CameraConfig& camera : cameras)
      heads.push_back(head_of(devices_of(camera), device_clock_, guard_, buses_));
    // The run begins when the devices are ready.
    clock_.emplace([this] { arm_->beat(); }, equipment_.watchdog / 10);
    const double time_shift = device_clock_.start() - clock_->start();
    arm_->start(arm, guard_, time_shift);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      auto devices = std::make_unique<CameraDevices>();
      devices->name = cameras[i].name;
      if (heads[i]) devices->head = std::make_unique<RigHead>(std::move(heads[i]), time_shift);
      devices->source = source_of(devices_of(cameras[i]), cameras[i], *clock_);
      devices->camera.emplace(*devices->source, devices->time, youngest_age(cameras[i].sensor));
      cameras_.push_back(std::move(devices));
    }
  }

  RigPorts ports() override {
    RigPorts ports{&*clock_, &arm_->port(), {}};
    for (const auto& devices : cameras_)
      ports.cameras.push_back({devices->name, &*devices->camera, devices->head.get(), nullptr});
    return ports;
  }

  void play_to(double time, const ArmState& state, const TakeFrame& take) override {
    go_to(time, state);
    constexpr double between_looks = 0.005;
    do {
      clock_->wait_until(std::min(time, clock_->now() + between_looks));
      for (const FilmedFrame& filmed : new_frames()) take(filmed);
    } while (clock_->now() < time);
  }
  void pass_to(double time, const ArmState& state) override {
    go_to(time, state);
    clock_->wait_until(time);
  }
  void skip_to_now() override {
    for (const auto& devices : cameras_) (void)devices->camera->newest();
  }

 private:
  [[nodiscard]] const CameraEquipment& devices_of(const CameraConfig& camera) const {
    const auto found = std::ranges::find(equipment_.camera, camera.name, &CameraEquipment::name);
    if (found == equipment_.camera.end())
      throw std::runtime_error("no devices for the camera " + camera.name);
    return *found;
  }
  // Real time does not wait for the program: what is late is done as soon as possible.
  void go_to(double time, const ArmState& state) {
    must(arm_->port().command(state, std::max(0.0, time - clock_->now())));
  }
  std::vector<FilmedFrame> new_frames() {
    std::vector<FilmedFrame> frames;
    for (const auto& devices : cameras_) {
      const auto frame = must(devices->camera->newest());
      if (frame) frames.push_back({devices->name, *frame, logged_image(devices->name, *frame)});
    }
    std::ranges::stable_sort(frames, {}, [](const FilmedFrame& filmed) { return filmed.frame.received; });
    return frames;
  }

  RigEquipment equipment_;
  Guard guard_;
  WallClock device_clock_;          // Of the drives and heads.
  std::optional<WallClock> clock_;  // Of the run.
  std::unique_ptr<ArmEquipment> arm_;
  Buses buses_;
  std::vector<std::unique_ptr<CameraDevices>> cameras_;
};

}  // namespace

std::unique_ptr<Rig> equipment_rig(const Setup& setup) { return std::make_unique<EquipmentRig>(setup); }

std::unique_ptr<Rig> rig_of(const Setup& setup) {
  return setup.equipment ? equipment_rig(setup) : simulated_rig(setup);
}

}  // namespace flexura
