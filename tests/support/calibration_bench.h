#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/experiment/experiment.h"
#include "flexura/rig/ideal_picture.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "tests/support/altered_ports.h"
#include "tests/support/rig_bench.h"

namespace flexura {

class NobodyWatches : public RigSessionWatcher {
 public:
  void arm_sent(double, const ArmState&, double) override {}
  void camera_sent(double, const RigStance&) override {}
  void seen(const CameraObservation&) override {}
  void known(const RigStep&) override {}
};

/// Runs a calibration, the first task of a file, directly at the ports, without the rest of a run.
class CalibrationBench : public RigBench {
 public:
  using RigBench::RigBench;

  LoopResult calibrate() { return calibrate(ports()); }
  LoopResult calibrate(const RigPorts& ports) {
    NobodyWatches nobody;
    return calibrate(ports, nobody);
  }
  LoopResult calibrate(const RigPorts& ports, RigSessionWatcher& watcher) {
    const auto& task = std::get<CalibrateTask>(experiment().task.front());
    LoopConfig config = loop_config(task, experiment().arm, experiment().cameras(), experiment().stand);
    config.draw = ideal_pictures(experiment());
    return calibrate_by_loop(ports, nominal(), config, watcher);
  }
  RigSessionResult calibrate_bundle(const RigPorts& ports) {
    NobodyWatches nobody;
    return calibrate_bundle(ports, nobody);
  }
  RigSessionResult calibrate_bundle(const RigPorts& ports, RigSessionWatcher& watcher) {
    return calibrate_bundle(ports, nominal(), watcher);
  }
  RigSessionResult calibrate_bundle(const RigPorts& ports, const RigModel& nominal,
                                    RigSessionWatcher& watcher) {
    const auto& task = std::get<CalibrateTask>(experiment().task.front());
    return calibrate_rig_in_session(
        ports, nominal, session_prior(task, nominal, experiment().stand),
        session_config(task, experiment().arm, experiment().cameras(), experiment().stand), watcher);
  }
  [[nodiscard]] RigModel nominal() const { return rig_model(experiment().arm.arm(), experiment().cameras()); }
  /// Returns the prior of a bundle calibration.
  [[nodiscard]] RigPrior prior() const {
    return session_prior(std::get<CalibrateTask>(experiment().task.front()), nominal(), experiment().stand);
  }
  /// Returns the true remaining errors at the present camera positions.
  RigRemainder truth(const LoopResult& result) { return truth(result.target); }
  RigRemainder truth(const Eigen::Vector3d& target) {
    return remainder(true_model(), true_stances(), target);
  }
  [[nodiscard]] RigModel true_model() const {
    const RigConfig truth = experiment().true_rig();
    return rig_model(truth.arm.arm(), truth.cameras);
  }
  /// Returns the true present axis positions of the cameras.
  std::array<RigStance, 2> true_stances() {
    const double now = rig().clock().now();
    std::array<RigStance, 2> stances;
    for (std::size_t i = 0; i < 2; ++i)
      stances[i] = {i, rig().camera(i).head().truth(now), rig().camera(i).stage().truth(now)};
    return stances;
  }
  /// Checks that heads, zooms, stages and the straight arm report their initial positions of the file.
  void expect_back() {
    expect_back(ports());
    for (std::size_t i = 0; i < ports().cameras.size(); ++i)
      EXPECT_NEAR(ports().cameras[i].head->read().value().state.zoom,
                  experiment().cameras()[i].initial.zoom.value_or(1), 1e-9);
  }
  static void expect_back(const RigPorts& ports) {
    for (const CameraPorts& camera : ports.cameras) {
      const auto head = camera.head->read().value().state;
      EXPECT_NEAR(head.pan, 0, 1e-9);
      EXPECT_NEAR(head.tilt, 0, 1e-9);
      EXPECT_NEAR(camera.stage->read().value().state.offset.norm(), 0, 1e-9);
    }
    const auto arm = ports.arm->read();
    ASSERT_FALSE(arm.fault());
    for (const Eigen::Vector2d& bend : arm.value().state.bends) EXPECT_NEAR(bend.norm(), 0, 1e-6);
  }
};

/// An arm whose sections bend by `gains` times the commanded bends, while its readings show the commanded
/// ones.
class WrongArm : public AlteredArm {
 public:
  WrongArm(ArmPort& arm, const std::vector<double>& gains)
      : AlteredArm(
            arm,
            [=](ArmReading reading) {
              for (std::size_t i = 0; i < gains.size(); ++i) reading.state.bends[i] /= gains[i];
              return reading;
            },
            [=](ArmState bent) {
              for (std::size_t i = 0; i < gains.size(); ++i) bent.bends[i] *= gains[i];
              return bent;
            }) {}
};

/// A head whose pan motor accepts commands and does not turn.
class StuckPan : public AlteredHead {
 public:
  explicit StuckPan(HeadPort& head)
      : AlteredHead(
            head, [](HeadReading reading) { return reading; },
            [](HeadState state) {
              state.pan = 0;
              return state;
            }) {}
};

/// A head that reports the commanded pan angle but stands `slip` rad beside it: from its first turn on, or
/// from a call of push() on.
class SlippedPan : public HeadPort {
 public:
  enum class Since { first_turn, push };

  SlippedPan(HeadPort& head, double slip, Since since = Since::first_turn)
      : head_(head), slip_(slip), since_(since) {}
  void push() { is_slipped_ = true; }
  CommandOutcome command(const HeadState& state) override {
    if (since_ == Since::first_turn && state.pan != 0) is_slipped_ = true;
    HeadState reached = state;
    if (is_slipped_) reached.pan += slip_;
    return head_.command(reached);
  }
  CommandOutcome halt() override { return head_.halt(); }
  Outcome<HeadReading> read() override {
    auto reading = head_.read();
    if (reading.fault() || !is_slipped_) return reading;
    HeadReading reported = reading.value();
    reported.state.pan -= slip_;
    return reported;
  }

 private:
  HeadPort& head_;
  double slip_ = 0;
  Since since_;
  bool is_slipped_ = false;
};

}  // namespace flexura
