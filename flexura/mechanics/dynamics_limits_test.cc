#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

// Steps that are not possible: bad input, steps that do not converge, and excessive loads.
namespace flexura {
namespace {

TEST(Dynamics, RefusesWhatIsNoInput) {
  Rod rod = two_section_robot();
  const auto refusal = [](const Rod& refused, const RodDynamicsConfig& config) -> std::string {
    try {
      RodDynamics dynamics(refused, config);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(rod, {}), "section 1: a rod in motion must have a density or a mass per length");
  for (RodSection& section : rod.sections) section.density = 5000;
  EXPECT_EQ(refusal(rod, {.spectral_radius = 1.1}), "the spectral radius must be from 0 to 1");
  EXPECT_EQ(refusal(rod, {.rotary_inertia = false}),
            "section 1: without rotary inertia a rod must not twist");
  Rod bad = rod;
  bad.sections[1].damping_time = -1;
  EXPECT_EQ(refusal(bad, {}), "section 2: damping must be at least 0");
  bad = rod;
  bad.tendons[2].friction = 0.1;
  EXPECT_EQ(refusal(bad, {}), "");
  EXPECT_EQ(refusal(bad, {.friction_grip = 0}), "the grip of friction must be above 0");

  RodDynamics dynamics(rod);
  RodState state = dynamics.rest();
  const double nan = std::nan("");
  const auto problem = [&](const TendonInput& tendons, const RodLoads& loads, double h) {
    const RodStep step = dynamics.step(state, tendons, loads, h);
    EXPECT_EQ(step.end, DynamicsEnd::bad_input);
    return step.problem;
  };
  EXPECT_EQ(problem({.tensions = {1, 0, 0, 0, 0, nan}}, {}, 0.01), "tensions must be finite");
  EXPECT_EQ(problem({.displacements = {1}}, {}, 0.01), "1 displacements given: expected 6, one per tendon");
  EXPECT_EQ(problem({}, {.gravity = {0, nan, 0}}, 0.01), "gravity and loads must be finite");
  EXPECT_EQ(problem({}, {}, 0), "a step must be above 0 and finite");
  EXPECT_EQ(problem({}, {}, nan), "a step must be above 0 and finite");
  state.q[0] = nan;
  EXPECT_EQ(problem({}, {}, 0.01), "the state must be finite");
}

// Nearly inextensible tendons are pulled in at once, in one long step.
TEST(Dynamics, AStepThatDoesNotConvergeIsDivided) {
  int divided = 0, all = 0;
  for_random_cases(5, [&](TestRandom& random) {
    const Rod rod = random_rod(random);
    RodDynamics dynamics(rod), whole(rod, {.most_pieces = 1});
    RodState state = dynamics.rest();
    for (int i = 0; i < 3; ++i) {
      TendonInput input;
      for (std::size_t k = 0; k < rod.tendons.size(); ++k)
        input.displacements.push_back(random.uniform(-2e-3, 2e-3));
      RodState at_once = state;
      const RodStep one = whole.step(at_once, input, {}, 4e-3);
      const double before = state.time;
      const RodStep step = dynamics.step(state, input, {}, 4e-3);
      ++all;
      ASSERT_TRUE(step.converged());
      EXPECT_EQ(step.is_anew, !one.converged());
      EXPECT_NEAR(state.time, before + 4e-3, 1e-12);
      if (one.converged()) {
        EXPECT_EQ(step.pieces, 1);
        continue;
      }
      ++divided;
      EXPECT_EQ(one.end, DynamicsEnd::did_not_converge);
      EXPECT_EQ(at_once.q.size(), state.q.size());
    }
  });
  EXPECT_GT(divided, 0);
  EXPECT_LT(divided, all);
}

// Far too long steps and excessive loads give a valid result or an error, never a number that is not finite.
TEST(Dynamics, NeverGoesOnWithWhatIsNoNumber) {
  for_random_cases(20, [](TestRandom& random) {
    const Rod rod = random_rod(random);
    RodDynamics dynamics(rod,
                         {.spectral_radius = random.uniform(0, 1), .most_iterations = 10, .most_pieces = 4});
    RodState state = dynamics.rest();
    RodLoads loads = random_loads(random, rod);
    loads.gravity = std::pow(10.0, random.uniform(0, 8)) * random.vector<3>(-1, 1);
    TendonInput tendons{.tensions = random_tensions(random, rod, std::pow(10.0, random.uniform(0, 6)))};
    const double h = std::pow(10.0, random.uniform(-3, 5));
    for (int i = 0; i < 5; ++i) {
      const RodState before = state;
      const RodStep step = dynamics.step(state, tendons, loads, h);
      EXPECT_TRUE(state.q.allFinite() && state.momentum.allFinite());
      if (!step.converged()) {
        EXPECT_EQ(state.q, before.q);
      }
    }
  });
}

}  // namespace
}  // namespace flexura
