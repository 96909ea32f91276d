// What stops the paper's loops, each of them: the reason is said, and everything is sent back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

struct StoppedLoop : testing::TestWithParam<const char*> {
  static bool sees_arm() { return std::string(GetParam()).starts_with("arcs"); }

  // One that is right but for `wrong`, with pictures of half the size.
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
    EXPECT_THAT(result.reason, HasSubstr("back where they began"));
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
  expect_stop(bench, bench.calibrate(), HasSubstr("camera front gave no frame for 1 s"));
}

TEST_P(StoppedLoop, WhoseHeadDoesNotTurn) {
  CalibrationBench bench(rig({}));
  RigPorts ports = bench.ports();
  StuckPan stuck(*ports.cameras[0].head);
  ports.cameras[0].head = &stuck;
  expect_stop(bench, bench.calibrate(ports),
              HasSubstr("the head of camera front does not follow: pan was sent to"));
}

// Whites to the left and to the right are there; those above and below are not, and nothing as printed asks.
TEST(EtalonPaperLoop, IsNotDoneWhereTheBorderCutsTheCylinder) {
  LoopRig rig;
  rig.size = 0.5;
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", rig, "radius = 0.1\nheight = 2.6\n"));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("touches the border"));
  bench.expect_back();
}

INSTANTIATE_TEST_SUITE_P(OfThePaper, StoppedLoop,
                         testing::Values("etalon", "etalon-paper", "arcs", "arcs-paper"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace flexura
