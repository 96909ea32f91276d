#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "flexura/port/camera_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A device before another one: what it says, and what it is sent, is changed on the way.
template <class Port, class State, class Reading, class... Way>
class AlteredDevice : public Port {
 public:
  using ChangeReading = std::function<Reading(Reading)>;
  using Sent = std::function<State(State)>;

  AlteredDevice(Port& port, ChangeReading reading, Sent sent)
      : port_(port), change_reading_(std::move(reading)), sent_(std::move(sent)) {}
  AlteredDevice(Port& port, ChangeReading reading)
      : AlteredDevice(port, std::move(reading), [](State state) { return state; }) {}
  CommandOutcome command(const State& state, Way... way) override {
    return port_.command(sent_(state), way...);
  }
  CommandOutcome halt() override { return port_.halt(); }
  Outcome<Reading> read() override {
    auto reading = port_.read();
    return reading.fault() ? reading : change_reading_(reading.value());
  }

 private:
  Port& port_;
  ChangeReading change_reading_;
  Sent sent_;
};

using AlteredArm = AlteredDevice<ArmPort, ArmState, ArmReading, double>;
using AlteredHead = AlteredDevice<HeadPort, HeadState, HeadReading>;

/// A camera whose frames are changed on the way.
class AlteredCamera : public CameraPort {
 public:
  AlteredCamera(CameraPort& camera, std::function<Frame(Frame)> shown)
      : camera_(camera), shown_(std::move(shown)) {}
  Outcome<std::optional<Frame>> newest() override { return changed(camera_.newest()); }
  Outcome<std::optional<Frame>> wait(double timeout) override { return changed(camera_.wait(timeout)); }

 private:
  Outcome<std::optional<Frame>> changed(Outcome<std::optional<Frame>> taken) {
    if (taken.fault() || !taken.value()) return taken;
    return std::optional(shown_(*taken.value()));
  }
  CameraPort& camera_;
  std::function<Frame(Frame)> shown_;
};

}  // namespace flexura
