// Target shapes in a servo's file, and ends of servos that never reach them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "flexura/experiment/run.h"
#include "flexura/picture/image_file.h"
#include "tests/support/quiet.h"
#include "tests/support/servo_bench.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// In the plane XOY, where each section's azimuth changes linearly.
const std::array<double, 3> leanings = {0.8, -0.7, 1.0};
const ArmState leaning = {{{leanings[0], 0}, {leanings[1], 0}, {leanings[2], 0}}, {1, 1, 1}};

// The backbone at shares of 1/20; sections of 0.35, 0.35 and 0.3 m end on the 7th and the 14th.
std::string leaning_curve() {
  const ServoBench bench(servo_file(servo_target));
  const Backbone backbone(bench.experiment().arm.arm(), leaning);
  std::string points;
  for (int k = 0; k <= 20; ++k) {
    const Eigen::Vector3d p = backbone.pose(k * backbone.length() / 20).position;
    points += fmt::format("{}[{}, {}, {}]", k > 0 ? ", " : "", p.x(), p.y(), p.z());
  }
  return "curve = [" + points + "]";
}

std::string leaning_angles() {
  std::string azimuths, elevations;
  double azimuth = 0;
  for (int k = 0; k <= 20; ++k) {
    azimuths += fmt::format("{}{}", k > 0 ? ", " : "", azimuth);
    elevations += k > 0 ? ", 0" : "0";
    const int section = std::min(k / 7, 2);
    azimuth += leanings[static_cast<std::size_t>(section)] / (section < 2 ? 7 : 6);
  }
  return "azimuths = [" + azimuths + "]\nelevations = [" + elevations + "]";
}

TEST(ServoTargets, OneShapeIsReachedByItsBendsItsCurveAndItsAngles) {
  for (const std::string& target :
       {std::string("bends = [[0.8, 0], [-0.7, 0], [1.0, 0]]"), leaning_curve(), leaning_angles()}) {
    ServoBench bench(servo_file("tolerance = 0.003\nsettle = 1\n[[task.target]]\n" + target + "\n"));
    const ServoResult result = bench.servo();
    ASSERT_TRUE(result.is_done) << target << ": " << result.reason;
    EXPECT_LT(bench.truth(leaning).rms, 0.004) << target;
  }
}

std::string curve_file(double tolerance, const std::vector<Eigen::Vector3d>& points) {
  std::string text;
  for (const Eigen::Vector3d& p : points) text += fmt::format("[{}, {}, {}], ", p.x(), p.y(), p.z());
  return servo_file(
      fmt::format("tolerance = {}\nsettle = 1\n[[task.target]]\ncurve = [{}]\n", tolerance, text));
}

// One arc, from which a chord deviates by up to 3 cm.
TEST(ServoTargets, AFewPointsMeanTheSmoothCurveThroughThem) {
  constexpr int count = 4;
  constexpr double bend = 2.4;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= count; ++k)
    points.emplace_back((1 - std::cos(bend * k / count)) / bend, std::sin(bend * k / count) / bend, 0);
  ServoBench bench(curve_file(0.002, points));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(result.missed, 0.0015);
  const ArmState arc = {{{0.35 * bend, 0}, {0.35 * bend, 0}, {0.3 * bend, 0}}, {1, 1, 1}};
  EXPECT_LT(bench.truth(arc).rms, 0.004);
}

// Around a corner.
TEST(ServoTargets, ACurveThatNoArmFollowsIsHeldToTheTolerance) {
  const std::vector<Eigen::Vector3d> corner = {{0, 0, 0}, {0, 0.5, 0}, {0.5, 0.5, 0}};
  ServoBench loose(curve_file(0.1, corner)), strict(curve_file(0.01, corner));
  const ServoResult there = loose.servo();
  ASSERT_TRUE(there.is_done) << there.reason;
  EXPECT_GT(there.missed, 0.01);
  const ServoResult refused = strict.servo();
  EXPECT_FALSE(refused.is_done);
  EXPECT_NE(refused.reason.find("not reachable: the nearest shape"), std::string::npos) << refused.reason;
}

TEST(ServoTargets, APlaceForTheTipIsReached) {
  const Eigen::Vector3d place(0.4, 0.75, 0.2);
  ServoBench bench(
      servo_file("tolerance = 0.003\nsettle = 1\n[[task.target]]\nposition = [0.4, 0.75, 0.2]\n"));
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT((bench.rig().arm().backbone(bench.rig().clock().now()).tip().position - place).norm(), 0.008);
}

// Files from the same cameras, and a motion from there to a target of another form.
TEST(ServoTargets, PictureFilesAreReachedAndGoneOnFrom) {
  const TemporaryFolder folder;
  RigBench other(
      servo_file(servo_target, {.rest = "[arm.initial]\nbends = [[0.8, 0], [-0.7, 0], [1.0, 0]]\n"}));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = other.ports().cameras[i].camera->wait(1).value();
    std::ofstream(folder.path() / fmt::format("{}.png", i), std::ios::binary)
        << png(std::get<Image<std::uint8_t>>(*frame->picture));
  }
  const auto file = folder.path() / "x.toml";
  std::ofstream(file) << servo_file(
      "tolerance = 0.004\nsettle = 1\n[[task.target]]\npictures = [\"0.png\", \"1.png\"]\n"
      "[[task.target]]\ntime = 3\nbends = [[0, 0.5], [0.5, 0], [0, -0.5]]\n");
  std::filesystem::create_directory(folder.path() / "results");
  Quiet quiet;
  const RunResult result = run_experiment(load_experiment(file), folder.path() / "results", quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& servo = result.summary.find("servos")->as<Node::Array>()->front();
  EXPECT_LT(*servo.find("remaining_in_truth")->find("rms")->as<double>(), 0.005);
}

// Four pixels cannot determine six bends. If the arm truly is elsewhere than where they agree, no law on them
// can compute a command.
TEST(ServoTargets, FeaturesThatAreTooFewAreToldAsSingular) {
  ServoBench bench(
      servo_file("law = \"points\"\npoints = 1\ntolerance = 0.002\ntimeout = 3\n" + servo_target));
  const ServoResult result = bench.servo();
  EXPECT_FALSE(result.is_done);
  EXPECT_TRUE(result.reason.starts_with("singular: some motion of the arm changes no feature"))
      << result.reason;
  for (const ServoStep& step : result.steps)
    for (const Eigen::Vector2d& bend : step.sent.bends) EXPECT_TRUE(bend.allFinite());
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
}

// Drives mounted half a turn round move every step in the opposite direction.
TEST(ServoTargets, AnArmThatGoesTheOtherWayIsToldAsDiverging) {
  ServoBench bench(servo_file("[[task.target]]\nbends = [[0.3, 0.1], [-0.2, 0.2], [0.2, -0.3]]\n"));
  RigPorts ports = bench.ports();
  TurnedArm turned(*ports.arm, std::numbers::pi, 1);
  ports.arm = &turned;
  const ServoResult result = bench.servo(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_TRUE(result.reason.starts_with("diverging: ")) << result.reason;
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
}

// The straight arm would fill the pictures from edge to edge.
TEST(ServoTargets, CamerasThatFollowZoomOutToKeepTheArmInView) {
  const std::string bent = "[arm.initial]\nbends = [[0.9, 0.2], [-0.9, 0.3], [0.9, -0.4]]\n";
  std::string file = servo_file(
      "follow = true\nhold_after = 1\ntolerance = 0.004\n[[task.target]]\nbends = [[0, 0], [0, 0], [0, 0]]\n",
      {.rest = bent});
  const std::string lens = "lens = { fx = 400 }";
  for (std::size_t at = 0; (at = file.find(lens, at)) != std::string::npos;)
    file.replace(at, lens.size(), "lens = { fx = 250 }\ninitial = { zoom = 2.4 }");
  ServoBench bench(file);
  const ServoResult result = bench.servo();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(ArmState::straight(3)).rms, 0.005);
  bench.rig().clock().wait_until(bench.rig().clock().now() + 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(bench.ports().cameras[i].head->read().value().state.zoom, 2.3);
    const View view = bench.rig().camera(i).view(bench.rig().clock().now());
    const Eigen::Vector2d tip = view.project({0, 1, 0}).value(), base = view.project({0, 0, 0}).value();
    EXPECT_GT(tip.y(), 5);
    EXPECT_LT(base.y(), 235);
  }
}

}  // namespace
}  // namespace flexura
