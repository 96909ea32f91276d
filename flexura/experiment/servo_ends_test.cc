// Tests ends of servos: cameras without a prior, silent cameras, and the record of a servo that ends early.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "flexura/safety/contact_watch.h"
#include "tests/support/runs.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

// Without priors, and with cameras wrong by many pixels, the arm goes to the target by the camera model.
TEST(ServoEnds, CamerasThatAreNotDoubtedAreBelieved) {
  ServoSetup rig;
  rig.rest = "[[truth.camera]]\nname = \"side\"\nhead = { pan = { zero_deg = 0.5 } }\n";
  ServoBench bench(servo_file("camera_prior = { rotation_std = 0, focal_std = 0 }\n" + servo_target, rig));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  // 2.5 m away.
  EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.front().shape)).rms, 0.03);
  // What cameras that are wrong are off by is there in every picture alike: sigma is of the noise.
  ServoBench right(servo_file("camera_prior = { rotation_std = 0, focal_std = 0 }\n" + servo_target));
  const double sigma = right.servo().steps.back().sigma;
  EXPECT_GT(result.steps.back().sigma, sigma / 5);
  EXPECT_LT(result.steps.back().sigma, 5 * sigma);
}

// Exact cameras must lose nothing by this.
TEST(ServoEnds, CamerasThatAreRightNeedNoDoubt) {
  ServoBench bench(
      servo_file("camera_prior = { rotation_std = 0, focal_std = 0 }\ntolerance = 0.0005\nsettle = 0.5\n" +
                 servo_target));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.front().shape)).rms, 0.001);
}

// A lens 20 % shorter than in the file, with a prior of 2 %: no law settles at the wrong shape.
TEST(ServoEnds, ACameraThatIsWrongFarBeyondDoubtIsNamed) {
  ServoSetup rig;
  rig.rest = "[[truth.camera]]\nname = \"side\"\nlens = { fx = 320, fy = 320 }\n";
  for (const char* law : {"shape", "silhouettes"}) {
    ServoBench bench(servo_file(fmt::format("law = \"{}\"\n", law) + servo_target, rig));
    const ServoResult result = bench.servo();
    EXPECT_FALSE(result.is_done) << law;
    EXPECT_TRUE(
        result.reason.starts_with("out of view: camera side's picture fits only if its camera is rotated"))
        << law << ": " << result.reason;
    EXPECT_NE(result.reason.find("its focal length is "), std::string::npos) << law << ": " << result.reason;
  }
}

// Pictures from before anything was known of the arm have an unknown shape.
TEST(ServoEnds, PicturesFromBeforeItBeganAreNotGoneBy) {
  ServoSetup rig;
  rig.sensor = "read_noise = 1, delay = 0.5, exposure = 0.002";
  ServoBench bench(servo_file("hold_after = 1\n" + servo_target, rig));
  RigPorts ports = bench.ports();
  const ArmState bent = {{{0.5, 0}, {0, 0.5}, {0, 0}}, {1, 1, 1}};
  ASSERT_FALSE(ports.arm->command(bent, 1).fault());
  ports.clock->wait_until(1.5);
  const ServoResult result = bench.servo();
  EXPECT_TRUE(result.is_done) << result.reason;
  ASSERT_GE(result.start, 1.5);
  for (const ServoStep& step : result.steps) EXPECT_GE(step.seen_at.value_or(result.start), result.start);
}

// A head that counts its stop commands.
class CountingHead : public HeadPort {
 public:
  explicit CountingHead(HeadPort& head) : head_(head) {}
  CommandOutcome command(const HeadState& state) override { return head_.command(state); }
  CommandOutcome halt() override { return ++halts, head_.halt(); }
  Outcome<HeadReading> read() override { return head_.read(); }

  int halts = 0;

 private:
  HeadPort& head_;
};

// In any case of the end; heads that were not commanded to move are left alone.
TEST(ServoEnds, HeadsThatFollowAreHalted) {
  for (const bool follows : {true, false}) {
    for (const bool refuses : {false, true}) {
      ServoBench bench(servo_file((follows ? "follow = true\n" : "") + servo_target));
      RigPorts ports = bench.ports();
      CountingHead front(*ports.cameras[0].head), side(*ports.cameras[1].head);
      ports.cameras[0].head = &front, ports.cameras[1].head = &side;
      BrokenArm broken(*ports.arm, *ports.clock, BrokenArm::Kind::refuses, refuses ? 0.4 : 1e9);
      ports.arm = &broken;
      EXPECT_EQ(bench.servo(ports).is_done, !refuses);
      EXPECT_EQ(front.halts > 0, follows);
      EXPECT_EQ(side.halts > 0, follows);
    }
  }
}

// A camera that is silent without an error.
class SilentCamera : public CameraPort {
 public:
  Outcome<std::optional<Frame>> newest() override { return std::optional<Frame>(); }
  Outcome<std::optional<Frame>> wait(double) override { return std::optional<Frame>(); }
};

TEST(ServoEnds, ACameraThatSendsNothingIsNamed) {
  ServoBench bench(servo_file(servo_target));
  RigPorts ports = bench.ports();
  SilentCamera silent;
  ports.cameras[1].camera = &silent;
  const ServoResult result = bench.servo(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_EQ(result.reason, "out of view: no pictures were received from camera side");
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->reason, result.reason);
  EXPECT_NEAR(result.fault->time, bench.config().give_up_after, 0.1);
}

// Whatever ends it: the last observation, command and request are kept, and in the summary.
TEST(ServoEnds, WhatIsGivenUpKeepsItsLastObservationsAndCommands) {
  Runs runs;
  const RunResult result = runs.run(servo_file("timeout = 1.5\nrate = 0.2\n" + servo_target));
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  const Node& servo = entry_of(result, "servos");
  const std::string reason = *servo.find("reason")->as<std::string>();
  EXPECT_NE(reason.find("not settled"), std::string::npos) << reason;
  const Node* fault = servo.find("fault");
  ASSERT_NE(fault, nullptr);
  EXPECT_EQ(*fault->find("reason")->as<std::string>(), reason);
  EXPECT_NEAR(*fault->find("time")->as<double>() - *servo.find("start")->as<double>(), 1.5, 0.1);
  for (const char* what : {"observed", "sent", "asked"}) {
    ASSERT_NE(fault->find(what), nullptr) << what;
    const auto& first = *fault->find(what)->as<Node::Array>()->front().as<Node::Array>();
    EXPECT_NEAR(*first[0].as<double>(), 0.8 * (1 - std::exp(-0.2 * 1.5)), 0.05) << what;
    EXPECT_NE(fault->find(std::string(what) + "_stretches"), nullptr);
  }
}

// The middle of a ball is on the target shape: the arm gets as near as allowed, and stops.
TEST(ServoEnds, AnObstacleHoldsTheArmBack) {
  ServoSetup rig;
  rig.rest = "[[obstacle]]\nname = \"ball\"\nkind = \"sphere\"\ncenter = [0.3, 0.75, 0]\nradius = 0.1\n";
  ServoBench bench(
      servo_file("timeout = 3\n[[task.target]]\nbends = [[0.31, 0], [0.31, 0], [0.31, 0]]\n", rig));
  ServoNotes notes;
  const ServoResult result = bench.servo(bench.ports(), notes);
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("saturated: section"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("contact with ball"), std::string::npos) << result.reason;
  const Arm arm = bench.experiment().arm.arm();
  const ContactWatch watch(arm, obstacles(bench.experiment().obstacle).front());
  double nearest = 1;
  for (const auto& [time, state] : notes.sent) nearest = std::min(nearest, watch.contact(state).clearance);
  EXPECT_GE(nearest, -contact_tolerance);
  EXPECT_LT(nearest, 0.02);
}

}  // namespace
}  // namespace flexura
