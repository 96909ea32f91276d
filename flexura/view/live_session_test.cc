#include "flexura/view/live_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/arrays.h"
#include "flexura/store/text_file.h"
#include "tests/support/checkout.h"
#include "tests/support/live_sessions.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(LiveSessionTest, SendsStatesAtTheRateOfItsClock) {
  const StateMessage state = pass(1);
  EXPECT_EQ(messenger_.count(me, 0), 60);
  EXPECT_EQ(state.sequence, 59);
  EXPECT_NEAR(state.time, 1, 1e-6);
  EXPECT_FALSE(state.is_moving);
  EXPECT_EQ(state.samples.size(), 3);
  EXPECT_EQ(state.cameras.size(), 2);
  EXPECT_EQ(messenger_.count(other, 0), 0);
}

TEST_F(LiveSessionTest, MovesTheArmAsAskedWithinItsLimits) {
  EXPECT_EQ(ask(bends({{0.5, 0.25}, {0, 0}}, 1)).error, "");
  const StateMessage half = pass(0.5);
  EXPECT_TRUE(half.is_moving);
  EXPECT_NEAR(half.arm.bends[0].x(), 0.25, 0.02);
  const StateMessage there = pass(0.6);
  EXPECT_FALSE(there.is_moving);
  EXPECT_NEAR(there.arm.bends[0].x(), 0.5, 1e-6);
  // Clamped to the limit of 2 rad; the second section needs its time.
  EXPECT_EQ(ask(bends({{-3, 0}, {1, 0}})).error, "");
  const StateMessage limited = pass(0.5);
  EXPECT_NEAR(limited.arm.bends[0].x(), -2, 1e-6);
  EXPECT_NEAR(limited.arm.bends[1].x(), 0.5, 0.03);
}

TEST_F(LiveSessionTest, RefusesAWayIntoAnObstacle) {
  const ViewAnswer answer = ask(bends({{2, 0}, {0, 0}}));
  EXPECT_THAT(answer.error, HasSubstr("unsafe: section 2: contact with ball"));
  EXPECT_THAT(last_event(), HasSubstr("the arm does not move there: section 2: contact with ball"));
  EXPECT_EQ(pass(0.5).arm.bends[0].norm(), 0);
}

TEST_F(LiveSessionTest, BringsTheTipToAPlace) {
  const ArmState desired{{{0.3, 0.6}, {-0.8, 0.1}}, {1, 1}};
  const Eigen::Vector3d place = tip_pose(rig_->truth.driven(), desired).position;
  const ViewAnswer answer = ask(TipRequest{{place.x(), place.y(), place.z()}, {}});
  ASSERT_EQ(answer.error, "");
  EXPECT_TRUE(*answer.result.find("converged")->as<bool>());
  EXPECT_TRUE(*answer.result.find("moved")->as<bool>());
  const StateMessage state = pass(3);
  EXPECT_LT((state.samples.back().X_WS.position - place).norm(), 1e-5);
}

TEST_F(LiveSessionTest, LeavesTheTipWhereItsWayWouldTouch) {
  const ViewAnswer answer = ask(TipRequest{{0.5, 0.5, 0}, {}});
  EXPECT_FALSE(*answer.result.find("moved")->as<bool>());
  EXPECT_THAT(*answer.result.find("danger")->as<std::string>(), HasSubstr("contact with ball"));
  EXPECT_EQ(pass(0.5).arm.bends[0].norm(), 0);
}

TEST_F(LiveSessionTest, SaysThatATipIsOutOfReach) {
  const ViewAnswer answer = ask(TipRequest{{0, 5, 0}, {}});
  EXPECT_FALSE(*answer.result.find("converged")->as<bool>());
  EXPECT_EQ(*answer.result.find("reason")->as<std::string>(), "not_reachable");
  EXPECT_NEAR(*answer.result.find("position_error")->as<double>(), 4, 1e-6);
}

TEST_F(LiveSessionTest, LooksAtTheNewestOfManyMoves) {
  background_.is_prompt = false;
  std::vector<std::string> ends;
  for (const char* name : {"first", "second", "third"}) {
    session_.take(me, TipRequest{{0, 0.9, 0.1}, {}}, [&ends, name](const ViewAnswer& answer) {
      ends.push_back(std::string(name) + *answer.result.find("danger")->as<std::string>());
    });
  }
  EXPECT_THAT(ends, ::testing::ElementsAre("secondreplaced by a newer request"));
  background_.work();
  EXPECT_EQ(ends.size(), 3);
  EXPECT_EQ(ends[1], "first");
  EXPECT_EQ(ends[2], "third");
}

TEST_F(LiveSessionTest, HaltsEverythingAndWhatIsStillBeingJudged) {
  ask(bends({{-1, 0}, {0, 0}}, 2));
  ask(HeadRequest{"front", 0.4, {}, {}});
  pass(0.5);
  background_.is_prompt = false;
  std::string late;
  session_.take(me, bends({{1, 0}, {0, 0}}), [&](const ViewAnswer& answer) { late = answer.error; });
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  background_.work();
  EXPECT_EQ(late, "cancelled before the motion's start: the arm was stopped or reset");
  const StateMessage stopped = pass(0.5);
  EXPECT_FALSE(stopped.is_moving);
  EXPECT_NEAR(stopped.arm.bends[0].x(), -0.25, 0.02);
}

TEST_F(LiveSessionTest, PutsEverythingBack) {
  ask(bends({{-1, 0}, {0, 0}}));
  ask(HeadRequest{"front", 0.4, {}, {}});
  pass(2);
  EXPECT_EQ(ask(ResetRequest{}).error, "");
  const StateMessage state = pass(0.1);
  EXPECT_EQ(state.arm.bends[0].norm(), 0);
  EXPECT_EQ(state.cameras[0].head.pan, 0);
  EXPECT_GT(state.time, 2) << "time goes on";
}

TEST_F(LiveSessionTest, CountsWhereNoWayLeadsFromOneStateToTheNext) {
  const int start = pass(0.1).leaps;
  ask(bends({{-1, 0}, {0, 0}}));
  EXPECT_EQ(pass(1).leaps, start) << "the arm went there";
  ask(ResetRequest{});
  EXPECT_EQ(pass(0.1).leaps, start + 1);
  ask(bends({{-1, 0}, {0, 0}}));
  pass(1);
  background_.is_prompt = false;
  ask(RunRequest{.task = {}, .speed = 0});
  EXPECT_EQ(pass(0.1).leaps, start + 1) << "it has not begun";
  background_.work();
  pass(0.1);
  EXPECT_EQ(pass(0.1).leaps, start + 2) << "to the run's start, or to its end where that was all";
}

TEST_F(LiveSessionTest, TurnsACameraOneAxisAfterTheOther) {
  EXPECT_EQ(ask(HeadRequest{"front", 0.2, {}, {}}).error, "");
  EXPECT_EQ(ask(HeadRequest{"front", {}, 0.1, {}}).error, "");
  EXPECT_EQ(ask(HeadRequest{"front", {}, {}, 2.0}).error, "");
  const StateMessage state = pass(5);
  EXPECT_NEAR(state.cameras[0].head.pan, 0.2, 1e-6);
  EXPECT_NEAR(state.cameras[0].head.tilt, 0.1, 1e-6);
  EXPECT_NEAR(state.cameras[0].fx, 160, 1e-3);
  EXPECT_EQ(state.cameras[1].head.pan, 0);
  EXPECT_THAT(ask(HeadRequest{"back", 0.2, {}, {}}).error,
              HasSubstr("camera = \"back\": there is no camera"));
}

TEST_F(LiveSessionTest, SaysThatACameraHasNoStage) {
  EXPECT_EQ(ask(StageRequest{"front", 1.0, {}, {}}).error, "the camera \"front\" has no stage");
  EXPECT_EQ(ask(StageRequest{"front", {}, {}, {}}).error, "the camera \"front\" has no stage");
}

TEST_F(LiveSessionTest, RendersNothingThatNobodyAskedFor) {
  pass(1);
  EXPECT_THAT(background_.jobs, IsEmpty());
}

TEST_F(LiveSessionTest, SendsTheNextImageWhenTheLastHasCome) {
  EXPECT_EQ(ask(ImagesRequest{"front", 30, 80}).error, "");
  pass(1);
  ASSERT_EQ(messenger_.count(me, 1), 1) << "no acknowledgement, no more";
  const std::string first = last_image(me, 1);
  EXPECT_EQ(first.substr(0, 4), std::string("\x02\0\0\0", 4));
  EXPECT_EQ(first.substr(16, 3), "\xff\xd8\xff");
  for (int i = 0; i < 60; ++i) {
    const std::string image = last_image(me, 1);
    const auto number = static_cast<unsigned char>(image[4]);
    ask(AckRequest{"front", number});
    pass(1.0 / 60);
  }
  EXPECT_NEAR(static_cast<double>(messenger_.count(me, 1)), 30, 2) << "a second at 30 Hz";
  EXPECT_EQ(messenger_.count(me, 2), 0);
  const std::size_t count = messenger_.count(me, 1);
  ask(ImagesRequest{"front", 0, 80});
  pass(1);
  EXPECT_EQ(messenger_.count(me, 1), count);
}

TEST_F(LiveSessionTest, TakesOnePictureForAllWhoLook) {
  session_.opened(other);
  ask(ImagesRequest{"front", 30, 80});
  ask(ImagesRequest{"front", 30, 80}, other);
  pass(0.1);
  EXPECT_EQ(background_.jobs[Lane::pictures], 1);
  EXPECT_EQ(messenger_.count(other, 1), 1);
  EXPECT_EQ(last_image(me, 1), last_image(other, 1));
  session_.closed(other);
  pass(0.1);
  EXPECT_EQ(messenger_.count(other, 0), 6) << "no states for one who has left";
}

// The first camera has no noise: a scene at rest gives the same picture.
TEST_F(LiveSessionTest, SendsWhatStandsStillAgainUnderItsNewNumber) {
  ask(ImagesRequest{"front", 30, 80});
  pass(0.1);
  const std::string first = last_image(me, 1);
  ask(AckRequest{"front", static_cast<unsigned char>(first[4])});
  pass(0.1);
  const std::string second = last_image(me, 1);
  EXPECT_NE(first[4], second[4]);
  EXPECT_EQ(first.substr(16), second.substr(16));
  ask(bends({{-1, 0}, {0, 0}}));
  ask(AckRequest{"front", static_cast<unsigned char>(second[4])});
  pass(0.1);
  ask(AckRequest{"front", static_cast<unsigned char>(last_image(me, 1)[4])});
  pass(0.1);
  EXPECT_NE(last_image(me, 1).substr(16), second.substr(16));
}

TEST_F(LiveSessionTest, TellsAPixelOfThePictureThatWasSent) {
  ask(ImagesRequest{"side", 30, 80});
  pass(0.5);
  const ViewAnswer answer = ask(PixelRequest{"side", 31, 24});
  ASSERT_EQ(answer.error, "");
  EXPECT_EQ(answer.result.find("value")->as<Node::Array>()->size(), 3);
  EXPECT_EQ(*answer.result.find("bits")->as<std::int64_t>(), 12);
  EXPECT_THAT(*answer.result.find("label")->as<std::string>(), HasSubstr("section"));
  EXPECT_NEAR(*answer.result.find("depth")->as<double>(), 2, 0.05);
  EXPECT_NEAR(*answer.result.find("s")->as<double>(), 0.5, 0.02);
  const auto number = static_cast<unsigned char>(last_image(me, 2)[4]);
  EXPECT_EQ(*answer.result.find("number")->as<std::int64_t>(), number);
  EXPECT_THAT(ask(PixelRequest{"side", 64, 0}).error, HasSubstr("outside the image"));
  const ViewAnswer beyond = ask(PixelRequest{"front", 0, 0});
  EXPECT_TRUE(beyond.result.find("s")->empty());
}

TEST_F(LiveSessionTest, TellsAPointOfTheBackbone) {
  ask(bends({{-1, 0}, {0, 0}}));
  pass(0.5);
  const ViewAnswer answer = ask(PointRequest{0.25});
  EXPECT_EQ(*answer.result.find("section")->as<std::int64_t>(), 0);
  EXPECT_NEAR(*answer.result.find("curvature")->as<double>(), 2, 1e-9);
  EXPECT_NEAR(*answer.result.find("bending_plane")->as<double>(), std::numbers::pi, 1e-9);
  EXPECT_THAT(ask(PointRequest{1.2}).error, HasSubstr("expected 0 to 1 m"));
  EXPECT_EQ(ask(PointRequest{1 + 1e-7}).error, "");
}

TEST_F(LiveSessionTest, TellsWhereAnotherShapeWouldLie) {
  BackboneRequest request;
  request.bends = {{{0.5, 0}, {0, 0.5}}};
  EXPECT_EQ(ask(request).result.find("poses")->as<Node::Array>()->size(), 3);
  request.bends->pop_back();
  EXPECT_NE(ask(request).error, "");
}

TEST_F(LiveSessionTest, GivesTheNewestPictureAsAFile) {
  pass(0.1);
  HttpAnswer got;
  session_.take(ImageAsk{"front", {}}, [&](const HttpAnswer& answer) { got = answer; });
  EXPECT_EQ(got.status, 200);
  EXPECT_EQ(got.content_type, "image/png");
  EXPECT_EQ(got.body.substr(1, 3), "PNG");
  EXPECT_THROW(session_.take(ImageAsk{"front", 1.0}, [](const HttpAnswer&) {}), ViewRefusal);
  EXPECT_THROW(session_.take(ReportAsk{}, [](const HttpAnswer&) {}), ViewRefusal);
}

// The model's arm stands where its path is free.
class MisplacedArm : public LiveSessionTest {
 protected:
  MisplacedArm() : LiveSessionTest(viewed_text + "[truth.arm.base]\nposition = [0.3, 0, 0]\n") {}
};

TEST_F(MisplacedArm, StopsBeforeItTouches) {
  EXPECT_EQ(ask(bends({{0.4, 0}, {0, 0}}, 2)).error, "");
  const StateMessage state = pass(3);
  EXPECT_THAT(last_event(), HasSubstr("stopped before section 2: contact with ball"));
  EXPECT_FALSE(state.is_moving);
  EXPECT_FALSE(state.is_unsafe);
  EXPECT_GT(state.arm.bends[0].x(), 0.1);
  EXPECT_LT(state.arm.bends[0].x(), 0.39);
  EXPECT_EQ(ask(bends({{0, 0}, {0, 0}}, 0)).error, "") << "the way back is free";
  EXPECT_EQ(pass(0.1).arm.bends[0].norm(), 0);
}

// Returns a rig with one camera, or with three.
std::string of_cameras(int count) {
  const std::size_t side = viewed_text.find("[[camera]]\nname = \"side\""),
                    task = viewed_text.find("[[task]]");
  std::string more;
  if (count == 3) {
    more = viewed_text.substr(side, task - side);
    more.replace(more.find("side"), 4, "behind");
  }
  return viewed_text.substr(0, side) + (count == 1 ? "" : viewed_text.substr(side, task - side)) + more +
         viewed_text.substr(task);
}
class OneCamera : public LiveSessionTest {
 protected:
  OneCamera() : LiveSessionTest(of_cameras(1)) {}
};
class ThreeCameras : public LiveSessionTest {
 protected:
  ThreeCameras() : LiveSessionTest(of_cameras(3)) {}
};

TEST_F(OneCamera, IsTurnedHaltedAndRunAsTwoAre) {
  EXPECT_EQ(ask(HeadRequest{"front", 0.2, {}, {}}).error, "");
  EXPECT_NEAR(pass(2).cameras.at(0).head.pan, 0.2, 1e-6);
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  EXPECT_NE(ask(HeadRequest{"side", 0.2, {}, {}}).error, "");
  EXPECT_EQ(ask(RunRequest{.task = {}, .speed = 0}).error, "");
  EXPECT_EQ(pass(2).cameras.size(), 1U);
}

TEST_F(ThreeCameras, AreTurnedHaltedAndRunAsTwoAre) {
  EXPECT_EQ(ask(HeadRequest{"behind", 0.2, {}, {}}).error, "");
  EXPECT_NEAR(pass(2).cameras.at(2).head.pan, 0.2, 1e-6);
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  EXPECT_EQ(ask(RunRequest{.task = {}, .speed = 0}).error, "");
  EXPECT_EQ(pass(2).cameras.size(), 3U);
}

class LaboratoryArm : public LiveSessionTest {
 protected:
  LaboratoryArm()
      : LiveSessionTest(
            read_text_file(checkout_file("examples/02_laboratory_arm/experiment.toml"), 1 << 20)) {}
};

TEST_F(LaboratoryArm, IsMovedByItsTendonsToo) {
  const std::size_t tendons = rig_->drive->tendons.size();
  ArmRequest request;
  request.tendons = std::vector<double>(tendons, 0.0);
  EXPECT_EQ(ask(request).error, "");
  EXPECT_EQ(pass(0.1).displacements.size(), tendons);
  request.tendons->pop_back();
  EXPECT_THAT(ask(request).error, HasSubstr("displacements"));
}

}  // namespace
}  // namespace flexura
