// Sessions in which a client pushes the arm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/live_sessions.h"
#include "tests/support/rod_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class PushView : public LiveSessionTest {
 protected:
  explicit PushView(const std::string& text) : LiveSessionTest(text) {}

  static Eigen::Vector3d tip(const StateMessage& state) { return state.samples.back().X_WS.position; }
  static PushRequest by_force(double s, double x, double y, double z) {
    PushRequest push;
    push.s = s;
    push.force = {x, y, z};
    return push;
  }
  static PushRequest towards(double s, const Eigen::Vector3d& to) {
    PushRequest push;
    push.s = s;
    push.to = {to.x(), to.y(), to.z()};
    return push;
  }
  // Waits until nothing moves any more; returns the largest distance of the tip from `from`.
  double settle(const Eigen::Vector3d& from, double most = 30) {
    double farthest = 0;
    for (double passed = 0; passed < most; passed += 0.1) {
      const StateMessage state = pass(0.1);
      farthest = std::max(farthest, (tip(state) - from).norm());
      if (!state.is_moving) return farthest;
    }
    ADD_FAILURE() << "it does not come to rest";
    return farthest;
  }
};

class StaticPushView : public PushView {
 protected:
  StaticPushView() : PushView(viewed_rod()) {}
};

TEST_F(StaticPushView, GoesToTheEquilibriumAndReturnsWhenItIsReleased) {
  const Eigen::Vector3d rest = tip(pass(0.1));
  const PushScale scale = rig_->push.value();
  EXPECT_NEAR(scale.length, 1, 1e-9);
  EXPECT_EQ(ask(towards(0.8, rest + Eigen::Vector3d(0.2, -0.2, 0.1))).error, "");
  const StateMessage pushed = pass(0.1);
  ASSERT_TRUE(pushed.push);
  EXPECT_NEAR(pushed.push->s, 0.8, 1e-6);
  EXPECT_LT((pushed.push->to - rest - Eigen::Vector3d(0.2, -0.2, 0.1)).norm(), 1e-6);
  EXPECT_GT(pushed.push->force.norm(), 0.1);
  EXPECT_GT((tip(pushed) - rest).norm(), 0.01);
  EXPECT_TRUE(pushed.is_moving) << "a hand is there";
  EXPECT_FALSE(pushed.energy) << "it has no inertia";
  EXPECT_EQ(ask(ReleaseRequest{}).error, "");
  const StateMessage free = pass(0.1);
  EXPECT_FALSE(free.push);
  EXPECT_FALSE(free.is_moving);
  EXPECT_LT((tip(free) - rest).norm(), 1e-5);
}

TEST_F(StaticPushView, RefusesWhatIsNoPushOfThisArm) {
  const PushScale scale = rig_->push.value();
  EXPECT_THAT(ask(by_force(1.2, 0.1, 0, 0)).error, HasSubstr("s = 1.2: expected 0 to 1 m"));
  EXPECT_THAT(ask(by_force(0.5, 2 * scale.most, 0, 0)).error, HasSubstr(" N: expected at most "));
  PushRequest hard = towards(0.5, {1, 1, 1});
  hard.stiffness = 1000 * scale.stiffness;
  EXPECT_THAT(ask(hard).error, HasSubstr("stiffness = "));
  EXPECT_FALSE(pass(0.1).push);
  EXPECT_EQ(ask(by_force(static_cast<float>(1.0000001), 0.1, 0, 0)).error, "") << "the tip, rounded";
  EXPECT_EQ(ask(ReleaseRequest{}).error, "");
  EXPECT_EQ(ask(ReleaseRequest{}).error, "") << "nothing pushes, and nothing does then";
}

TEST_F(StaticPushView, IsReleasedByAResetByHaltAndWhenTheHandIsGone) {
  const auto push = [&](ClientId client) {
    EXPECT_EQ(ask(by_force(0.9, 0.1, 0, 0), client).error, "");
    EXPECT_TRUE(pass(0.05).push);
  };
  push(me);
  EXPECT_EQ(ask(ResetRequest{}).error, "");
  EXPECT_FALSE(pass(0.05).push);
  push(me);
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  EXPECT_FALSE(pass(0.05).push);
  session_.opened(other);
  push(other);
  session_.closed(other);
  EXPECT_FALSE(pass(0.05).push);
  push(me);
  session_.opened(other);
  session_.closed(other);
  EXPECT_TRUE(pass(0.05).push) << "another's hand";
}

// The distance of the hand does not matter.
TEST_F(StaticPushView, StaysAnArmUnderTheStrongestPush) {
  for (const Eigen::Vector3d& to : {Eigen::Vector3d(100, 0, 0), Eigen::Vector3d(0, -100, 0),
                                    Eigen::Vector3d(0, 0, -3), Eigen::Vector3d(0, 100, 0)}) {
    (void)ask(towards(1, to));  // May be refused if the arm has no equilibrium.
    const StateMessage state = pass(0.1);
    EXPECT_TRUE(tip(state).allFinite());
    EXPECT_LT(tip(state).norm(), 1.1);
    if (state.push) {
      EXPECT_LE(state.push->force.norm(), 1.001 * rig_->push->most);
    }
  }
}

TEST(PushOfArcs, IsRefused) {
  const ViewedRigPtr rig = viewed_rig();
  EXPECT_FALSE(rig->push);
  FakeMessenger messenger;
  FakeBackground background;
  LiveSession session(rig, messenger, background, {.start = 0, .results = {}});
  session.opened(me);
  PushRequest push;
  push.force = {0, 0, 1};
  EXPECT_THROW(session.take(me, push, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_NO_THROW(session.take(me, ReleaseRequest{}, [](const ViewAnswer&) {}));
}

// A soft rod that hangs from the ceiling, with a post beside it.
const std::string soft_text = R"(
title = "A soft rod"
[arm]
kind = "spatial"
model = "dynamic"
gravity = [0, -9.81, 0]
time_step = 0.005
base = { position = [0, 0.5, 0], rotation = [0, 0, 0.7071067811865476, -0.7071067811865476] }
[[arm.section]]
length = 0.4
radius = [0.02, 0.015]
max_bend = 2
material = { youngs_modulus = 4e5, poisson = 0.49, density = 1070, damping_time = 0.03 }
[[arm.tendon]]
section = 1
radius_mm = 10
angle_deg = 0
[arm.contact]
friction = 0.4
spacing_mm = 30
[[obstacle]]
kind = "capsule"
name = "post"
from = [0.1, 0.15, -0.3]
to = [0.1, 0.15, 0.3]
radius = 0.03
may_touch = true
)";

class DynamicPushView : public PushView {
 protected:
  DynamicPushView() : PushView(soft_text) {}
};

TEST_F(DynamicPushView, SwingsWhilePushedAndAfterwardsUntilItIsDamped) {
  const StateMessage still = pass(0.2);
  const Eigen::Vector3d rest = tip(still);
  EXPECT_FALSE(still.is_moving);
  EXPECT_LT(still.energy.value().kinetic, 1e-9);
  EXPECT_EQ(ask(towards(0.4, rest + Eigen::Vector3d(0, 0, 0.15))).error, "");
  EXPECT_GT(pass(0.05).push.value().force.z(), 0);
  const StateMessage pushed = pass(0.1);
  EXPECT_TRUE(pushed.is_moving);
  EXPECT_GT(pushed.energy.value().kinetic, 1e-6);
  EXPECT_GT(tip(pushed).z(), rest.z() + 0.01);
  (void)pass(1);
  EXPECT_EQ(ask(ReleaseRequest{}).error, "");
  // The rod swings to the other side, too.
  double least = 0;
  for (int i = 0; i < 60; ++i) least = std::min(least, tip(pass(1.0 / 60)).z() - rest.z());
  EXPECT_LT(least, -5e-3);
  settle(rest);
  EXPECT_LT((tip(pass(0.1)) - rest).norm(), 2e-3);
}

TEST_F(DynamicPushView, TellsWhatItTouches) {
  const Eigen::Vector3d rest = tip(pass(0.2));
  EXPECT_EQ(ask(towards(0.4, rest + Eigen::Vector3d(0.4, 0, 0))).error, "");
  const StateMessage pushed = pass(3);
  ASSERT_FALSE(pushed.contacts.empty());
  for (const ContactSample& contact : pushed.contacts) {
    EXPECT_EQ(contact.obstacle, 0) << "the post";
    EXPECT_LT(contact.force.x(), 0) << "pushes back";
    EXPECT_GT(contact.normal_force, 0);
    EXPECT_NE(contact.slip, ContactSample::Slip::unknown);
    EXPECT_NEAR(contact.point.x(), 0.07, 0.025);
  }
  EXPECT_FALSE(pushed.is_unsafe) << "it may touch the post";
  EXPECT_EQ(ask(ReleaseRequest{}).error, "");
  settle(rest);
  EXPECT_TRUE(messenger_.state(me).contacts.empty());
}

TEST_F(DynamicPushView, SaysThatItIsSlowWhereTheTimeRunsAwayFromIt) {
  EXPECT_FALSE(pass(0.1).pace);
  session_.advance(clock_ += 100);
  EXPECT_FALSE(messenger_.state(me).pace) << "a pause";
  for (int i = 0; i < 20; ++i) session_.advance(clock_ += 0.2);
  const StateMessage slow = messenger_.state(me);
  ASSERT_TRUE(slow.pace);
  EXPECT_NEAR(*slow.pace, 0.25, 0.02);
  EXPECT_THAT(last_event(), HasSubstr("slower than real time"));
  EXPECT_FALSE(pass(0.1).pace);
}

// The same requests at the same times give the same states.
TEST(PushTwice, IsTheSame) {
  const auto states = [] {
    FakeMessenger messenger;
    FakeBackground background;
    LiveSession session(viewed_rig(soft_text), messenger, background, {.start = 0, .results = {}});
    session.opened(me);
    for (int i = 1; i <= 60; ++i) {
      PushRequest push;
      push.s = 0.3;
      push.to = {0.01 * i, 0.1, 0.05};
      if (i < 40) session.take(me, push, [](const ViewAnswer&) {});
      if (i == 40) session.take(me, ReleaseRequest{}, [](const ViewAnswer&) {});
      session.advance(i / 60.0);
    }
    return *messenger.posts[{me, 0}].back();
  };
  EXPECT_EQ(states(), states());
}

}  // namespace
}  // namespace flexura
