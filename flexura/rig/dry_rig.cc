#include "flexura/rig/dry_rig.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/camera/camera.h"
#include "flexura/port/driven_arm.h"
#include "flexura/rig/rig_devices.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// First positions of the motors, or none for an arm without a drive.
std::vector<double> dry_motors(const ArmSetup& arm) {
  std::vector<double> motors;
  if (!arm.drive) return motors;
  for (const std::int64_t position : nominal_positions(arm.arm, *arm.drive, arm.initial))
    motors.push_back(static_cast<double>(position));
  return motors;
}

const CameraConfig* camera_named(const std::vector<CameraConfig>& cameras, const std::string& name) {
  const auto found = std::ranges::find(cameras, name, &CameraConfig::name);
  return found == cameras.end() ? nullptr : &*found;
}

// First positions of the heads, in the order of the cameras' devices.
std::vector<HeadState> dry_heads(const Setup& setup, const RigEquipment& equipment) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  std::vector<HeadState> heads;
  for (const CameraEquipment& devices : equipment.camera) {
    const CameraConfig* camera = camera_named(cameras, devices.name);
    heads.push_back(camera == nullptr ? HeadState{} : Camera(*camera).initial_stance().head);
  }
  return heads;
}

// A port that passes everything to a driver and to the simulated device, whose readings count.
template <class Port, class State, class Reading, class... Way>
class DryPort : public Port {
 public:
  DryPort(Port& driver, Port& simulated, std::function<void()> synchronise)
      : driver_(driver), simulated_(simulated), synchronise_(std::move(synchronise)) {}
  CommandOutcome command(const State& state, Way... way) override {
    synchronise_();
    auto sent = driver_.command(state, way...);
    return sent ? simulated_.command(state, way...) : sent;
  }
  CommandOutcome halt() override {
    synchronise_();
    auto sent = driver_.halt();
    auto halted = simulated_.halt();
    return sent ? halted : sent;
  }
  Outcome<Reading> read() override {
    synchronise_();
    auto read = driver_.read();
    return read ? simulated_.read() : read;
  }

 private:
  Port& driver_;
  Port& simulated_;
  std::function<void()> synchronise_;
};

using DryArm = DryPort<ArmPort, ArmState, ArmReading, double>;
using DryHead = DryPort<HeadPort, HeadState, HeadReading>;

class DryRig : public Rig {
 public:
  DryRig(const Setup& setup, const TakeDryMessage& take)
      : equipment_(setup.equipment.value()),
        simulated_(simulated_rig(setup)),
        arm_setup_(setup.model_rig()),
        devices_(equipment_, dry_motors(arm_setup_), dry_heads(setup, equipment_),
                 [this, take](const DryMessage& message) {
                   if (!is_begun_) {
                     before_.push_back(message);
                     return;
                   }
                   DryMessage shifted = message;
                   shifted.time -= begin_;
                   take(shifted);
                 }) {
    arm_ = std::make_unique<ArmEquipment>(equipment_, arm_setup_, devices_);
    for (const CameraPorts& camera : simulated_->ports().cameras) {
      const auto found = std::ranges::find(equipment_.camera, camera.name, &CameraEquipment::name);
      if (found == equipment_.camera.end())
        throw std::runtime_error("no devices for the camera " + camera.name);
      head_drivers_.push_back(open_head(*found, devices_, buses_));
    }
    // The run begins when the devices are ready.
    begin_ = devices_.clock().now();
    is_begun_ = true;
    for (DryMessage& message : before_) {
      message.time -= begin_;
      take(message);
    }
    before_.clear();
    arm_->start();
    make_ports();
  }
  ~DryRig() override {
    // As in a run on equipment, the heads halt first.
    for (const auto& head : head_drivers_)
      if (head) (void)head->halt();
  }

  RigPorts ports() override { return ports_; }
  void play_to(double time, const ArmState& state, const TakeFrame& take) override {
    go_to(time, state);
    simulated_->play_to(time, state, take);
  }
  void pass_to(double time, const ArmState& state) override {
    go_to(time, state);
    simulated_->pass_to(time, state);
  }
  void skip_to_now() override { simulated_->skip_to_now(); }

 private:
  void make_ports() {
    const auto synchronise = [this] { this->synchronise(); };
    ports_ = simulated_->ports();
    dry_arm_ = std::make_unique<DryArm>(arm_->arm(), *ports_.arm, synchronise);
    ports_.arm = dry_arm_.get();
    for (std::size_t i = 0; i < ports_.cameras.size(); ++i) {
      CameraPorts& camera = ports_.cameras[i];
      camera.stage = nullptr;
      if (head_drivers_[i] && camera.head != nullptr) {
        heads_.push_back(std::make_unique<DryHead>(*head_drivers_[i], *camera.head, synchronise));
        camera.head = heads_.back().get();
      } else {
        camera.head = nullptr;
      }
    }
  }
  // Lets the devices wait for the rig.
  void synchronise() { devices_.clock().wait_until(begin_ + simulated_->ports().clock->now()); }
  void go_to(double time, const ArmState& state) {
    synchronise();
    const double left = time - simulated_->ports().clock->now();
    (void)arm_->arm().command(state, std::max(0.0, left)).value();
  }

  RigEquipment equipment_;
  std::unique_ptr<Rig> simulated_;
  ArmSetup arm_setup_;
  std::vector<DryMessage> before_;
  bool is_begun_ = false;
  double begin_ = 0;  // On the devices' clock, s.
  DryDevices devices_;
  ViscaBuses buses_;
  std::vector<std::unique_ptr<HeadPort>> head_drivers_;
  std::unique_ptr<ArmEquipment> arm_;
  std::unique_ptr<DryArm> dry_arm_;
  std::vector<std::unique_ptr<DryHead>> heads_;
  RigPorts ports_;
};

}  // namespace

std::unique_ptr<Rig> dry_rig(const Setup& setup, const TakeDryMessage& take) {
  return std::make_unique<DryRig>(setup, take);
}

std::vector<std::string> dry_assumptions(const Setup& setup) {
  if (!setup.equipment) return {};
  return DryDevices(*setup.equipment, {}, {}, [](const DryMessage&) {}).assumptions();
}

}  // namespace flexura
