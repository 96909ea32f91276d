// How servos end: by cameras that are believed or silent, and with what is kept of one that is given up.
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

// Nothing is doubted, and cameras are wrong by what is many pixels: the arm comes to where they have it.
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

// And cameras that are right lose nothing by it.
TEST(ServoEnds, CamerasThatAreRightNeedNoDoubt) {
  ServoBench bench(
      servo_file("camera_prior = { rotation_std = 0, focal_std = 0 }\ntolerance = 0.0005\nsettle = 0.5\n" +
                 servo_target));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.front().shape)).rms, 0.001);
}

// A lens 20 % shorter than the file has it, where 2 % are doubted: no law comes to rest in what it takes for
// the wanted shape.
TEST(ServoEnds, ACameraThatIsWrongFarBeyondDoubtIsNamed) {
  ServoSetup rig;
  rig.rest = "[[truth.camera]]\nname = \"side\"\nlens = { fx = 320, fy = 320 }\n";
  for (const char* law : {"shape", "silhouettes"}) {
    ServoBench bench(servo_file(fmt::format("law = \"{}\"\n", law) + servo_target, rig));
    const ServoResult result = bench.servo();
    EXPECT_FALSE(result.is_done) << law;
    EXPECT_TRUE(result.reason.starts_with("out of view: camera side's picture would need its camera turned"))
        << law << ": " << result.reason;
    EXPECT_NE(result.reason.find(" % shorter in focal length"), std::string::npos)
        << law << ": " << result.reason;
  }
}

// Pictures that were taken before anything was known of the arm are of a shape that nobody can say.
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

// A head that counts how often it was told to stop.
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

// However it ends; heads that nobody told to move are left alone.
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

// A camera that is silent without saying why.
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
  EXPECT_EQ(result.reason, "out of view: no pictures come of camera side");
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->reason, result.reason);
  EXPECT_NEAR(result.fault->time, bench.config().give_up_after, 0.1);
}

// Whatever ends it: what was seen, sent and asked for last is kept, and in the summary.
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

// A ball where the wanted shape would be: the arm comes as near as it may, and stands there.
TEST(ServoEnds, AnObstacleHoldsTheArmBack) {
  ServoSetup rig;
  rig.rest = "[[obstacle]]\nname = \"ball\"\nkind = \"sphere\"\ncenter = [0.3, 0.75, 0]\nradius = 0.1\n";
  ServoBench bench(servo_file("timeout = 1.5\n[[task.target]]\nbends = [[0.8, 0], [0.4, 0], [0, 0]]\n", rig));
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
