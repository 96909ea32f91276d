#include "flexura/calibrate/offset_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// How a loop went: the number of moves until its offset held, or nothing finer could be commanded, and what
// the offset was then. None when it got stuck, or was not there within `most`.
struct LoopEnd {
  int moves = 0;
  double offset = 0;
};
template <class Steps>
std::optional<LoopEnd> end_of(Steps steps, double offset, double behaviour, int most, double resolution = 0) {
  for (int move = 0; move <= most; ++move) {
    const LoopState state = steps.take(offset);
    if (state == LoopState::holds) return LoopEnd{move, offset};
    if (state == LoopState::stuck) return std::nullopt;
    double by = steps.move();
    if (resolution > 0) by = resolution * std::round(by / resolution);
    if (by == 0) return LoopEnd{move, offset};
    offset -= behaviour * by;
  }
  return std::nullopt;
}

TEST(EqualSteps, EndFromEverywhereWhereHalfAStepsChangeIsAccepted) {
  for_random_cases(2000, [](TestRandom& random) {
    const double step = random.uniform(0.1, 2), behaviour = random.uniform(0.5, 20);
    const double accepted = 0.5 * step * behaviour * random.uniform(1.0001, 2);
    const double offset = random.uniform(-100, 100) * step * behaviour;
    const auto end = end_of(EqualSteps(step, accepted), offset, behaviour, 200);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->moves,
              std::max(0.0, std::ceil((std::abs(offset) - accepted) / (step * behaviour) - 1e-9)));
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
    const auto end = end_of(ShrinkingSteps(1e-6, 100), offset, behaviour, 300);
    ASSERT_TRUE(end) << behaviour;
    EXPECT_LE(std::abs(end->offset), 1e-6);
    // Within half of the believed behaviour each step leaves half at most.
    if (behaviour > 0.5 && behaviour < 1.5) {
      EXPECT_LE(end->moves, 21);
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
  // The same steps held at their first size, each the first of a loop: |1 - k| < 1.
  for_random_cases(1000, [](TestRandom& random) {
    const double behaviour = random.uniform(0.02, 4);
    if (std::abs(behaviour - 2) < 0.01) return;
    double offset = 1;
    for (int i = 0; i < 4000 && std::abs(offset) > 1e-6 && std::abs(offset) < 1e6; ++i) {
      ShrinkingSteps first(1e-9, 1e9);
      ASSERT_EQ(first.take(offset), LoopState::moves);
      offset -= behaviour * first.move();
    }
    EXPECT_EQ(std::abs(offset) <= 1e-6, behaviour < 2) << behaviour;
  });
}

// Two offsets of one picture, e -> e - K m, nulled as `etalon` does: the first until it holds, then a step of
// the second, and the first again. Whether both come to hold; or what became of it.
std::string end_of_pair(const Eigen::Matrix2d& behaviour, Eigen::Vector2d offsets, double largest) {
  // What is accepted of the first is not nulled, and there the second follows K_22 alone.
  constexpr std::array<double, 2> held = {1e-9, 1e-6};
  std::array<ShrinkingSteps, 2> steps = {ShrinkingSteps(held[0], largest), ShrinkingSteps(held[1], largest)};
  constexpr int most = 3000;
  for (int move = 0; move < most; ++move) {
    const Eigen::Index i = std::abs(offsets[0]) > held[0] ? 0 : 1;
    ShrinkingSteps& chosen = steps[static_cast<std::size_t>(i)];
    const LoopState state = chosen.take(offsets[i]);
    if (state == LoopState::holds) return "holds";
    if (state == LoopState::stuck) return chosen.reason();
    if (i == 1)
      steps[0] = ShrinkingSteps(held[0], largest);  // What comes now is not what its last step left.
    offsets -= behaviour.col(i) * chosen.move();
  }
  return "goes on";
}

// The second one follows det K / K_11 once the first is nulled after each of its steps.
TEST(ShrinkingSteps, EndAsAPairWhereTheSecondOffsetFollowsWhenTheFirstIsHeld) {
  int ended = 0, ran = 0;
  for_random_cases(2000, [&](TestRandom& random) {
    Eigen::Matrix2d K;
    K << random.uniform(0.6, 1.4), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1.4, 1.4);
    const double follows = K.determinant() / K(0, 0);
    if (std::abs(follows) < 0.1 || follows > 1.4) return;
    const std::string end = end_of_pair(K, random.vector<2>(-1, 1), 100);
    if (follows > 0) {
      EXPECT_EQ(end, "holds") << K;
      ++ended;
    } else {
      EXPECT_THAT(end, HasSubstr("runs away")) << K;
      ++ran;
    }
  });
  EXPECT_GT(std::min(ended, ran), 600 / one_case_of);
}

TEST(ShrinkingSteps, EndWhereNothingFinerCanBeCommanded) {
  for_random_cases(1000, [](TestRandom& random) {
    const double behaviour = random.uniform(0.6, 1.4), resolution = random.uniform(0.01, 0.1);
    const auto end = end_of(ShrinkingSteps(1e-9, 100), random.uniform(-3, 3), behaviour, 200, resolution);
    ASSERT_TRUE(end);
    // Half a step; twice that where a last step jumped over, and was halved.
    EXPECT_LE(std::abs(end->offset), resolution);
  });
}

}  // namespace
}  // namespace flexura
