#include "flexura/report/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace flexura {
namespace {

std::vector<double> clock_ticks(std::size_t count, double step) {
  std::vector<double> times;
  times.reserve(count);
  for (std::size_t i = 0; i < count; ++i) times.push_back(static_cast<double>(i) * step);
  return times;
}

TEST(KeptIndices, AreAllWhenThereAreFew) {
  EXPECT_EQ(kept_indices({0.0, 1.0, 2.0}, {}, 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(kept_indices({5.0}, {5.0}, 2), (std::vector<std::size_t>{0}));
}

TEST(KeptIndices, HoldTheEndsTheEventsAndAnEvenChoice) {
  const std::vector<double> times = clock_ticks(100'001, 0.001);
  const std::vector<std::size_t> kept = kept_indices(times, {33.3333, 66.0}, 2000);
  EXPECT_LE(kept.size(), 2000u);
  EXPECT_GE(kept.size(), 1990u);
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), 100'000u);
  EXPECT_TRUE(std::ranges::binary_search(kept, 33'333u));
  EXPECT_TRUE(std::ranges::binary_search(kept, 66'000u));
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_GT(kept[i], kept[i - 1]);
    EXPECT_LE(kept[i] - kept[i - 1], 51u);
  }
}

TEST(KeptIndices, StayWithinTheLimitHoweverManyEventsThereAre) {
  const std::vector<double> times = clock_ticks(5000, 1.0);
  for (const std::size_t most : {2u, 3u, 4u, 10u, 100u}) {
    const std::vector<std::size_t> kept = kept_indices(times, times, most);
    EXPECT_LE(kept.size(), most);
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), 4999u);
  }
}

TEST(MotionOf, RefusesDataThatDoNotMatch) {
  ReportData data;
  data.arm.sections.resize(2);
  EXPECT_THROW((void)motion_of(data), std::invalid_argument) << "no state";
  data.times = {0.0, 1.0};
  data.states = {ArmState::straight(2)};
  EXPECT_THROW((void)motion_of(data), std::invalid_argument) << "a time without a state";
  data.states.push_back(ArmState::straight(3));
  EXPECT_THROW((void)motion_of(data), std::invalid_argument) << "a state of another arm";
  data.states[1] = ArmState::straight(2);
  EXPECT_NO_THROW((void)motion_of(data));
  data.times = {1.0, 0.0};
  EXPECT_THROW((void)motion_of(data), std::invalid_argument) << "backwards";
}

TEST(MotionOf, BoundsTheNumbersOfALongArmToo) {
  ReportData data;
  data.arm.sections.resize(500);
  data.times = clock_ticks(1000, 1.0);
  data.states.assign(1000, ArmState::straight(500));
  const ReportMotion motion = motion_of(data);
  EXPECT_LE(motion.count() * 3 * 500, max_shown_numbers);
  EXPECT_EQ(motion.recorded, 1000u);
  data.recorded = 77'000;
  EXPECT_EQ(motion_of(data).recorded, 77'000u) << "more than were given here";
}

TEST(MotionOf, TellsTheTipInTwoCoordinatesOnlyInXoyItself) {
  ReportData data;
  data.arm.sections.resize(1);
  data.times = {0.0};
  data.states = {ArmState::straight(1)};
  EXPECT_EQ(motion_of(data).tip_text(0), "E(0.000, 1.000)");
  data.arm.X_WB.position.z() = -0.5;
  EXPECT_EQ(motion_of(data).tip_text(0), "E(0.000, 1.000, -0.500)");
}

}  // namespace
}  // namespace flexura
