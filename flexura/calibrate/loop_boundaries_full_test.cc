// Where the paper's loops end, and where not (docs/calibration-paper.md, "When a loop ends"): the loops
// themselves before simulated rigs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/degree.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// What the steps of this name were about, of the first camera, in order.
std::vector<double> offsets_of(const LoopResult& result, const std::string& step) {
  std::vector<double> offsets;
  for (const LoopDecision& decision : result.steps)
    if (decision.camera == 0 && decision.step == step) offsets.push_back(decision.offset);
  return offsets;
}

// The first camera's stage is `turned` from across its sight, which nobody knows, and starts `aside` m beside
// the line.
std::string turned_stage(double turned, double aside) {
  LoopRig rig;
  rig.wrong[0] = {.pan = turned, .shift = {aside, 0, 0}, .pan_zero = -turned};
  rig.travel = 1;
  return etalon_rig("method = \"etalon\"\nimages = 90\n", rig);
}

TEST(LoopBoundaries, EtalonEndsWhereTheStageIsTurnedByLessThanARightAngle) {
  for_random_cases(6, [](TestRandom& random) {
    const double side = random.integer(0, 1) == 1 ? 1 : -1;
    const double turned = side * random.uniform(40, 75) * degree;
    CalibrationBench bench(turned_stage(turned, (random.integer(0, 1) == 1 ? 1 : -1) * 0.06));
    const LoopResult result = bench.calibrate();
    ASSERT_TRUE(result.is_done) << result.reason;
    EXPECT_LT(std::abs(bench.truth(result).angle), 0.2 * degree);
    EXPECT_LT(bench.truth(result).aim[0].norm(), 0.01);
    // Each step leaves the eigenvalue 1 - cos(turned).
    const std::vector<double> line = offsets_of(result, "horizontal positioning");
    ASSERT_GE(line.size(), 2U);
    for (std::size_t i = 1; i < line.size() && std::abs(line[i - 1]) > 1; ++i)
      EXPECT_NEAR(line[i] / line[i - 1], 1 - std::cos(turned), 0.12) << turned / degree;
  });
}

TEST(LoopBoundaries, EtalonRunsAwayWhereTheStageIsTurnedByMore) {
  for_random_cases(5, [](TestRandom& random) {
    const double turned = (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(97, 115) * degree;
    CalibrationBench bench(turned_stage(turned, 0.06));
    const LoopResult result = bench.calibrate();
    EXPECT_FALSE(result.is_done);
    EXPECT_THAT(result.reason, HasSubstr("horizontal positioning of camera front runs away"));
    const std::vector<double> line = offsets_of(result, "horizontal positioning");
    ASSERT_GE(line.size(), 2U);
    EXPECT_NEAR(line[1] / line[0], 1 - std::cos(turned), 0.12) << turned / degree;
    bench.expect_back();
  });
}

// The same of heights: the first camera starts `up` m above the cylinder's middle, its stage turned in tilt.
std::string tilted_stage(double turned, double up) {
  LoopRig rig;
  WrongStart& wrong = rig.wrong[0];
  wrong = {.tilt = turned, .shift = {0, up, 0}, .tilt_zero = -turned};
  // Beyond upright a mount that looks along there hangs upside down.
  if (std::abs(turned) > std::numbers::pi / 2) wrong.roll = std::numbers::pi;
  rig.travel = 1;
  return etalon_rig("method = \"etalon\"\nimages = 90\n", rig);
}

// What the first camera's stage was sent down by, m, in order.
std::vector<double> slides_down(const LoopResult& result) {
  std::vector<double> slides;
  const std::string_view what = "slide downwards by ";
  for (const LoopDecision& decision : result.steps)
    if (decision.camera == 0 && decision.next.starts_with(what))
      slides.push_back(std::stod(decision.next.substr(what.size())));
  return slides;
}

TEST(LoopBoundaries, EtalonEndsInHeightWhereTheStageIsTiltedByLessThanARightAngle) {
  for_random_cases(4, [](TestRandom& random) {
    const double turned = (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(40, 70) * degree;
    CalibrationBench bench(tilted_stage(turned, (random.integer(0, 1) == 1 ? 1 : -1) * 0.15));
    const LoopResult result = bench.calibrate();
    ASSERT_TRUE(result.is_done) << result.reason;
    EXPECT_LT(std::abs(bench.truth(result).angle), 0.2 * degree);
    EXPECT_LT(bench.truth(result).aim[0].norm(), 0.01);
    const std::vector<double> down = slides_down(result);
    ASSERT_GE(down.size(), 2U);
    for (std::size_t i = 1; i < down.size() && std::abs(down[i - 1]) > 0.08; ++i)
      EXPECT_NEAR(down[i] / down[i - 1], 1 - std::cos(turned), 0.12) << turned / degree;
  });
}

TEST(LoopBoundaries, EtalonRunsAwayInHeightWhereTheStageIsTiltedByMore) {
  for_random_cases(5, [](TestRandom& random) {
    const double turned = (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(97, 115) * degree;
    CalibrationBench bench(tilted_stage(turned, 0.1));
    const LoopResult result = bench.calibrate();
    EXPECT_FALSE(result.is_done);
    EXPECT_THAT(result.reason, HasSubstr("vertical positioning of camera front runs away"));
    const std::vector<double> down = slides_down(result);
    ASSERT_GE(down.size(), 2U);
    // Half of what grows is taken from there on.
    EXPECT_NEAR(2 * down[1] / down[0], 1 - std::cos(turned), 0.15) << turned / degree;
    bench.expect_back();
  });
}

// Lenses whose focal lengths truly grow as the zoom's power `power`, before a cylinder that the first camera
// sees from `nearer` m nearer.
std::string wrong_zoom(double power, double nearer) {
  std::string rows;
  for (double ratio = 1; ratio < 10.05; ratio += 0.1)
    rows += fmt::format("{{ ratio = {0}, fx = {1}, fy = {1} }}, ", ratio, 800 * std::pow(ratio, power));
  LoopRig rig;
  rig.wrong[0].shift = {0, 0, -nearer};
  std::string text = etalon_rig("method = \"etalon\"\nimages = 60\n", rig);
  const std::string lens = "distortion = [0, 0, 0, 0, 0] }";
  for (std::size_t at = text.find(lens, text.find("[[truth.camera]]")); at != std::string::npos;
       at = text.find(lens, at + 1))
    text.insert(at + lens.size() - 2, ", zoom = [" + rows + "]");
  return text;
}

// Logarithms of the ratios that were seen, in order.
std::vector<double> zoom_offsets(const LoopResult& result) {
  std::vector<double> offsets;
  for (const LoopDecision& decision : result.steps)
    if (decision.step == "zoom") offsets.push_back(std::log1p(decision.offset));
  return offsets;
}

TEST(LoopBoundaries, EtalonsZoomEndsWhereLensesGrowByLessThanTwiceWhatIsBelieved) {
  for_random_cases(6, [](TestRandom& random) {
    const double power = random.uniform(0.4, 1.6);
    CalibrationBench bench(wrong_zoom(power, (random.integer(0, 1) == 1 ? 1 : -1) * 0.15));
    const LoopResult result = bench.calibrate();
    ASSERT_TRUE(result.is_done) << power << ": " << result.reason;
    EXPECT_NEAR(bench.truth(result).zoom_ratio, 1, 0.01);
    const std::vector<double> off = zoom_offsets(result);
    ASSERT_GE(off.size(), 2U);
    EXPECT_NEAR(off[1] / off[0], 1 - power, 0.05) << power;
  });
}

TEST(LoopBoundaries, EtalonsZoomDoesNotEndWhereLensesGrowByMore) {
  for_random_cases(4, [](TestRandom& random) {
    const double power = random.uniform(2.2, 2.5);
    CalibrationBench bench(wrong_zoom(power, (random.integer(0, 1) == 1 ? 1 : -1) * 0.15));
    const LoopResult result = bench.calibrate();
    EXPECT_FALSE(result.is_done);
    EXPECT_THAT(result.reason, HasSubstr("zoom"));
    const std::vector<double> off = zoom_offsets(result);
    ASSERT_GE(off.size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) EXPECT_NEAR(off[i] / off[i - 1], 1 - power, 0.1) << power;
    bench.expect_back();
  });
}

// Carried around the circle's centre, to the side that is tried first or the other one.
TEST(LoopBoundaries, ArcsPaperGoesBackAroundTheCentreFromEitherSide) {
  for_random_cases(8, [](TestRandom& random) {
    const double tilt = (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(8, 17) * degree;
    const double aside = 2.5 * std::sin(tilt), back = 2.5 * (std::cos(tilt) - 1);
    const bool is_across = random.integer(0, 1) == 1;
    WrongStart wrong;
    wrong.shift = {is_across ? aside : 0, is_across ? 0 : aside, back};
    (is_across ? wrong.pan : wrong.tilt) = is_across ? tilt : -tilt;
    LoopRig rig = arcs_cameras({wrong, WrongStart{}}, true);
    rig.travel = 2;
    CalibrationBench bench(arcs_rig("method = \"arcs-paper\"\n", rig));
    const LoopResult result = bench.calibrate();
    ASSERT_EQ(offsets_of(result, "circle").size(), 1U) << tilt / degree << ": " << result.reason;
    const std::vector<double> ratios = offsets_of(result, "ratio of axes");
    ASSERT_GE(ratios.size(), 1U);
    EXPECT_LE(ratios.size(), 6U) << tilt / degree;
    std::vector<double> tilts;
    tilts.reserve(ratios.size());
    for (const double off : ratios) tilts.push_back(std::acos(1 - off) / degree);
    const Eigen::Vector3d axis = bench.rig().camera(0).view(bench.rig().clock().now()).X_WC.rotation.col(2);
    const double left = std::acos(-axis.z()) / degree;
    EXPECT_LT(left, 2.5) << tilt / degree;
    // A wrong side makes twice as much of it.
    for (std::size_t i = 1; i < tilts.size(); ++i) EXPECT_LT(tilts[i], 2.2 * tilts[i - 1]);
  });
}

// A lens that is `focal` times as long as it is believed to be: each turn goes too far by focal - 1 of
// what is missing.
std::string wrong_lens(TestRandom& random, double focal) {
  // To the side that no screen hides.
  const double tilt = -random.uniform(14, 17) * degree;
  constexpr double distance = 5;
  WrongStart wrong;
  wrong.shift = {distance * std::sin(tilt), 0, distance * (std::cos(tilt) - 1)};
  wrong.pan = tilt + (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(1, 1.5) * degree;
  wrong.focal = focal;
  LoopRig rig = arcs_cameras({wrong, WrongStart{}}, true);
  rig.at[0][2] *= 2, rig.at[1][0] *= 2, rig.travel = 3;
  return arcs_rig("method = \"arcs-paper\"\n", rig);
}

TEST(LoopBoundaries, ArcsPaperCentresTheCircleWithAFocalLengthBelowTwiceTheBelieved) {
  for_random_cases(6, [](TestRandom& random) {
    const double focal = random.uniform(1.2, 1.8);
    CalibrationBench bench(wrong_lens(random, focal));
    const LoopResult result = bench.calibrate();
    const std::vector<double> off = offsets_of(result, "centre");
    ASSERT_GE(off.size(), 2U) << result.reason;
    EXPECT_NEAR(off[1] / off[0], focal - 1, 0.15) << focal;
  });
}

TEST(LoopBoundaries, ArcsPaperRunsAwayWithAFocalLengthBeyond) {
  for_random_cases(6, [](TestRandom& random) {
    const double focal = random.uniform(2.15, 2.4);
    CalibrationBench bench(wrong_lens(random, focal));
    const LoopResult result = bench.calibrate();
    EXPECT_FALSE(result.is_done);
    const std::vector<double> off = offsets_of(result, "centre");
    ASSERT_GE(off.size(), 3U) << result.reason;
    for (std::size_t i = 1; i < 3; ++i) EXPECT_NEAR(off[i] / off[i - 1], focal - 1, 0.2) << focal;
    bench.expect_back();
  });
}

}  // namespace
}  // namespace flexura
