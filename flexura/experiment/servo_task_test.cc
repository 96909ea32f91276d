#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

const ArmState desired = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};

class ServoLaws : public testing::TestWithParam<std::string> {};

TEST_P(ServoLaws, BringTheArmToAShape) {
  const std::string law = GetParam();
  ServoBench bench(servo_file(fmt::format("law = \"{}\"\n", law) + servo_target));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  const ServoError left = bench.truth(desired);
  std::printf("%s: settled in %.2f s, %.4f %% of the length left\n", law.c_str(), *result.settled,
              100 * left.rms);
  EXPECT_LT(left.rms, 0.005);
  EXPECT_LT(*result.settled, 2);
  EXPECT_LT(result.overshoot, 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, ServoLaws,
                         testing::Values("shape", "points", "chords", "potential", "silhouettes"));

// Chords near a quarter turn of the azimuth, on the way across one, and along a camera's line of sight. There
// two parallel readings give little or wrong information: targets of the servo's study.
TEST(Servo, FollowsThePotentialAcrossQuarterTurns) {
  for (const char* bends :
       {"[0.73, 1.13], [0.36, -0.06], [0.77, -0.41]", "[-0.09, 1.01], [-0.91, -0.55], [-1.19, 0.10]",
        "[-0.59, -0.20], [0.51, -0.43], [0.90, -0.97]"}) {
    ServoBench bench(servo_file(fmt::format(
        "law = \"potential\"\ntolerance = 0.002\nsettle = 1\n[[task.target]]\nbends = [{}]\n", bends)));
    const ServoResult result = bench.servo();
    ASSERT_TRUE(result.is_done) << bends << ": " << result.reason;
    const auto goal = std::get<ArmState>(bench.config().goals.front().shape);
    std::printf("settled in %.2f s, %.4f %% of the length left\n", result.settled.value_or(-1),
                100 * bench.truth(goal).rms);
    EXPECT_LT(bench.truth(goal).rms, 0.003);
    EXPECT_LT(*result.settled, 4);
  }
}

// Without delay and noise, an arm that follows its commands must have a decreasing potential.
class IdealServo : public testing::TestWithParam<std::string> {};

TEST_P(IdealServo, PotentialFallsAllTheWay) {
  ServoSetup rig;
  rig.sensor = "delay = 0, exposure = 0";
  ServoBench bench(servo_file(
      fmt::format("law = \"{}\"\ntolerance = 0.002\nsettle = 1\n", GetParam()) + servo_target, rig));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  // Limit of precision of pictures of 320 x 240. It is larger for `potential`, whose chords are 30 px long
  // and measured to a hundredth of a rad.
  const double least = GetParam() == "potential" ? 3e-3 : 1e-3;
  double before = 1e300, first = 0;
  int fell = 0;
  for (const ServoStep& step : result.steps) {
    if (!step.is_fresh) continue;
    if (before > 1e299) first = step.potential;
    const bool is_reported = before > least * first;
    if (is_reported) {
      EXPECT_LT(step.potential, before) << "at " << step.time << " s";
      if (step.potential < before) ++fell;
    }
    before = step.potential;
  }
  EXPECT_GT(fell, 15);
  EXPECT_LT(before, 2e-3 * first);
}

INSTANTIATE_TEST_SUITE_P(All, IdealServo,
                         testing::Values("shape", "points", "chords", "potential", "silhouettes"));

// Pictures with a larger delay than the motion takes: each effect is observed before the next action.
TEST(Servo, IsPatientWithLatePictures) {
  ServoSetup setup;
  setup.sensor = "read_noise = 1, delay = 1, exposure = 0.002";
  ServoBench bench(servo_file("hold_after = 3\ngive_up_after = 10\n" + servo_target, setup));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(desired).rms, 0.006);
  EXPECT_LT(result.overshoot, 0.05);
}

// Heads follow an arm that leaves the middle of their pictures, in spite of the delay, and come to rest.
TEST(Servo, HeadsFollowTheArm) {
  ServoSetup setup;
  setup.sensor = "read_noise = 1, delay = 0.3, exposure = 0.002";
  ServoBench bench(servo_file(
      "follow = true\nhold_after = 1\n[[task.target]]\nbends = [[1.2, 0.9], [0.8, 0.6], [0.2, 0.1]]\n",
      setup));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  const ArmState bent = {{{1.2, 0.9}, {0.8, 0.6}, {0.2, 0.1}}, {1, 1, 1}};
  EXPECT_LT(bench.truth(bent).rms, 0.006);
  // The middle of the visible arm is near the middle of the picture, which it had left.
  const Backbone backbone(bench.experiment().arm.arm(), bent);
  const View turned = bench.rig().camera(0).view(bench.rig().clock().now());
  const View straight = ServoBench(servo_file(servo_target, setup)).rig().camera(0).view(0);
  const auto off = [&](const View& view) {
    Eigen::AlignedBox2d box;
    for (int i = 0; i <= 20; ++i)
      box.extend(*view.project(backbone.pose(backbone.length() * i / 20).position));
    return (box.center() - Eigen::Vector2d(159.5, 119.5))
        .cwiseAbs()
        .cwiseQuotient(Eigen::Vector2d(320, 240))
        .maxCoeff();
  };
  std::printf("off the middle: %.3f, without turning %.3f\n", off(turned), off(straight));
  EXPECT_GT(off(straight), 0.15);
  EXPECT_LT(off(turned), 0.16);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_FALSE(bench.ports().cameras[i].head->read().value().moving);
}

TEST(Servo, GoesAlongATrajectory) {
  ServoBench bench(
      servo_file("tolerance = 0.004\n[[task.target]]\nbends = [[0, 0], [0, 0], [0, 0]]\n"
                 "[[task.target]]\ntime = 1.5\nbends = [[0.8, 0.3], [-0.7, 0.9], [1.0, -0.6]]\n"
                 "[[task.target]]\ntime = 3\nbends = [[0, 0.5], [0.5, 0], [0, -0.5]]\n"));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth({{{0, 0.5}, {0.5, 0}, {0, -0.5}}, {1, 1, 1}}).rms, 0.004);
  // During the motion it keeps up: the target's motion is commanded in addition to the error.
  double worst = 0;
  for (const ServoStep& step : result.steps)
    if (step.error) worst = std::max(worst, step.error->rms);
  std::printf("worst on the way: %.4f of the length\n", worst);
  EXPECT_LT(worst, 0.02);
}

// Returns a setup with this true sensor of the camera "side".
ServoSetup side_camera(const std::string& sensor) {
  return {.rest = "[[truth.camera]]\nname = \"side\"\nsensor." + sensor + "\n"};
}

TEST(Servo, WaitsWhileACameraIsCovered) {
  ServoBench bench(servo_file(servo_target, side_camera("covered = [[0.3, 1.3]]")));
  ServoNotes notes;
  const ServoResult result = bench.servo(bench.ports(), notes);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_TRUE(notes.has("camera side does not see the arm")) << notes.lines.size();
  EXPECT_TRUE(notes.has("the arm is visible again"));
  // It stopped during the motion: equal consecutive commands.
  int still = 0;
  for (std::size_t i = 1; i < notes.sent.size(); ++i)
    if (notes.sent[i].first < 1.3 && notes.sent[i].second.bends == notes.sent[i - 1].second.bends) ++still;
  EXPECT_GT(still, 10);
  EXPECT_LT(bench.truth(desired).rms, 0.006);
}

TEST(Servo, GivesUpWithoutACamera) {
  ServoBench bench(servo_file("give_up_after = 1\n" + servo_target, side_camera("silent = [[0.4, 1e6]]")));
  const ServoResult result = bench.servo();
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("out of view: camera side: link lost"), std::string::npos) << result.reason;
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
  EXPECT_LT(result.steps.back().time, 2.0);
}

TEST(Servo, StopsWhenTheArmFails) {
  for (const auto& [kind, words] : {std::pair{BrokenArm::Kind::refuses, "the arm: refused: not today"},
                                    std::pair{BrokenArm::Kind::nowhere, "readings are not finite"},
                                    std::pair{BrokenArm::Kind::gone, "the arm: link lost: no answer"}}) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    BrokenArm broken(*ports.arm, *ports.clock, kind, 0.4);
    ports.arm = &broken;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_FALSE(result.is_done);
    EXPECT_NE(result.reason.find(words), std::string::npos) << result.reason;
    ASSERT_TRUE(result.fault);
    EXPECT_TRUE(result.fault->observed);
    EXPECT_FALSE(result.fault->sent.bends.empty());
    EXPECT_LT(result.steps.back().time, 1.5);
    bench.rig().clock().wait_until(bench.rig().clock().now() + 0.5);
    EXPECT_FALSE(bench.ports().arm->read().value().moving) << words;
    for (const auto& [time, state] : notes.sent)
      for (const Eigen::Vector2d& bend : state.bends) EXPECT_TRUE(bend.allFinite());
  }
}

TEST(Servo, RefusesWhatIsOutOfReachBeforeItMoves) {
  ServoBench bench(servo_file("[[task.target]]\nposition = [0, 0.2, 1.2]\n"));
  ServoNotes notes;
  const ServoResult result = bench.servo(bench.ports(), notes);
  EXPECT_FALSE(result.is_done);
  EXPECT_TRUE(result.reason.starts_with("not reachable: the nearest shape")) << result.reason;
  EXPECT_TRUE(notes.sent.empty());
}

TEST(Servo, SaysThatItIsHeldBack) {
  // An arm that truly bends by half of the command cannot reach the target within its limits.
  ServoSetup rig;
  rig.arm = "max_bend_deg = 60";
  ServoBench bench(servo_file("timeout = 3\n[[task.target]]\nbends = [[1.0, 0], [0, 0], [0, 0]]\n", rig));
  RigPorts ports = bench.ports();
  TurnedArm half(*ports.arm, 0, 0.5);
  ports.arm = &half;
  const ServoResult result = bench.servo(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_TRUE(result.reason.starts_with("saturated: ")) << result.reason;
}

TEST(Servo, ReachesPicturesByCamerasThatAreElsewhere) {
  // Both cameras are turned by half a degree, unknown to the model; the pictures are from them.
  ServoSetup rig;
  rig.rest =
      "[[truth.camera]]\nname = \"front\"\ninitial = { pan_deg = 0.5, tilt_deg = -0.3 }\n"
      "[[truth.camera]]\nname = \"side\"\ninitial = { pan_deg = -0.4, tilt_deg = 0.5 }\n";
  ServoBench bench(servo_file("tolerance = 0.004\nsettle = 1\n" + servo_target, rig));
  RigBench other(servo_file(servo_target,
                            {rig.sensor, rig.arm + "\n",
                             "[arm.initial]\nbends = [[0.8, 0.3], [-0.7, 0.9], [1.0, -0.6]]\n" + rig.rest}));
  ServoConfig config = bench.config();
  RecordedViews views;
  for (std::size_t i = 0; i < 2; ++i) views[i] = *other.ports().cameras[i].camera->wait(1).value()->picture;
  config.goals = {{0, views}}, config.law = ServoLawKind::points;
  ServoNotes notes;
  const RigModel model = bench.nominal();
  const ServoResult result = servo_in_session(bench.ports(), model, config, notes);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(desired).rms, 0.003);
}

// The result of a servo must not depend on whether its steps are kept.
TEST(Servo, KeepsNoStepsWhereNoneAreAskedFor) {
  ServoResult kept, left;
  for (ServoResult* result : {&kept, &left}) {
    ServoBench bench(servo_file(servo_target));
    ServoConfig config = bench.config();
    config.keeps_steps = result == &kept;
    ServoNotes notes;
    const RigModel model = bench.nominal();
    *result = servo_in_session(bench.ports(), model, config, notes);
    ASSERT_TRUE(result->is_done) << result->reason;
  }
  EXPECT_GT(kept.steps.size(), 20U);
  EXPECT_TRUE(left.steps.empty());
  EXPECT_EQ(kept.settled, left.settled);
  EXPECT_EQ(kept.overshoot, left.overshoot);
  EXPECT_EQ(kept.remaining->rms, left.remaining->rms);
}

}  // namespace
}  // namespace flexura
