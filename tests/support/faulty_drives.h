#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/grbl_drive.h"
#include "tests/support/simulated_line.h"

namespace flexura {

/// A drive with its simulated device.
class DriveUnderTest {
 public:
  virtual ~DriveUnderTest() = default;
  virtual DrivePort& drive() = 0;
  virtual SimulatedLine& line() = 0;
  virtual StopMessages stop() = 0;
  virtual void keep_alive() {}
  /// What a person does after a fault: looks at the arm and makes the drive work again.
  virtual bool reset() = 0;
  /// Those that follow need the lock of the time.
  virtual std::vector<double> positions(double now) = 0;
  virtual void raise_alarm(double now) = 0;
  virtual void restart(double now) = 0;
};

/// Three axes of a Grbl controller.
class GrblUnderTest : public DriveUnderTest {
 public:
  GrblUnderTest(SimulatedThreads& time, std::uint64_t seed) : time_(time) {
    auto made = std::make_unique<SimulatedLine>(time, device_, "grbl", true, seed);
    line_ = made.get();
    drive_.emplace(std::move(made), time, config_);
  }
  DrivePort& drive() override { return *drive_; }
  SimulatedLine& line() override { return *line_; }
  StopMessages stop() override { return grbl_stop(config_); }
  bool reset() override {
    if (!drive_->connect() || !drive_->unlock()) return false;
    std::vector<double> at;
    {
      const auto lock = time_.enter();
      at = device_.positions(time_.now());
    }
    return static_cast<bool>(drive_->set_positions(at));
  }
  std::vector<double> positions(double now) override { return device_.positions(now); }
  void raise_alarm(double now) override { device_.raise_alarm(1, now); }
  void restart(double now) override { device_.restart(now); }

 private:
  SimulatedThreads& time_;
  GrblConfig config_;
  GrblDevice device_;
  SimulatedLine* line_ = nullptr;
  std::optional<GrblDrive> drive_;
};

/// Three drives on a CAN bus.
class Cia402UnderTest : public DriveUnderTest {
 public:
  /// `host_timeout`: time after which the drives stop by themselves without a sign of life of the program, s;
  /// 0: never.
  Cia402UnderTest(SimulatedThreads& time, std::uint64_t seed, double host_timeout = 0.3)
      : config_(config(host_timeout)),
        device_(nodes()),
        line_(time, device_, "can", false, seed),
        drive_(line_, time, config_) {}
  DrivePort& drive() override { return drive_; }
  SimulatedLine& line() override { return line_; }
  StopMessages stop() override { return cia402_stop(config_); }
  void keep_alive() override { drive_.keep_alive(); }
  bool reset() override { return static_cast<bool>(drive_.start()); }
  std::vector<double> positions(double now) override { return device_.positions(now); }
  void raise_alarm(double now) override { device_.node(1).fail(0x2310, now); }
  void restart(double) override {
    for (std::size_t i = 0; i < device_.size(); ++i) device_.node(i).restart();
  }

 private:
  static std::vector<Cia402NodeConfig> nodes() {
    std::vector<Cia402NodeConfig> nodes(3);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].node = static_cast<std::uint8_t>(i + 1);
    return nodes;
  }
  static Cia402Config config(double host_timeout) {
    Cia402Config config;
    config.host_timeout = host_timeout;
    for (int node = 1; node <= 3; ++node) {
      Cia402AxisConfig& axis = config.axes.emplace_back();
      axis.node = node;
    }
    return config;
  }
  Cia402Config config_;
  Cia402Device device_;
  SimulatedLine line_;
  Cia402Drive drive_;
};

/// Three drives on a CAN bus, which only the guard stops.
class TrustingCia402UnderTest : public Cia402UnderTest {
 public:
  TrustingCia402UnderTest(SimulatedThreads& time, std::uint64_t seed) : Cia402UnderTest(time, seed, 0) {}
};

}  // namespace flexura
