// Errors that stop each of the paper's loops, and the bundle with the cylinder. The reason must be reported,
// and everything sent back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "flexura/base/degree.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

struct StoppedLoop : testing::TestWithParam<const char*> {
  static bool sees_arm() { return std::string(GetParam()).starts_with("arcs"); }

  // Returns a rig that is right except for `wrong`, with pictures of half the size.
  static std::string rig(const WrongStart& wrong, const std::string& task = "",
                         const std::string& sensor = "") {
    LoopRig rig;
    if (sees_arm()) rig = arcs_cameras({}, std::string(GetParam()) == "arcs-paper");
    rig.wrong = {WrongStart{.pan = 0.1}, wrong}, rig.size = 0.5, rig.sensor = sensor;
    const std::string method = std::string("method = \"") + GetParam() + "\"\n" + task;
    return sees_arm() ? arcs_rig(method, rig) : etalon_rig(method, rig);
  }
  static void expect_stop(CalibrationBench& bench, const LoopResult& result,
                          const testing::Matcher<std::string>& reason) {
    EXPECT_FALSE(result.is_done);
    EXPECT_THAT(result.reason, reason);
    EXPECT_THAT(result.reason, HasSubstr("have returned to the start"));
    bench.expect_back();
  }
};

TEST_P(StoppedLoop, OfWhichACameraSeesNothing) {
  CalibrationBench bench(rig({.pan = 1.2}));
  expect_stop(
      bench, bench.calibrate(),
      AnyOf(HasSubstr("out of view of camera side"), HasSubstr("camera side does not see the cylinder")));
}

TEST_P(StoppedLoop, OfWhichACameraGivesNoFrame) {
  CalibrationBench bench(rig({}, "frame_timeout = 1\n", ", drop = 1"));
  expect_stop(bench, bench.calibrate(), HasSubstr("camera front sent no frame for 1 s"));
}

TEST_P(StoppedLoop, WhoseHeadDoesNotTurn) {
  CalibrationBench bench(rig({}));
  RigPorts ports = bench.ports();
  StuckPan stuck(*ports.cameras[0].head);
  ports.cameras[0].head = &stuck;
  expect_stop(bench, bench.calibrate(ports),
              HasSubstr("the head of camera front does not follow: pan was commanded to"));
}

// The arm permanently reports that it moves.
TEST_P(StoppedLoop, WhoseArmMovesOn) {
  CalibrationBench bench(rig({}));
  RigPorts ports = bench.ports();
  AlteredArm restless(*ports.arm, [](ArmReading reading) {
    reading.moving = true;
    return reading;
  });
  ports.arm = &restless;
  const LoopResult result = bench.calibrate(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("a device is still moving 20 s after the last command"));
}

INSTANTIATE_TEST_SUITE_P(OfThePaper, StoppedLoop,
                         testing::Values("etalon", "etalon-paper", "arcs", "arcs-paper"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase(name, '-');
                           return name;
                         });

// With the arm as target; four equal lines cannot reveal it (docs/calibration-paper.md, "etalon").
TEST(ArcsLoop, StopsWhereBothCamerasTrulyLookFromOneSide) {
  LoopRig rig = arcs_cameras({});
  rig.wrong[1] = {.pan = 1.41, .shift = {-0.4 - rig.at[1][0], 0, 2.45 - rig.at[1][2]}}, rig.size = 0.5;
  CalibrationBench bench(arcs_rig("method = \"arcs\"\n", rig));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason,
              HasSubstr("both cameras look from one side: the angle between their axes is observed to be"));
  EXPECT_THAT(result.reason, HasSubstr("at the limit of its range"));
  bench.expect_back();
}

// They take the next line for their own, at a right angle.
TEST(EtalonLoop, CannotTellThatACameraStandsARightAngleAround) {
  LoopRig rig;
  rig.wrong[1] = {.pan = 1.41, .shift = {1.1, 0, 1.45}}, rig.size = 0.5;
  CalibrationBench loop(etalon_rig("method = \"etalon\"\n", rig));
  const LoopResult result = loop.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_NEAR(loop.truth(result).angle, -90 * degree, 0.2 * degree);
  CalibrationBench bundle(etalon_rig("method = \"bundle-etalon\"\n", rig));
  const RigSessionResult at_once = bundle.calibrate_bundle(bundle.ports());
  ASSERT_TRUE(at_once.is_done) << at_once.reason;
  EXPECT_NEAR(bundle.truth(at_once.target).angle, -90 * degree, 0.2 * degree);
}

struct StoppedBundle {
  static std::string rig(const WrongStart& wrong, const std::string& task = "",
                         const std::string& sensor = "", const std::string& etalon = "") {
    LoopRig rig;
    rig.wrong = {WrongStart{.pan = 0.1}, wrong}, rig.size = 0.5, rig.sensor = sensor;
    return etalon_rig("method = \"bundle-etalon\"\n" + task, rig, etalon);
  }
  static void expect_stop(CalibrationBench& bench, const RigPorts& ports,
                          const testing::Matcher<std::string>& reason) {
    const RigSessionResult result = bench.calibrate_bundle(ports);
    EXPECT_FALSE(result.is_done);
    EXPECT_THAT(result.reason, reason);
    EXPECT_THAT(result.reason, HasSubstr("have returned to the start"));
    bench.expect_back();
  }
};

TEST(BundleEtalon, StopsWhereTheCylinderIsOutOfView) {
  CalibrationBench bench(StoppedBundle::rig({.pan = 1.2}));
  StoppedBundle::expect_stop(bench, bench.ports(), HasSubstr("the cylinder is out of view of camera side"));
}

TEST(BundleEtalon, StopsWhereTheCylinderTouchesTheBorder) {
  CalibrationBench bench(StoppedBundle::rig({}, "", "", "radius = 0.1\nheight = 2.6\n"));
  StoppedBundle::expect_stop(bench, bench.ports(), HasSubstr("camera front does not see the whole cylinder"));
}

// With the default screens, whose borders appear in pictures aimed aside.
TEST(BundleEtalon, KeepsToWhatTheScreensFill) {
  std::string text = etalon_rig("method = \"bundle-etalon\"\nimages = 6\n", arcs_cameras({}));
  for (std::size_t at = text.find("[[stand.screen]]"); at != std::string::npos;
       at = text.find("[[stand.screen]]"))
    text.erase(
        at,
        text.find('[', at + 16 + std::string("\ncenter = [0, 0.5, -1.5]\nnormal = [0, 0, 1]").size()) - at);
  ASSERT_EQ(text.find("screen"), std::string::npos) << text;
  CalibrationBench bench(text);
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_TRUE(result.is_done) << result.reason;
}

TEST(BundleEtalon, StopsWhereBothCamerasLookFromOneSide) {
  LoopRig rig;
  rig.size = 0.5, rig.travel = 0.2;
  std::string text = etalon_rig("method = \"bundle-etalon\"\n", rig);
  const std::string side = "position = [-1.5, 0.5, 0]";
  for (std::size_t at = text.find(side); at != std::string::npos; at = text.find(side))
    text.replace(at, side.size(), "position = [-0.4, 0.5, 1.45]");
  const std::string look = "look_at = [-0.5, 0.5, ";
  for (std::size_t at = text.find(look); at != std::string::npos; at = text.find(look))
    text.replace(at, text.find(']', at) + 1 - at, "look_at = [0, 0.5, 0]");
  CalibrationBench bench(text);
  StoppedBundle::expect_stop(bench, bench.ports(), HasSubstr("both cameras look from one side"));
}

}  // namespace
}  // namespace flexura
