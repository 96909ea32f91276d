// Where the paper's loops end and where they do not (docs/calibration-paper.md, "Convergence"), with the
// loops themselves and simulated rigs.
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

// Offsets of the first camera's steps with this name, in order.
std::vector<double> offsets_of(const LoopResult& result, const std::string& step) {
  std::vector<double> offsets;
  for (const LoopDecision& decision : result.steps)
    if (decision.camera == 0 && decision.step == step) offsets.push_back(decision.offset);
  return offsets;
}

// A random magnitude with a random sign.
double to_a_side(TestRandom& random, double least, double most) {
  return (random.integer(0, 1) == 1 ? 1 : -1) * random.uniform(least, most);
}

// The first camera's stage has an unmodelled rotation in pan or in tilt. The camera starts beside the line,
// or above or below the cylinder's middle.
std::string turned_stage(bool is_tilted, double turned, double off) {
  LoopRig rig;
  WrongStart& wrong = rig.wrong[0];
  if (is_tilted)
    wrong = {.tilt = turned, .shift = {0, off, 0}, .tilt_zero = -turned};
  else
    wrong = {.pan = turned, .shift = {off, 0, 0}, .pan_zero = -turned};
  // Tilted beyond a right angle, a mount that looks in this direction is upside down.
  if (is_tilted && std::abs(turned) > std::numbers::pi / 2) wrong.roll = std::numbers::pi;
  rig.travel = 1;
  return etalon_rig("method = \"etalon\"\nimages = 90\n", rig);
}

// Offsets that the first camera's slides correct, in order: of the line, or downwards.
std::vector<double> slides(const LoopResult& result, bool is_tilted) {
  if (!is_tilted) return offsets_of(result, "horizontal positioning");
  std::vector<double> slides;
  const std::string_view what = "slide downwards by ";
  for (const LoopDecision& decision : result.steps)
    if (decision.camera == 0 && decision.next.starts_with(what))
      slides.push_back(std::stod(decision.next.substr(what.size())));
  return slides;
}

void expect_end_of_turned_stage(bool is_tilted, bool is_beyond, TestRandom& random) {
  const double turned = (is_beyond ? to_a_side(random, 97, 115) : to_a_side(random, 40, 70)) * degree;
  SCOPED_TRACE(fmt::format("{} by {} deg", is_tilted ? "tilted" : "turned", turned / degree));
  const double away = is_tilted ? (is_beyond ? 0.1 : 0.15) : 0.06;
  CalibrationBench bench(turned_stage(is_tilted, turned, is_beyond ? away : to_a_side(random, away, away)));
  const LoopResult result = bench.calibrate();
  EXPECT_EQ(result.is_done, !is_beyond) << result.reason;
  const std::vector<double> off = slides(result, is_tilted);
  ASSERT_GE(off.size(), 2U);
  // Each step multiplies the offset by 1 - cos(turned); steps that grow it are halved afterwards.
  if (is_beyond) {
    EXPECT_THAT(result.reason, HasSubstr("al positioning of camera front diverges"));
    EXPECT_NEAR((is_tilted ? 2 : 1) * off[1] / off[0], 1 - std::cos(turned), 0.15);
    bench.expect_back();
    return;
  }
  EXPECT_LT(std::abs(bench.truth(result).angle), 0.2 * degree);
  EXPECT_LT(bench.truth(result).aim[0].norm(), 0.01);
  for (std::size_t i = 1; i < off.size() && std::abs(off[i - 1]) > (is_tilted ? 0.08 : 1); ++i)
    EXPECT_NEAR(off[i] / off[i - 1], 1 - std::cos(turned), 0.12);
}

TEST(LoopBoundaries, EtalonEndsWhereTheStageIsTurnedByLessThanARightAngleAndRunsAwayBeyond) {
  for_random_cases(4, [](TestRandom& random) {
    for (const bool is_tilted : {false, true})
      for (const bool is_beyond : {false, true}) expect_end_of_turned_stage(is_tilted, is_beyond, random);
  });
}

// Lenses whose true focal length grows with the zoom to the power `power`; the first camera is `nearer` m
// closer to the cylinder.
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

// Logarithms of the observed ratios, in order.
std::vector<double> zoom_offsets(const LoopResult& result) {
  std::vector<double> offsets;
  for (const LoopDecision& decision : result.steps)
    if (decision.step == "zoom") offsets.push_back(std::log1p(decision.offset));
  return offsets;
}

TEST(LoopBoundaries, EtalonsZoomEndsWhereLensesGrowByLessThanTwiceWhatIsBelieved) {
  for_random_cases(10, [is_beyond = false](TestRandom& random) mutable {
    is_beyond = !is_beyond;
    const double power = is_beyond ? random.uniform(2.2, 2.5) : random.uniform(0.4, 1.6);
    CalibrationBench bench(wrong_zoom(power, to_a_side(random, 0.15, 0.15)));
    const LoopResult result = bench.calibrate();
    EXPECT_EQ(result.is_done, !is_beyond) << power << ": " << result.reason;
    const std::vector<double> off = zoom_offsets(result);
    ASSERT_GE(off.size(), is_beyond ? 3U : 2U);
    for (std::size_t i = 1; i < (is_beyond ? 3U : 2U); ++i)
      EXPECT_NEAR(off[i] / off[i - 1], 1 - power, is_beyond ? 0.1 : 0.05) << power;
    if (!is_beyond) {
      EXPECT_NEAR(bench.truth(result).zoom_ratio, 1, 0.01);
      return;
    }
    EXPECT_THAT(result.reason, HasSubstr("zoom"));
    bench.expect_back();
  });
}

// Starts rotated around the circle's centre, to the side that is tried first or to the other.
TEST(LoopBoundaries, ArcsPaperGoesBackAroundTheCentreFromEitherSide) {
  for_random_cases(8, [](TestRandom& random) {
    const double tilt = to_a_side(random, 8, 17) * degree;
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
    // A move to the wrong side doubles the tilt at most.
    for (std::size_t i = 1; i < tilts.size(); ++i) EXPECT_LT(tilts[i], 2.2 * tilts[i - 1]);
  });
}

// A lens that is `focal` times as long as modelled: each turn overshoots by the share focal - 1.
std::string wrong_lens(TestRandom& random, double focal) {
  // To the side that no screen hides.
  const double tilt = -random.uniform(14, 17) * degree;
  constexpr double distance = 5;
  WrongStart wrong;
  wrong.shift = {distance * std::sin(tilt), 0, distance * (std::cos(tilt) - 1)};
  wrong.pan = tilt + to_a_side(random, 1, 1.5) * degree;
  wrong.focal = focal;
  LoopRig rig = arcs_cameras({wrong, WrongStart{}}, true);
  rig.at[0][2] *= 2, rig.at[1][0] *= 2, rig.travel = 3;
  return arcs_rig("method = \"arcs-paper\"\n", rig);
}

TEST(LoopBoundaries, ArcsPaperCentresTheCircleWithAFocalLengthBelowTwiceTheBelieved) {
  for_random_cases(10, [is_beyond = false](TestRandom& random) mutable {
    is_beyond = !is_beyond;
    const double focal = is_beyond ? random.uniform(2.15, 2.4) : random.uniform(1.2, 1.8);
    CalibrationBench bench(wrong_lens(random, focal));
    const LoopResult result = bench.calibrate();
    const std::vector<double> off = offsets_of(result, "centre");
    ASSERT_GE(off.size(), is_beyond ? 3U : 2U) << result.reason;
    for (std::size_t i = 1; i < (is_beyond ? 3U : 2U); ++i)
      EXPECT_NEAR(off[i] / off[i - 1], focal - 1, is_beyond ? 0.2 : 0.15) << focal;
    if (!is_beyond) return;
    EXPECT_FALSE(result.is_done);
    bench.expect_back();
  });
}

}  // namespace
}  // namespace flexura
