#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

const RodLoads pull_of_earth{.gravity = {-9.81, 0, 0}};

TEST(RodDrag, ASwingDecaysAndDragTakesItsEnergy) {
  Rod rod = soft_arm();
  rod.sections[0].damping_time = 0;
  RodDynamics dynamics(rod, {.spectral_radius = 1});
  const RodDrag drag(dynamics.chain(), {.density = 1000, .linear_across = 0.1});
  dynamics.set_surroundings(&drag);
  RodState state = dynamics.rest();
  const double h = 1e-3;
  double work = 0, power = 0, swing[2] = {0, 0};
  const double start = dynamics.energy(state, pull_of_earth).total();
  for (int i = 0; i < 1500; ++i) {
    ASSERT_TRUE(dynamics.step(state, {}, pull_of_earth, h).converged());
    const double now = drag.power(dynamics.motions(state), dynamics.node_runs());
    EXPECT_LE(now, 0);
    work += 0.5 * h * (now + power);
    power = now;
    double& most = swing[i < 750 ? 0 : 1];
    most = std::max(most, std::abs(now));
  }
  EXPECT_LT(swing[1], 0.1 * swing[0]);
  EXPECT_NEAR(dynamics.energy(state, pull_of_earth).total() - start, work, 0.02 * std::abs(work));
}

TEST(RodPayload, APayloadThatFallsOffLetsTheTipJumpUp) {
  RodDynamics dynamics(soft_arm(2e7));
  const RodPayload load{.place = {.section = 0, .at = 1}, .mass = 0.03, .offset = {0, 0, 0.01}};
  RodState state = dynamics.rest();
  const double height = dynamics.tip(state).position.x();
  state = dynamics.pick_up(state, load, {}, pull_of_earth);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(dynamics.step(state, {}, pull_of_earth, 2e-3).converged());
  const double low = dynamics.tip(state).position.x(), energy = dynamics.energy(state, pull_of_earth).total();
  EXPECT_LT(low, height - 0.01);
  const Pose tip = dynamics.tip(state);
  state = dynamics.drop(state, load.place, {}, pull_of_earth);
  // The dropped mass was at rest: the energy decreases by its potential energy only.
  EXPECT_NEAR(dynamics.energy(state, pull_of_earth).total() - energy,
              0.03 * pull_of_earth.gravity.dot(tip * load.offset), 2e-6);
  const double dropped = dynamics.energy(state, pull_of_earth).total();
  double highest = low;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(dynamics.step(state, {}, pull_of_earth, 2e-3).converged());
    highest = std::max(highest, dynamics.tip(state).position.x());
    EXPECT_LE(dynamics.energy(state, pull_of_earth).total(), dropped + 1e-7);
  }
  EXPECT_GT(highest, low + 0.01);
  EXPECT_THROW((void)dynamics.pick_up(state, {.mass = -1}, {}, pull_of_earth), std::invalid_argument);
  EXPECT_THROW(
      (void)dynamics.pick_up(state, {.place = {.section = 0, .at = 0.123}, .mass = 1}, {}, pull_of_earth),
      std::invalid_argument);
}

TEST(RodPayload, PicksUpWithTheMomentumOfBoth) {
  for_random_cases(20, [](TestRandom& random) {
    RodDynamics dynamics(soft_arm());
    Eigen::VectorXd q(dynamics.chain().size()), v = q;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      q[j] = random.uniform(-0.3, 0.3);
      v[j] = random.uniform(-1, 1);
    }
    const RodState before = dynamics.start(q, v, {}, {});
    const NodeMotion tip = dynamics.motion(before, {.section = 0, .at = 1});
    RodPayload load{.mass = random.uniform(0.001, 0.1), .offset = random.vector<3>(-0.01, 0.01)};
    const Eigen::Vector3d at = tip.pose * load.offset;
    const double energy = dynamics.energy(before, {}).total();
    // It moves with the place: no energy is lost.
    load.velocity = tip.twist.head<3>() + tip.twist.tail<3>().cross(at);
    const RodState with = dynamics.pick_up(before, load, {}, {});
    EXPECT_LT((dynamics.velocity(with) - v).norm(), 1e-7 * v.norm());
    EXPECT_NEAR(dynamics.energy(with, {}).total(), energy + 0.5 * load.mass * load.velocity.squaredNorm(),
                1e-9);
    const RodState back = dynamics.drop(with, load.place, {}, {});
    EXPECT_LT((back.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm());
    // It is at rest: energy is lost.
    load.velocity.setZero();
    const RodState jolted = dynamics.pick_up(back, load, {}, {});
    EXPECT_LT((jolted.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm());
    EXPECT_LT(dynamics.energy(jolted, {}).total(), energy);
  });
}

TEST(TendonBreak, ABrokenTendonDoesNotPullAndTheRodStraightens) {
  const std::vector<TendonBreak> breaks = {{.tendon = 0, .time = 0.5}};
  for (const bool by_displacement : {false, true}) {
    Rod rod = soft_arm_with_tendon(5e6);
    rod.sections[0].damping_time = 0.1;
    rod.tendons[0].compliance = 1e-4;
    RodDynamics dynamics(rod);
    TendonInput pulled;
    (by_displacement ? pulled.displacements : pulled.tensions) = {by_displacement ? 0.01 : 10.0};
    RodState state = dynamics.rest();
    double bent = 0;
    while (state.time < 1.5) {
      const TendonInput input = after_breaks(pulled, breaks, state.time);
      ASSERT_TRUE(dynamics.step(state, input, {}, 2e-3).converged());
      if (state.time < 0.5) bent = std::max(bent, dynamics.tip(state).position.x());
      EXPECT_TRUE(state.time < 0.51 || state.tensions[0] == 0);
    }
    EXPECT_GT(bent, 0.05);
    EXPECT_LT(dynamics.tip(state).position.head<2>().norm(), 1e-3);
  }
  EXPECT_THROW((void)after_breaks({.tensions = {1}}, std::vector<TendonBreak>{{.tendon = 1}}, 1),
               std::invalid_argument);
  EXPECT_TRUE(after_breaks({}, breaks, 1).tensions.empty());
}

}  // namespace
}  // namespace flexura
