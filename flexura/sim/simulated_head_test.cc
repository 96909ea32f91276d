#include "flexura/sim/simulated_head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/sim/simulated_clock.h"
#include "tests/support/cameras.h"
#include "tests/support/motions.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// A head in which nothing is ideal.
CameraConfig real_camera(TestRandom& random) {
  CameraConfig camera = random_camera(random);
  HeadConfig& head = camera.head;
  head.delay = random.uniform(0, 0.3);
  head.pan.resolution = random.uniform(0.001, 0.02), head.tilt.resolution = random.uniform(0.001, 0.02);
  head.pan.backlash = random.uniform(0, 0.02), head.tilt.backlash = random.uniform(0, 0.02);
  head.zoom.resolution = random.uniform(0.05, 0.4);
  head.zoom.backlash = random.uniform(0, 0.1), head.zoom.max_acceleration = random.uniform(1, 20);
  camera.mount.stage.delay = random.uniform(0, 0.3);
  camera.mount.stage.x.backlash = 0.003, camera.mount.stage.y.resolution = 0.01;
  return camera;
}

HeadState anywhere(TestRandom& random) {
  return {random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-5, 12)};
}
Eigen::Vector3d vector(const HeadState& state) { return {state.pan, state.tilt, state.zoom}; }

TEST(SimulatedHead, ObeysItsLimitsAndRatesWithItsStageWhateverTheyAreTold) {
  for_random_cases(20, [](TestRandom& random) {
    const Camera camera(real_camera(random));
    SimulatedClock clock;
    SimulatedHead head(camera, camera.initial_head(), clock, forever);
    SimulatedStage stage(camera, camera.initial_stage(), clock, forever);
    Eigen::Vector3d target;
    for (int i = 0; i < 12; ++i) {
      target = random.vector<3>(-1.5, 1.5);
      ASSERT_TRUE(head.command(anywhere(random)));
      ASSERT_TRUE(stage.command({target}));
      clock.wait_until(clock.now() + random.uniform(0, 2));
    }
    EXPECT_FALSE(stage.command({{0, 0, std::nan("")}}));
    constexpr double step = 1e-3;
    // Of what is carried: its speed is the motor's or 0, so its acceleration has no bound.
    const auto expect_rates = [](const Eigen::Vector3d& last, const Eigen::Vector3d& now,
                                 const std::array<AxisConfig, 3>& axes) {
      for (int i = 0; i < 3; ++i) {
        const AxisConfig& axis = axes[static_cast<std::size_t>(i)];
        constexpr double slack = 1e-9;
        EXPECT_GE(now[i], axis.limits[0] - slack);
        EXPECT_LE(now[i], axis.limits[1] + slack);
        EXPECT_LE(std::abs(now[i] - last[i]), axis.max_rate * step * (1 + 1e-9) + 1e-12) << i;
      }
    };
    for (double t = step; t < clock.now() + 5; t += step) {
      expect_rates(vector(head.truth(t - step)), vector(head.truth(t)), camera.head_axes());
      expect_rates(stage.truth(t - step).offset, stage.truth(t).offset, camera.stage_axes());
    }
    EXPECT_NO_THROW((void)camera.view({head.truth(clock.now()), stage.truth(clock.now())}));
    clock.wait_until(clock.now() + 60);
    for (int i = 0; i < 3; ++i) {
      const AxisConfig& axis = camera.stage_axes()[static_cast<std::size_t>(i)];
      EXPECT_NEAR(stage.read().value().state.offset[i], commandable(axis, target[i]), 1e-12);
    }
  });
}

TEST(SimulatedHead, ReadsItsMotorsInStepsOfTheirResolution) {
  for_random_cases(40, [](TestRandom& random) {
    const Camera camera(real_camera(random));
    SimulatedClock clock;
    SimulatedHead head(camera, camera.initial_head(), clock, forever);
    for (int i = 0; i < 8; ++i) {
      ASSERT_TRUE(head.command(anywhere(random)));
      clock.wait_until(clock.now() + random.uniform(0, 2));
      const HeadReading reading = head.read().value();
      EXPECT_EQ(reading.time, clock.now());
      const Eigen::Vector3d read = vector(reading.state), truth = vector(head.truth(reading.time));
      for (int axis = 0; axis < 3; ++axis) {
        const AxisConfig& config = camera.head_axes()[static_cast<std::size_t>(axis)];
        EXPECT_GE(read[axis], config.limits[0]);
        EXPECT_LE(read[axis], config.limits[1]);
        // The last step within a limit may be farther off than the next one beyond.
        const bool is_at_limit = read[axis] - config.limits[0] < config.resolution ||
                                 config.limits[1] - read[axis] < config.resolution;
        EXPECT_LE(std::abs(read[axis] - truth[axis]),
                  0.5 * config.backlash + (is_at_limit ? 1 : 0.5) * config.resolution + 1e-9);
        if (config.resolution == 0) continue;
        const double steps = read[axis] / config.resolution;
        EXPECT_NEAR(steps, std::round(steps), 1e-9);
      }
      EXPECT_NO_THROW((void)camera.view({reading.state, camera.initial_stage()}));
    }
  });
}

// From below what is carried hangs half the play behind its motor, from above half of it before.
void expect_backlash(const Eigen::Vector3d& carried, const Eigen::Vector3d& motors,
                     const std::array<AxisConfig, 3>& axes, double side) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(carried[i], motors[i] + side * 0.5 * axes[static_cast<std::size_t>(i)].backlash, 1e-9) << i;
}

TEST(SimulatedHead, HangsHalfItsBacklashBehindWhereItCameFrom) {
  for_random_cases(20, [](TestRandom& random) {
    CameraConfig config = real_camera(random);
    config.mount.stage.z.backlash = 0.002;
    auto& [x, y, z, delay] = config.mount.stage;
    for (SlideConfig* slide : {&x, &y, &z}) slide->limits = {-0.2, 0.2};
    const Camera camera(config);
    SimulatedClock clock;
    SimulatedHead head(camera, camera.initial_head(), clock, forever);
    SimulatedStage stage(camera, camera.initial_stage(), clock, forever);
    const auto go = [&](double pan, double tilt, double share, double offset) {
      const auto& zoom = camera.head_axes()[2].limits;
      ASSERT_TRUE(head.command({pan, tilt, zoom[0] + share * (zoom[1] - zoom[0])}));
      ASSERT_TRUE(stage.command({Eigen::Vector3d::Constant(offset)}));
      clock.wait_until(clock.now() + 100);
    };
    const auto expect_side = [&](double side) {
      expect_backlash(vector(head.truth(clock.now())), vector(head.read().value().state), camera.head_axes(),
                      side);
      expect_backlash(stage.truth(clock.now()).offset, stage.read().value().state.offset, camera.stage_axes(),
                      side);
    };
    go(-0.5, -0.3, 0.2, -0.1);
    go(0.5, 0.6, 0.8, 0.1);
    expect_side(-1);
    go(0.1, 0.2, 0.5, 0.0);
    expect_side(1);
  });
}

TEST(SimulatedHead, CountsFromWhereItIsBelievedToStand) {
  CameraConfig config = cameras_at({5, 5})[0];
  const HeadState counted = Camera(config).initial_head();
  config.initial.pan = 0.03, config.initial.tilt = -0.02;
  config.initial.stage = {0.01, 0, 0};
  config.mount.stage.x.limits = config.mount.stage.z.limits = {-0.2, 0.2};
  const Camera camera(config);
  SimulatedClock clock;
  SimulatedHead head(camera, counted, clock, forever);
  SimulatedStage stage(camera, {}, clock, forever);
  EXPECT_EQ(head.read().value().state, counted);
  EXPECT_NEAR(head.truth(0).pan, 0.03, 1e-15);
  ASSERT_TRUE(head.command({counted.pan + 0.5, counted.tilt, counted.zoom}));
  ASSERT_TRUE(stage.command({{0, 0, 0.1}}));
  clock.wait_until(60);
  EXPECT_NEAR(head.truth(60).pan - head.read().value().state.pan, 0.03, 1e-12);
  EXPECT_NEAR(head.truth(60).tilt - head.read().value().state.tilt, -0.02, 1e-12);
  EXPECT_NEAR(stage.truth(60).offset.x() - stage.read().value().state.offset.x(), 0.01, 1e-12);
}

TEST(SimulatedHead, MovesAfterItsDelayAndArrivesAndSoDoesItsStage) {
  for_random_cases(40, [](TestRandom& random) {
    const Camera camera(real_camera(random));
    const double delay = camera.config().head.delay;
    SimulatedClock clock;
    SimulatedHead head(camera, camera.initial_head(), clock, forever);
    SimulatedStage stage(camera, camera.initial_stage(), clock, forever);
    clock.wait_until(1);
    const HeadState target = anywhere(random);
    ASSERT_TRUE(head.command(target));
    ASSERT_TRUE(stage.command({camera.initial_stage().offset + Eigen::Vector3d::Constant(1)}));
    EXPECT_EQ(head.truth(1 + delay), camera.initial_head());
    EXPECT_EQ(stage.truth(1 + camera.config().mount.stage.delay).offset, camera.initial_stage().offset);
    EXPECT_TRUE(head.read().value().moving);
    clock.wait_until(60 + delay);
    const HeadReading reading = head.read().value();
    EXPECT_FALSE(reading.moving);
    const auto& axes = camera.head_axes();
    EXPECT_NEAR(reading.state.pan, commandable(axes[0], target.pan), 1e-12);
    EXPECT_NEAR(reading.state.tilt, commandable(axes[1], target.tilt), 1e-12);
    EXPECT_NEAR(reading.state.zoom, commandable(axes[2], target.zoom), 1e-9);
  });
}

TEST(SimulatedHead, MovesAsLongAsAnyOfItsAxesDoes) {
  const Camera camera(cameras_at({5, 5})[0]);
  const HeadState rest = camera.initial_head();
  for (const HeadState& target : {HeadState{rest.pan + 0.3, rest.tilt, rest.zoom},
                                  {rest.pan, rest.tilt + 0.3, rest.zoom},
                                  {rest.pan, rest.tilt, rest.zoom + 0.5}}) {
    SimulatedClock clock;
    SimulatedHead head(camera, rest, clock, forever);
    ASSERT_TRUE(head.command(target));
    clock.wait_until(0.01);
    EXPECT_TRUE(head.read().value().moving);
    clock.wait_until(60);
    EXPECT_FALSE(head.read().value().moving);
  }
}

TEST(SimulatedHead, HaltsOnItsWay) {
  CameraConfig config = cameras_at({5, 5})[0];
  const Camera camera(config);
  SimulatedClock clock;
  SimulatedHead head(camera, camera.initial_head(), clock, forever);
  ASSERT_TRUE(head.command({2, 0, 1}));
  clock.wait_until(1);
  ASSERT_TRUE(head.halt());
  const AxisConfig& pan = camera.head_axes()[0];
  clock.wait_until(1 + pan.max_rate / pan.max_acceleration + 1e-9);
  EXPECT_FALSE(head.read().value().moving);
  // 50 deg/s for a second, less half of the time to speed up, and half of that to stop.
  EXPECT_NEAR(head.truth(clock.now()).pan, pan.max_rate * 1.0, 1e-9);
}

TEST(SimulatedHead, RefusesNumbersThatAreNoneAndMovesNothing) {
  const Camera camera(cameras_at({5, 5})[0]);
  SimulatedClock clock;
  SimulatedHead head(camera, camera.initial_head(), clock, forever);
  const CommandOutcome outcome = head.command({0.5, std::nan(""), 1});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.fault()->kind, FaultKind::refused);
  EXPECT_THAT(text(*outcome.fault()), HasSubstr("refused: the head of camera front"));
  EXPECT_THROW((void)outcome.value(), std::runtime_error);
  clock.wait_until(5);
  EXPECT_EQ(head.read().value().state, camera.initial_head());
}

TEST(SimulatedHead, DoesNotAnswerWhileItsLinkIsLostAndGoesOn) {
  const Camera camera(cameras_at({5, 5})[0]);
  SimulatedClock clock;
  SimulatedHead head(camera, camera.initial_head(), clock, forever);
  head.link().lose(1, 2);
  ASSERT_TRUE(head.command({1, 0, 1}));
  clock.wait_until(1.5);
  EXPECT_EQ(head.read().fault()->kind, FaultKind::link_lost);
  EXPECT_FALSE(head.command({0, 0, 1}));
  EXPECT_FALSE(head.halt());
  clock.wait_until(10);
  EXPECT_EQ(head.read().value().state.pan, 1);
}

}  // namespace
}  // namespace flexura
