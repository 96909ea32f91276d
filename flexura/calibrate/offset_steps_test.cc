#include "flexura/calibrate/offset_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Result for an offset that each move changes by `behaviour` times the move.
struct LoopEnd {
  LoopState state = LoopState::moves;
  int moves = 0;
  double offset = 0;
  std::string reason;
};
LoopEnd end_of(OffsetSteps steps, double offset, double behaviour, double resolution = 0) {
  constexpr int most = 300;
  for (int moves = 0; moves <= most; ++moves) {
    const LoopState state = steps.take(offset);
    if (state != LoopState::moves) return {state, moves, offset, steps.reason()};
    double by = steps.move();
    if (resolution > 0) by = resolution * std::round(by / resolution);
    if (by == 0) return {LoopState::holds, moves, offset, ""};
    offset -= behaviour * by;
  }
  return {};
}

// Ends from everywhere if half of a step's change is accepted; with the share a < 1 of that, from the share a
// of all starts.
TEST(StepsAllAlike, EndOrNoticeThatTheyGoBackAndForth) {
  for (const double share : {0.25, 0.5, 0.9, 1.0001, 1.7}) {
    int ended = 0, tried = 0;
    for_random_cases(1000, [&](TestRandom& random) {
      const double behaviour = random.uniform(0.5, 20), accepted = 0.5 * share * behaviour;
      const double offset = random.uniform(-100, 100) * behaviour;
      const LoopEnd end = end_of(OffsetSteps(accepted), offset, behaviour);
      ASSERT_NE(end.state, LoopState::moves);
      const double needed = std::max(0.0, std::ceil((std::abs(offset) - accepted) / behaviour - 1e-9));
      if (end.state == LoopState::holds) {
        EXPECT_EQ(end.moves, needed);
      } else {
        EXPECT_THAT(end.reason, HasSubstr("oscillates"));
      }
      ++tried, ended += end.state == LoopState::holds ? 1 : 0;
    });
    EXPECT_NEAR(static_cast<double>(ended) / tried, std::min(share, 1.0),
                share > 1 ? 0 : (one_case_of > 1 ? 0.15 : 0.05));
  }
}

TEST(StepsThatShrink, EndForEveryBehaviourThatHasTheBelievedSign) {
  for_random_cases(2000, [](TestRandom& random) {
    const double behaviour = std::exp(random.uniform(std::log(0.1), std::log(8.0)));
    const LoopEnd end = end_of(OffsetSteps(1e-6, 100), random.uniform(-1, 1), behaviour);
    ASSERT_EQ(end.state, LoopState::holds) << behaviour;
    EXPECT_LE(std::abs(end.offset), 1e-6);
    // With a behaviour within half of the modelled one, each step leaves at most half.
    if (behaviour > 0.5 && behaviour < 1.5) {
      EXPECT_LE(end.moves, 21);
    }
    const double near = random.uniform(0.6, 1.4), resolution = random.uniform(0.01, 0.1);
    const LoopEnd drawn = end_of(OffsetSteps(1e-9, 100), random.uniform(-3, 3), near, resolution);
    ASSERT_EQ(drawn.state, LoopState::holds);
    // Half a step of a head; twice that if the last step overshot and was halved.
    EXPECT_LE(std::abs(drawn.offset), resolution);
  });
}

TEST(OffsetSteps, NoticeThatTheyRunAway) {
  for_random_cases(500, [](TestRandom& random) {
    const double behaviour = -random.uniform(0.05, 3), offset = random.uniform(0.6, 1);
    for (const OffsetSteps& steps : {OffsetSteps(1e-6, 100), OffsetSteps(0.5)}) {
      const LoopEnd end = end_of(steps, offset, behaviour);
      EXPECT_EQ(end.state, LoopState::stuck);
      EXPECT_THAT(end.reason, HasSubstr("diverges"));
    }
  });
}

// Two offsets of one picture, e -> e - K m, nulled as in `etalon`. The first is nulled until it holds; then
// one step of the second, and so on. Returns how the pair ended.
std::string end_of_pair(const Eigen::Matrix2d& behaviour, Eigen::Vector2d offsets) {
  // The residual of the first offset is not nulled; there the second follows K_22 alone.
  constexpr std::array<double, 2> held = {1e-9, 1e-6};
  std::array<OffsetSteps, 2> steps = {OffsetSteps(held[0], 100), OffsetSteps(held[1], 100)};
  constexpr int most = 3000;
  for (int move = 0; move < most; ++move) {
    const Eigen::Index i = std::abs(offsets[0]) > held[0] ? 0 : 1;
    OffsetSteps& chosen = steps[static_cast<std::size_t>(i)];
    const LoopState state = chosen.take(offsets[i]);
    if (state == LoopState::holds) return "holds";
    if (state == LoopState::stuck) return chosen.reason();
    // The next offset is not the result of its own last step.
    if (i == 1) steps[0] = OffsetSteps(held[0], 100);
    offsets -= behaviour.col(i) * chosen.move();
  }
  return "goes on";
}

// With the first offset nulled after each of its steps, the second follows det K / K_11.
TEST(StepsThatShrink, EndAsAPairWhereTheSecondOffsetFollowsWhenTheFirstIsHeld) {
  int ended = 0, ran = 0;
  for_random_cases(2000, [&](TestRandom& random) {
    Eigen::Matrix2d K;
    K << random.uniform(0.6, 1.4), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1.4, 1.4);
    const double follows = K.determinant() / K(0, 0);
    if (std::abs(follows) < 0.1 || follows > 1.4) return;
    EXPECT_THAT(end_of_pair(K, random.vector<2>(-1, 1)), HasSubstr(follows > 0 ? "holds" : "diverges")) << K;
    ++(follows > 0 ? ended : ran);
  });
  EXPECT_GT(std::min(ended, ran), 600 / one_case_of);
}

}  // namespace
}  // namespace flexura
