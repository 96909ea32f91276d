#pragma once

#include <optional>

#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// Devices that say what they are told to, or fail, and a clock that stands.
class StubArm : public ArmPort {
 public:
  ArmReading next_reading{1, {{{0.1, 0.2}, {0, 0}}, {1, 1}}, {}, false};
  std::optional<PortFault> fault;
  CommandOutcome command(const ArmState&, double) override { return Accepted{}; }
  CommandOutcome halt() override { return Accepted{}; }
  Outcome<ArmReading> read() override {
    if (fault) return *fault;
    return next_reading;
  }
};
class StubHead : public HeadPort {
 public:
  HeadReading next_reading{2, {0.1, 0.2, 1}, false};
  std::optional<PortFault> fault;
  CommandOutcome command(const HeadState&) override { return Accepted{}; }
  CommandOutcome halt() override { return Accepted{}; }
  Outcome<HeadReading> read() override {
    if (fault) return *fault;
    return next_reading;
  }
};
class StubStage : public StagePort {
 public:
  StageReading next_reading{2, {{0.1, 0, -0.1}}, false};
  std::optional<PortFault> fault;
  CommandOutcome command(const StageState&) override { return Accepted{}; }
  CommandOutcome halt() override {
    if (fault) return *fault;
    return Accepted{};
  }
  Outcome<StageReading> read() override {
    if (fault) return *fault;
    return next_reading;
  }
};

class StoppedClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return 3; }
  void wait_until(double) override {}
};

}  // namespace flexura
