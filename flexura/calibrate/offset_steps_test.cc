#include "flexura/calibrate/offset_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// The number of moves until a loop's offset holds; none when it gets stuck, or does not within `most`.
template <class Steps>
std::optional<int> moves_until_it_holds(Steps steps, double offset, double behaviour, int most,
                                        double resolution = 0) {
  for (int move = 0; move <= most; ++move) {
    const LoopState state = steps.take(offset);
    if (state == LoopState::holds) return move;
    if (state == LoopState::stuck) return std::nullopt;
    double by = steps.move();
    if (resolution > 0) by = resolution * std::round(by / resolution);
    if (by == 0) return move;
    offset -= behaviour * by;
  }
  return std::nullopt;
}

TEST(EqualSteps, EndFromEverywhereWhereHalfAStepsChangeIsAccepted) {
  for_random_cases(2000, [](TestRandom& random) {
    const double step = random.uniform(0.1, 2), behaviour = random.uniform(0.5, 20);
    const double accepted = 0.5 * step * behaviour * random.uniform(1.0001, 2);
    const double offset = random.uniform(-100, 100) * step * behaviour;
    const auto moves = moves_until_it_holds(EqualSteps(step, accepted), offset, behaviour, 200);
    ASSERT_TRUE(moves);
    EXPECT_EQ(*moves, std::max(0.0, std::ceil((std::abs(offset) - accepted) / (step * behaviour) - 1e-9)));
  });
}

TEST(EqualSteps, NoticeThatTheyGoBackAndForthWhereLessIsAccepted) {
  // With a share a < 1 of half a step's change accepted, they end from the share a of all starts.
  for (const double share : {0.25, 0.5, 0.9}) {
    int ended = 0, tried = 0;
    for_random_cases(1000, [&](TestRandom& random) {
      const double step = random.uniform(0.1, 2), behaviour = random.uniform(0.5, 20);
      EqualSteps steps(step, 0.5 * share * step * behaviour);
      double offset = random.uniform(-30, 30) * step * behaviour;
      LoopState state = LoopState::moves;
      for (int i = 0; i < 200 && state == LoopState::moves; ++i) {
        state = steps.take(offset);
        offset -= behaviour * steps.move();
      }
      ASSERT_NE(state, LoopState::moves);
      if (state == LoopState::stuck) {
        EXPECT_THAT(steps.reason(), HasSubstr("goes back and forth"));
      }
      ++tried, ended += state == LoopState::holds ? 1 : 0;
    });
    EXPECT_NEAR(static_cast<double>(ended) / tried, share, one_case_of > 1 ? 0.15 : 0.05);
  }
}

TEST(EqualSteps, NoticeThatTheyRunAway) {
  EqualSteps steps(1, 0.5);
  double offset = 2;
  while (steps.take(offset) == LoopState::moves) offset += 0.7 * steps.move();
  EXPECT_THAT(steps.reason(), HasSubstr("runs away"));
  EXPECT_LT(offset, 10);
}

TEST(ShrinkingSteps, EndForEveryBehaviourThatHasTheBelievedSign) {
  for_random_cases(2000, [](TestRandom& random) {
    const double behaviour = std::exp(random.uniform(std::log(0.1), std::log(8.0)));
    const double offset = random.uniform(-1, 1);
    const auto moves = moves_until_it_holds(ShrinkingSteps(1e-6, 100), offset, behaviour, 300);
    ASSERT_TRUE(moves) << behaviour;
    // Within half of the believed behaviour each step leaves half at most.
    if (behaviour > 0.5 && behaviour < 1.5) {
      EXPECT_LE(*moves, 21);
    }
  });
}

TEST(ShrinkingSteps, RunAwayForTheOtherSignAndSayso) {
  for_random_cases(500, [](TestRandom& random) {
    const double behaviour = -random.uniform(0.05, 3);
    ShrinkingSteps steps(1e-6, 100);
    double offset = random.uniform(0.1, 1);
    LoopState state = LoopState::moves;
    for (int i = 0; i < 100 && state == LoopState::moves; ++i) {
      state = steps.take(offset);
      offset -= behaviour * steps.move();
    }
    ASSERT_EQ(state, LoopState::stuck);
    EXPECT_THAT(steps.reason(), HasSubstr("runs away"));
  });
}

TEST(ShrinkingSteps, WithoutHalvingTheBoundaryIsAtTwiceTheBelievedBehaviour) {
  // The same steps held at their first size: |1 - k| < 1.
  for_random_cases(1000, [](TestRandom& random) {
    const double behaviour = random.uniform(0.02, 4);
    double offset = 1;
    for (int i = 0; i < 4000 && std::abs(offset) > 1e-6 && std::abs(offset) < 1e6; ++i)
      offset -= behaviour * offset;
    if (std::abs(behaviour - 2) > 0.01) {
      EXPECT_EQ(std::abs(offset) <= 1e-6, behaviour < 2) << behaviour;
    }
  });
}

TEST(ShrinkingSteps, EndWhereNothingFinerCanBeCommanded) {
  for_random_cases(1000, [](TestRandom& random) {
    const double behaviour = random.uniform(0.6, 1.4), resolution = random.uniform(0.01, 0.1);
    EXPECT_TRUE(
        moves_until_it_holds(ShrinkingSteps(1e-9, 100), random.uniform(-3, 3), behaviour, 200, resolution));
  });
}

}  // namespace
}  // namespace flexura
