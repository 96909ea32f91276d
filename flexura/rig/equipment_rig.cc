#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/equipment/device_access.h"
#include "flexura/equipment/wall_clock.h"
#include "flexura/log/recorder.h"
#include "flexura/port/clocked_ports.h"
#include "flexura/rig/camera_sources.h"
#include "flexura/rig/rig.h"
#include "flexura/rig/rig_devices.h"
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

// The devices of a camera.
struct CameraDevices {
  std::string name;
  std::unique_ptr<CountedCamera> source;
  DeviceClock time;
  std::optional<ClockedCamera> camera;
  std::unique_ptr<RigHead> head;  // Null if the camera has none.
};

// Returns the age of a picture that arrives as quickly as the model says: from the middle of its exposure on.
double youngest_age(const SensorConfig& sensor) {
  const FrameTimes times = frame_times(sensor, 0);
  return times.received - times.middle;
}

class EquipmentRig : public Rig {
 public:
  EquipmentRig(const Setup& setup, std::function<bool()> is_cancelled)
      : equipment_(setup.equipment.value()), devices_(equipment_.watchdog, std::move(is_cancelled)) {
    const ArmSetup arm(setup.model_rig());
    arm_ = std::make_unique<ArmEquipment>(equipment_, arm, devices_);
    const std::vector<CameraConfig> cameras = setup.cameras();
    std::vector<std::unique_ptr<HeadPort>> heads;
    heads.reserve(cameras.size());
    for (const CameraConfig& camera : cameras)
      heads.push_back(open_head(devices_of(camera), devices_, buses_));
    // The run begins when the devices are ready.
    clock_.emplace([this] { arm_->beat(); }, equipment_.watchdog / 10);
    const double time_shift = devices_.clock().start() - clock_->start();
    arm_->start(time_shift);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      auto devices = std::make_unique<CameraDevices>();
      devices->name = cameras[i].name;
      if (heads[i]) devices->head = std::make_unique<RigHead>(std::move(heads[i]), time_shift);
      devices->source = open_camera_source(devices_of(cameras[i]), cameras[i], *clock_);
      devices->camera.emplace(*devices->source, devices->time, youngest_age(cameras[i].sensor));
      cameras_.push_back(std::move(devices));
    }
  }

  RigPorts ports() override {
    RigPorts ports{&*clock_, &arm_->arm(), {}};
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
    must(arm_->arm().command(state, std::max(0.0, time - clock_->now())));
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
  RealDevices devices_;
  std::optional<WallClock> clock_;  // Of the run.
  ViscaBuses buses_;
  std::vector<std::unique_ptr<CameraDevices>> cameras_;
  std::unique_ptr<ArmEquipment> arm_;  // The last: the arm is halted first.
};

}  // namespace

std::unique_ptr<Rig> equipment_rig(const Setup& setup, std::function<bool()> is_cancelled) {
  return std::make_unique<EquipmentRig>(setup, std::move(is_cancelled));
}

std::unique_ptr<Rig> rig_of(const Setup& setup, std::function<bool()> is_cancelled) {
  return setup.equipment ? equipment_rig(setup, std::move(is_cancelled)) : simulated_rig(setup);
}

}  // namespace flexura
