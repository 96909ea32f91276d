#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flexura/servo/servo_session.h"
#include "flexura/tasks/servo/servo_run.h"
#include "tests/support/altered_ports.h"
#include "tests/support/rig_bench.h"
#include "tests/support/servo_files.h"

namespace flexura {

/// Keeps what a servo tells.
class ServoNotes : public ServoSessionWatcher {
 public:
  std::vector<std::pair<double, std::string>> lines;
  std::vector<std::pair<double, ArmState>> sent;
  std::function<bool()> cancelled = [] { return false; };

  void arm_sent(double time, const ArmState& state, double) override { sent.emplace_back(time, state); }
  void reported(double time, const std::string& what) override { lines.emplace_back(time, what); }
  bool is_cancelled() override { return cancelled(); }
  [[nodiscard]] bool has(const std::string& part) const {
    for (const auto& [time, line] : lines)
      if (line.find(part) != std::string::npos) return true;
    return false;
  }
};

/// A servo at the ports alone: the file's first task.
class ServoBench : public RigBench {
 public:
  using RigBench::RigBench;

  [[nodiscard]] ServoConfig config() {
    const auto& task = std::get<ServoTask>(experiment().task.front());
    return servo_config(experiment(), task, nominal(), ports().arm->read().value().state);
  }
  [[nodiscard]] RigModel nominal() const { return rig_model(experiment().arm.arm(), experiment().cameras()); }

  ServoResult servo() { return servo(ports()); }
  ServoResult servo(const RigPorts& ports) {
    ServoNotes notes;
    return servo(ports, notes);
  }
  ServoResult servo(const RigPorts& ports, ServoNotes& notes) {
    const RigModel model = nominal();
    return servo_in_session(ports, model, config(), notes);
  }
  /// How far the arm truly is from a state now.
  [[nodiscard]] ServoError truth(const ArmState& desired) {
    const Arm arm = experiment().arm.arm();
    return servo_error(rig().arm().backbone(rig().clock().now()), Backbone(arm, desired), arm.length());
  }
};

/// An arm that refuses commands, or says that it is nowhere, from a time on.
class BrokenArm : public ArmPort {
 public:
  enum class Kind { refuses, nowhere, gone };
  BrokenArm(ArmPort& arm, ClockPort& clock, Kind kind, double from)
      : arm_(arm), clock_(clock), kind_(kind), from_(from) {}
  CommandOutcome command(const ArmState& state, double duration) override {
    if (kind_ == Kind::refuses && is_broken()) return PortFault{FaultKind::refused, "not today"};
    if (kind_ == Kind::gone && is_broken()) return PortFault{FaultKind::link_lost, "no answer"};
    return arm_.command(state, duration);
  }
  CommandOutcome halt() override { return arm_.halt(); }
  Outcome<ArmReading> read() override {
    auto reading = arm_.read();
    if (!is_broken() || kind_ == Kind::refuses) return reading;
    if (kind_ == Kind::gone) return PortFault{FaultKind::link_lost, "no answer"};
    ArmReading nowhere = reading.value();
    nowhere.state.bends[1].x() = std::numeric_limits<double>::quiet_NaN();
    return nowhere;
  }

 private:
  [[nodiscard]] bool is_broken() const { return clock_.now() >= from_; }
  ArmPort& arm_;
  ClockPort& clock_;
  Kind kind_;
  double from_;
};

/// An arm whose drives are not mounted as the model has them: it bends into `share` of what it is told,
/// turned by `angle` rad about its sections' axes. What it says of itself is what its drives know.
class TurnedArm : public AlteredArm {
 public:
  TurnedArm(ArmPort& arm, double angle, double share)
      : AlteredArm(
            arm,
            [=](ArmReading reading) {
              reading.state = turned(reading.state, -angle, 1 / share);
              return reading;
            },
            [=](ArmState state) { return turned(std::move(state), angle, share); }) {}

 private:
  static ArmState turned(ArmState state, double angle, double share) {
    for (Eigen::Vector2d& bend : state.bends) bend = share * (Eigen::Rotation2Dd(angle) * bend);
    return state;
  }
};

}  // namespace flexura
