// Sessions whose true arm is an elastic rod: the display shows the sagging rod, not a chain of arcs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>

#include "flexura/store/text_file.h"
#include "flexura/view/live_rig.h"
#include "flexura/view/run_link.h"
#include "tests/support/checkout.h"
#include "tests/support/live_sessions.h"
#include "tests/support/rod_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const ArmState leaning{{{-0.6, 0}, {-0.6, 0}}, {1, 1}};

Eigen::Vector3d point_in(const Node& answer, const char* key) {
  const Node::Array& point = *answer.find(key)->as<Node::Array>();
  return {*point[0].as<double>(), *point[1].as<double>(), *point[2].as<double>()};
}

class RodView : public LiveSessionTest {
 protected:
  explicit RodView(const std::string& text = viewed_rod()) : LiveSessionTest(text) {}

  ViewAnswer lean() { return ask(bends({{-0.6, 0}, {-0.6, 0}}, 1)); }
  static Eigen::Vector3d tip(const StateMessage& state) { return state.samples.back().X_WS.position; }
  [[nodiscard]] Eigen::Vector3d arcs_tip(const ArmState& state) const {
    return rig_->truth.backbone(state).tip().position;
  }
};

TEST_F(RodView, DrawsTheRodAndSaysWhatItsDrivesBendItTo) {
  EXPECT_EQ(lean().error, "");
  const StateMessage state = pass(3);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(state.arm.bends[i].isApprox(leaning.bends[i], 1e-6));
  EXPECT_EQ(state.samples.size(), 49U) << "two arcs between each two of 25 samples";
  EXPECT_GT((tip(state) - arcs_tip(leaning)).norm(), 3e-3) << "its sag";
  EXPECT_LT((tip(state) - LiveRig(rig_, 0).at_rest(leaning).tip().position).norm(), 1e-5);
}

TEST_F(RodView, TellsPointsOfTheRod) {
  EXPECT_EQ(lean().error, "");
  const Eigen::Vector3d shown = tip(pass(3));
  EXPECT_LT((point_in(ask(PointRequest{1}).result, "position") - shown).norm(), 1e-6);
  BackboneRequest request;
  for (const double bend : {-0.6, -0.5}) {
    request.bends = {{{bend, 0}, {bend, 0}}};
    const ViewAnswer answer = ask(request);
    ASSERT_EQ(answer.error, "");
    const Node::Array& poses = *answer.result.find("poses")->as<Node::Array>();
    EXPECT_EQ(poses.size(), 49U);
    const Node::Array& last = *poses.back().as<Node::Array>();
    const Eigen::Vector3d there(*last[0].as<double>(), *last[1].as<double>(), *last[2].as<double>());
    const double arcs_off = (there - arcs_tip({{{bend, 0}, {bend, 0}}, {1, 1}})).norm();
    EXPECT_GT(arcs_off, 2e-3) << "where it would lie";
    EXPECT_EQ((there - shown).norm() < 1e-6, bend == -0.6);
  }
}

TEST_F(RodView, SendsPicturesWhileItMovesAndAfterAReset) {
  for (const char* camera : {"front", "side"}) EXPECT_EQ(ask(ImagesRequest{camera, 30, 80}).error, "");
  EXPECT_EQ(lean().error, "");
  const auto acknowledge = [&] {
    for (std::uint32_t i = 0; i < 2; ++i)
      ask(AckRequest{i == 0 ? "front" : "side", static_cast<unsigned char>(last_image(me, i + 1)[4])});
  };
  pass(0.5), acknowledge(), pass(0.1);
  EXPECT_EQ(messenger_.count(me, 2), 2U);
  EXPECT_EQ(ask(ResetRequest{}).error, "");
  acknowledge(), pass(0.1), acknowledge(), pass(0.1);
  EXPECT_EQ(messenger_.count(me, 1), 4U);
  EXPECT_EQ(messenger_.count(me, 2), 4U);
  EXPECT_LT((tip(messenger_.state(me)) - arcs_tip(ArmState::straight(2))).norm(), 1e-3);
  EXPECT_THAT(*ask(PixelRequest{"side", 31, 24}).result.find("label")->as<std::string>(),
              HasSubstr("section"));
}

// The program's time advances while no client watches.
TEST_F(RodView, MakesUpForNoTimeThatNobodySaw) {
  EXPECT_EQ(lean().error, "");
  const StateMessage before = pass(0.5);
  session_.advance(clock_ += 1e5);
  const StateMessage after = messenger_.state(me);
  EXPECT_NEAR(after.time, before.time + 1e5, 1e-6);
  EXPECT_TRUE(after.is_moving) << "its own time stood still";
  EXPECT_FALSE(pass(2).is_moving);
}

// A run reports its commands: its pictures show the rod at rest for them, and its states the command.
TEST(RodShot, ShowsTheRodWhileARunGoesOn) {
  const auto shown_in = [](const std::string& text) {
    FakeMessenger messenger;
    FakeBackground background;
    const auto run = std::make_shared<RunLink>();
    LiveSession session(viewed_rig(text), messenger, background, {.start = 0, .results = {}, .run = run});
    session.opened(me);
    run->state(0.5, leaning, {});
    session.advance(0.1);
    std::string file;
    session.take(ImageAsk{"front", {}}, [&](const HttpAnswer& answer) { file = answer.body; });
    return std::pair(file, messenger.state(me));
  };
  const auto [rod, state] = shown_in(viewed_rod());
  const auto [arcs, reported] = shown_in(viewed_text);
  EXPECT_EQ(rod.substr(1, 3), "PNG");
  EXPECT_NE(rod, arcs);
  EXPECT_LT((state.samples.back().X_WS.position - reported.samples.back().X_WS.position).norm(), 1e-9);
}

TEST(RodShot, ShowsHowTheRodLayBetweenTwoInstants) {
  const ViewedRigPtr rig = viewed_rig(viewed_rod());
  LiveRig live(rig, 100);
  ASSERT_TRUE(live.ports().arm->command(leaning, 1));
  live.go_to(100.5);
  const ValueShot moving = live.shot(1, live.newest_frame(1));
  const double start = moving.instants->front().time, end = moving.instants->back().time;
  EXPECT_NEAR(end - start, 0.01, 1e-9);
  for (const double time : {start, start + 0.002, start + 0.0071, end}) {
    const Backbone shown = moving.shot.backbone(time), is = live.backbone(time);
    EXPECT_EQ(shown.arcs().size(), is.arcs().size());
    for (const double s : {0.3, 0.7, shown.length()})
      EXPECT_LT((shown.pose(s).position - is.pose(std::min(s, is.length())).position).norm(), 2e-6) << time;
  }
  EXPECT_GT((live.backbone(start).tip().position - live.backbone(end).tip().position).norm(), 1e-3);
}

// The first camera has no noise.
TEST(RodShot, IsTheSamePictureOfARodAtRestAlone) {
  const ViewedRigPtr rig = viewed_rig(viewed_rod());
  LiveRig live(rig, 0);
  ASSERT_TRUE(live.ports().arm->command(leaning, 1));
  const auto shot_at = [&](double time) {
    live.go_to(time);
    return live.shot(0, live.newest_frame(0));
  };
  const ValueShot moving = shot_at(0.5), later = shot_at(0.6), rest = shot_at(3), still = shot_at(4);
  EXPECT_FALSE(show_the_same(moving, later));
  EXPECT_TRUE(show_the_same(rest, still));
  // The same command with another shape: the rod may have come along another path.
  Instant other = rest.instants->front();
  other.shape = std::make_shared<const Backbone>(live.at_rest({{{-0.6, 0}, {-0.601, 0}}, {1, 1}}));
  EXPECT_FALSE(show_the_same(rest, value_shot(rig, 0, 0, 0, {other})));
}

// A ball below the tip position of the arcs: the rod hangs lower.
class RodAboveABall : public RodView {
 protected:
  static constexpr double mass = 2;  // kg/m
  RodAboveABall() : RodView(viewed_rod(mass) + ball()) {}

  static std::string ball() {
    const ViewedRigPtr rig = viewed_rig(viewed_rod(mass));
    const Pose arcs = rig->truth.backbone(leaning).tip(), rod = LiveRig(rig, 0).at_rest(leaning).tip();
    const Eigen::Vector3d middle = (arcs.position + rod.position) / 2;
    const Eigen::Vector3d down = -arcs.rotation.col(2).cross(Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d center = middle + 0.12 * down.normalized() * (down.y() < 0 ? 1 : -1);
    return fmt::format(
        "[[obstacle]]\nkind = \"sphere\"\nname = \"floor\"\ncenter = [{}, {}, {}]\nradius = 0.1\n",
        center.x(), center.y(), center.z());
  }
};

TEST_F(RodAboveABall, StopsBeforeTheRodTouches) {
  EXPECT_EQ(lean().error, "") << "for arcs the way is free";
  const StateMessage state = pass(3);
  EXPECT_THAT(last_event(), HasSubstr("stopped before section 2: contact with floor"));
  EXPECT_FALSE(state.is_moving);
  EXPECT_FALSE(state.is_unsafe);
  EXPECT_LT(state.arm.bends[0].x(), -0.4);
  EXPECT_GT(state.arm.bends[0].x(), -0.599);
}

// A rod with motors, spools and their backlash.
class LaboratoryRod : public RodView {
 protected:
  LaboratoryRod() : RodView(text()) {}
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

TEST_F(LaboratoryRod, IsPulledByItsDrive) {
  EXPECT_EQ(ask(bends({{0.5, 0}, {0.5, 0}, {0.3, 0.2}})).error, "");
  const StateMessage state = pass(3);
  EXPECT_FALSE(state.is_moving);
  EXPECT_EQ(state.samples.size(), 73U);
  EXPECT_EQ(state.displacements.size(), 9U);
  EXPECT_GT((tip(state) - arcs_tip(state.arm)).norm(), 2e-3);
  // Computed without its backlash, and so not exactly at its position.
  EXPECT_LT((tip(state) - LiveRig(rig_, 0).at_rest(state.arm).tip().position).norm(), 1e-3);
}

}  // namespace
}  // namespace flexura
