// Sessions with tendons that are pulled individually, and with weight that can be switched off.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexura/store/text_file.h"
#include "flexura/view/describe.h"
#include "flexura/view/live_rig.h"
#include "flexura/view/run_link.h"
#include "tests/support/checkout.h"
#include "tests/support/live_sessions.h"
#include "tests/support/rod_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

ArmRequest tendons(const std::vector<double>& displacements) {
  ArmRequest request;
  request.tendons = displacements;
  return request;
}

Eigen::Vector3d tip(const StateMessage& state) { return state.samples.back().X_WS.position; }

class PulledRod : public LiveSessionTest {
 protected:
  explicit PulledRod(const std::string& text = viewed_rod()) : LiveSessionTest(text) {}

  [[nodiscard]] static std::vector<double> values(const StateMessage& state) {
    std::vector<double> list;
    for (const ActuatorSample& each : state.actuators) list.push_back(each.value);
    return list;
  }
  static void expect_near(const std::vector<double>& a, const std::vector<double>& b, double most) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], most) << i;
  }
};

TEST_F(PulledRod, SaysWhatCanBePulledAndSwitched) {
  const Node controls = session_.hello().controls;
  EXPECT_TRUE(controls.find("tendons")->empty());
  EXPECT_TRUE(*controls.find("weight")->as<bool>());
  const Node::Array& list = *controls.find("actuators")->as<Node::Array>();
  ASSERT_EQ(list.size(), 6U);
  EXPECT_EQ(*list[4].find("name")->as<std::string>(), "Tendon 5");
  EXPECT_EQ(*list[4].find("section")->as<std::int64_t>(), 1);
  EXPECT_FALSE(*list[4].find("motor")->as<bool>());
  EXPECT_EQ(list[4].find("together")->as<Node::Array>()->size(), 6U);
  // Both sections bend by at most 2 rad.
  EXPECT_NEAR(*(*list[4].find("range")->as<Node::Array>())[1].as<double>(), 0.015 * 4, 1e-9);
}

TEST_F(PulledRod, GoesWhereItsTendonsArePulled) {
  const StateMessage before = pass(0.1);
  const std::vector<double> desired = {0.006, -0.003, -0.003, 0.0046, -0.0010, -0.0036};
  EXPECT_EQ(ask(tendons(desired)).error, "");
  const StateMessage state = pass(3);
  expect_near(values(state), desired, 1e-7);
  EXPECT_GT((tip(state) - tip(before)).norm(), 0.05);
  EXPECT_GT(state.actuators[0].force, 1);
  // Bends commanded afterwards take over again.
  EXPECT_EQ(ask(bends({{-0.6, 0}, {-0.6, 0}}, 1)).error, "");
  const StateMessage bent = pass(3);
  EXPECT_LT((tip(bent) - LiveRig(rig_, 0).at_rest({{{-0.6, 0}, {-0.6, 0}}, {1, 1}}).tip().position).norm(),
            1e-5);
  EXPECT_NEAR(bent.actuators[0].value, -0.6 * 0.015, 1e-6);
}

// The bends stay equal, and the tensions change.
TEST_F(PulledRod, PullsTendonsAgainstEachOther) {
  const StateMessage before = pass(0.1);
  EXPECT_EQ(ask(tendons({1e-5, 1e-5, 1e-5, 0, 0, 0})).error, "");
  const StateMessage state = pass(1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(state.actuators[i].force, before.actuators[i].force + 10);
  EXPECT_LT(state.arm.bends[0].norm(), 1e-6);
}

TEST_F(PulledRod, LetsATendonHangSlack) {
  EXPECT_EQ(ask(tendons({0, -0.02, 0, 0, 0, 0})).error, "");
  const StateMessage state = pass(2);
  EXPECT_EQ(state.actuators[1].force, 0);
  EXPECT_NEAR(state.actuators[1].value, -0.02, 1e-7);
}

TEST_F(PulledRod, RefusesWhatIsNoPull) {
  EXPECT_EQ(ask(tendons({0, 0})).error, "tendons: expected 6 displacements");
  EXPECT_EQ(ask(tendons({0, 0.2, 0, 0, 0, 0})).error, "tendons[1] = 0.2: expected -0.03 to 0.03 m");
  EXPECT_THAT(ask(tendons({0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0, 0})).error,
              HasSubstr("tendons[2] = nan: expected "));
  EXPECT_THAT(ask(tendons({0.03, -0.03, 0, 0.03, -0.03, 0})).error, HasSubstr("unsafe: section 1: "));
  expect_near(values(pass(1)), std::vector<double>(6, 0.0), 1e-9);
}

TEST_F(PulledRod, IsWithoutWeightUntilItIsReset) {
  EXPECT_EQ(ask(bends({{-0.6, 0}, {-0.6, 0}}, 1)).error, "");
  const StateMessage heavy = pass(3);
  EXPECT_FALSE(heavy.is_weightless);
  EXPECT_EQ(ask(WeightRequest{false}).error, "");
  const StateMessage light = pass(1.0 / 60);
  EXPECT_TRUE(light.is_weightless);
  EXPECT_GT((tip(light) - tip(heavy)).norm(), 3e-3) << "at once";
  const Backbone weighs_nothing = LiveRig(viewed_rig(viewed_rod(1e-9)), 0).at_rest(light.arm);
  EXPECT_LT((tip(light) - weighs_nothing.tip().position).norm(), 1e-5);
  BackboneRequest there;
  there.bends = {{{-0.5, 0}, {-0.5, 0}}};
  const auto tip_there = [&] {
    const Node::Array poses = *ask(there).result.find("poses")->as<Node::Array>();
    return *(*poses.back().as<Node::Array>())[1].as<double>();
  };
  const double light_there = tip_there();
  EXPECT_EQ(ask(ResetRequest{}).error, "");
  EXPECT_FALSE(pass(0.1).is_weightless);
  EXPECT_GT(light_there, tip_there() + 1e-3) << "ghosts sag as the arm does";
}

TEST_F(PulledRod, GoesTheSameWayForTheSameCommands) {
  const auto go = [&](LiveSession& session, FakeMessenger& messenger) {
    const auto nothing = [](const ViewAnswer&) {};
    double clock = 0;
    const auto advance = [&](int steps) {
      for (int i = 0; i < steps; ++i) session.advance(clock += 1.0 / 60);
    };
    session.opened(me);
    session.take(me, tendons({0.004, -0.002, -0.002, 0.003, -0.001, -0.002}), nothing);
    advance(7);
    session.take(me, WeightRequest{false}, nothing);
    advance(9);
    session.take(me, bends({{0.3, 0.1}, {0, 0}}, 0.2), nothing);
    advance(9);
    return *messenger.posts[{me, 0}].back();
  };
  std::vector<std::string> states;
  for (int i = 0; i < 2; ++i) {
    FakeMessenger messenger;
    FakeBackground background;
    LiveSession session(viewed_rig(viewed_rod()), messenger, background, {.start = 0, .results = {}});
    states.push_back(go(session, messenger));
  }
  EXPECT_EQ(states[0], states[1]);
}

class LightArm : public LiveSessionTest {};

TEST_F(LightArm, HasNothingToPullOrToSwitchOff) {
  EXPECT_EQ(session_.hello().controls.find("actuators"), nullptr);
  EXPECT_FALSE(*session_.hello().controls.find("weight")->as<bool>());
  EXPECT_THAT(ask(WeightRequest{false}).error, HasSubstr("this arm has neither weight nor loads"));
  EXPECT_EQ(ask(tendons({0, 0})).error, "tendons: the arm has no drive");
  EXPECT_TRUE(pass(0.1).actuators.empty());
}

// A column that would buckle under its weight; one tendon keeps it from falling to one side.
class TallColumn : public PulledRod {
 protected:
  TallColumn()
      : PulledRod(R"(
[arm]
kind = "planar"
model = "static"
gravity = [0, -10, 0]
initial.bends = [[0.5, 0]]
[[arm.section]]
length = 1
radius = 0.06
max_bend_rate = 12
material = { stiffness = { shear = [1e6, 1e6], stretch = 1e6, bend = [1, 1], twist = 1 }, mass_per_length = 1 }
[[arm.tendon]]
section = 1
radius_mm = 50
angle_deg = 180
[[task]]
kind = "hold"
duration = 1
)") {}
};

TEST_F(TallColumn, SaysThatItSnapsWhenItIsPulledOver) {
  EXPECT_GT(tip(pass(0.1)).x(), 0.3);
  EXPECT_EQ(ask(tendons({0.025})).error, "");
  const StateMessage over = pass(1.5);
  EXPECT_LT(tip(over).x(), -0.7);
  EXPECT_EQ(over.actuators[0].force, 0) << "slack on the other side";
  const Node event = messenger_.last(me, "event");
  ASSERT_FALSE(event.empty());
  EXPECT_TRUE(*event.find("notice")->as<bool>());
  EXPECT_THAT(last_event(), HasSubstr("the arm snaps"));
  const std::size_t reported = messenger_.texts[me].size();
  EXPECT_EQ(ask(WeightRequest{false}).error, "");
  EXPECT_NEAR(tip(pass(0.5)).x(), -0.245, 0.01) << "as its tendon has it";
  EXPECT_EQ(messenger_.texts[me].size(), reported) << "it is reported once, and no switch is a snap";
}

// A rod with motors, spools and their backlash.
class DrivenRod : public PulledRod {
 protected:
  DrivenRod() : PulledRod(text()) {}
  static std::string text() {
    std::string text = read_text_file(checkout_file("examples/02_laboratory_arm/experiment.toml"), 1 << 20);
    text += "[truth.arm]\nmodel = \"static\"\ngravity = [0, -9.81, 0]\n";
    for (int i = 0; i < 3; ++i)
      text +=
          "[[truth.arm.section]]\n"
          "material = { youngs_modulus = 200e9, poisson = 0.3, radius_mm = 2, mass_per_length = 0.5 }\n";
    return text;
  }
};

TEST_F(DrivenRod, PullsItsTendonsByTheirMotors) {
  ASSERT_EQ(rig_->actuators.size(), 9U);
  EXPECT_TRUE(
      *session_.hello().controls.find("actuators")->as<Node::Array>()->front().find("motor")->as<bool>());
  std::vector<double> desired;
  for (const double each : rig_->actuators[0].together) desired.push_back(0.004 * each);
  EXPECT_EQ(ask(tendons(desired)).error, "");
  EXPECT_TRUE(pass(0.1).is_moving) << "as fast as its motors can";
  const StateMessage state = pass(5);
  EXPECT_FALSE(state.is_moving);
  expect_near(values(state), desired, 2e-5);
  EXPECT_GT(state.arm.bends[0].norm(), 0.05) << "its bends follow";
  // Commanded bends also change its tendon displacements.
  EXPECT_EQ(ask(bends({{0, 0}, {0, 0}, {0, 0}})).error, "");
  expect_near(values(pass(5)), std::vector<double>(9, 0.0), 2e-5);
}

// A run reports the backbone of its rod.
TEST(WatchedRod, LiesAsTheRunSaysThatItTrulyDoes) {
  const std::string text = viewed_rod();
  const ViewedRigPtr rig = viewed_rig(text);
  FakeMessenger messenger;
  FakeBackground background;
  const auto run = std::make_shared<RunLink>();
  LiveSession session(rig, messenger, background, {.start = 0, .results = {}, .run = run});
  session.opened(me);
  EXPECT_FALSE(run->needs_truth()) << "nobody has looked yet";
  session.advance(0.1);
  EXPECT_TRUE(run->needs_truth());
  EXPECT_FALSE(run->needs_truth()) << "once";
  const ArmState leaning{{{-0.6, 0}, {-0.6, 0}}, {1, 1}};
  const Backbone lies = LiveRig(rig, 0).at_rest(leaning);
  run->state(0.5, leaning, {});
  run->truth(0.5, {lies, {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3}, {1, 2, 3, 4, 5, 0}, {}});
  session.advance(0.2);
  const StateMessage state = messenger.state(me);
  EXPECT_LT((tip(state) - lies.tip().position).norm(), 1e-6);
  EXPECT_GT((tip(state) - rig->model.backbone(leaning).tip().position).norm(), 3e-3);
  ASSERT_EQ(state.actuators.size(), 6U);
  EXPECT_FLOAT_EQ(static_cast<float>(state.actuators[4].value), 5e-3F);
  EXPECT_EQ(state.actuators[4].force, 5);
  EXPECT_EQ(state.actuators[4].lost, 0);
}

TEST(WatchedRod, OfATrueRunIsTold) {
  const Experiment experiment = parse_experiment(viewed_rod(), "x.toml");
  class WantsAll : public RunLink {
   public:
    bool needs_truth() override { return true; }
    void truth(double time, const TrueArm& arm) override {
      times.push_back(time);
      last = std::make_shared<const TrueArm>(arm);
    }
    std::vector<double> times;
    std::shared_ptr<const TrueArm> last;
  };
  const TemporaryFolder folder;
  WantsAll watcher;
  run_linked(experiment, folder.path(), watcher);
  ASSERT_GT(watcher.times.size(), 10U);
  EXPECT_NEAR(watcher.times.back(), 1, 1e-9);
  EXPECT_EQ(watcher.last->tensions.size(), 6U);
  EXPECT_EQ(watcher.last->pulled.size(), 6U);
  EXPECT_GT(watcher.last->tensions[0], 0.5);
  EXPECT_GT((watcher.last->backbone.tip().position -
             experiment.arm.model().backbone({{{0.8, 0.5}, {-0.4, 0.7}}, {1, 1}}).tip().position)
                .norm(),
            2e-3);
}

}  // namespace
}  // namespace flexura
