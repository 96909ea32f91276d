#include "flexura/view/live_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/arrays.h"
#include "flexura/model/backbone.h"
#include "flexura/store/text_file.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A session with a client, whose clock the test moves on.
class LiveSessionTest : public ::testing::Test {
 protected:
  explicit LiveSessionTest(const std::string& text = viewed_text)
      : rig_(viewed_rig(text)),
        session_(rig_, messenger_, background_, {.start = 100, .results = folder_.path() / "run"}) {
    session_.opened(me);
  }

  // What comes of a request; its error, if there is one.
  ViewAnswer ask(const Ask& ask, ClientId client = me) {
    answer_.reset();
    try {
      session_.take(client, ask, [this](const ViewAnswer& answer) { answer_ = answer; });
    } catch (const ViewRefusal& refusal) {
      return {{}, refusal.what()};
    }
    return answer_.value_or(ViewAnswer{{}, "no answer yet"});
  }
  // Goes on by so many s, 60 times a second.
  StateMessage pass(double seconds) {
    for (const double end = clock_ + seconds; clock_ < end - 1e-9;) session_.advance(clock_ += 1.0 / 60);
    return messenger_.state(me);
  }
  [[nodiscard]] std::string last_image(ClientId client, std::uint32_t stream) {
    return *messenger_.posts[{client, stream}].back();
  }
  [[nodiscard]] std::string last_event() {
    const Node event = messenger_.last(me, "event");
    return event.empty() ? "" : *event.find("text")->as<std::string>();
  }
  static ArmRequest bends(const std::vector<std::array<double, 2>>& bends, double duration = 0) {
    ArmRequest request;
    request.bends = bends;
    request.duration = duration;
    return request;
  }

  TemporaryFolder folder_;
  ViewedRigPtr rig_;
  FakeMessenger messenger_;
  FakeBackground background_;
  LiveSession session_;
  double clock_ = 100;
  std::optional<ViewAnswer> answer_;
};

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
  // Drawn to the limit of 2 rad; the second section takes its time.
  EXPECT_EQ(ask(bends({{-3, 0}, {1, 0}})).error, "");
  const StateMessage limited = pass(0.5);
  EXPECT_NEAR(limited.arm.bends[0].x(), -2, 1e-6);
  EXPECT_NEAR(limited.arm.bends[1].x(), 0.5, 0.03);
}

TEST_F(LiveSessionTest, RefusesAWayIntoAnObstacle) {
  const ViewAnswer answer = ask(bends({{2, 0}, {0, 0}}));
  EXPECT_THAT(answer.error, HasSubstr("unsafe: section 2: contact with ball"));
  EXPECT_THAT(last_event(), HasSubstr("does not go there: section 2: contact with ball"));
  EXPECT_EQ(pass(0.5).arm.bends[0].norm(), 0);
}

TEST_F(LiveSessionTest, BringsTheTipToAPlace) {
  const ArmState wanted{{{0.3, 0.6}, {-0.8, 0.1}}, {1, 1}};
  const Eigen::Vector3d place = tip_pose(rig_->truth, wanted).position;
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
  EXPECT_THAT(ends, ::testing::ElementsAre("secondovertaken by a newer one"));
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
  EXPECT_EQ(late, "something else has stopped it");
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
  ask(RunRequest{});
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
  EXPECT_THAT(ask(HeadRequest{"back", 0.2, {}, {}}).error, HasSubstr("camera = \"back\": there is no camera"));
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

// The first camera has no noise: what stands still looks the same.
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

TEST_F(LiveSessionTest, RunsTheTasksIntoANewFolder) {
  background_.is_prompt = false;
  const ViewAnswer answer = ask(RunRequest{});
  ASSERT_EQ(answer.error, "");
  const std::filesystem::path results = *answer.result.find("folder")->as<std::string>();
  EXPECT_TRUE(pass(0.1).is_running);
  EXPECT_THAT(ask(bends({{0, 0}, {0, 0}})).error, HasSubstr("a run of tasks is going on"));
  background_.work();
  EXPECT_FALSE(session_.results());
  EXPECT_FALSE(pass(0.1).is_running);
  EXPECT_EQ(session_.results(), results);
  EXPECT_TRUE(std::filesystem::exists(results / "summary.json"));
  const Node progress = messenger_.last(me, "progress");
  EXPECT_TRUE(*progress.find("done")->as<bool>());
  EXPECT_EQ(*progress.find("outcome")->as<std::string>(), "done");
}

TEST_F(LiveSessionTest, CancelsARun) {
  EXPECT_THAT(ask(CancelRequest{}).error, HasSubstr("no run is going on"));
  background_.is_prompt = false;
  ask(RunRequest{});
  EXPECT_EQ(ask(CancelRequest{}).error, "");
  background_.work();
  pass(0.1);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
}

TEST_F(LiveSessionTest, HaltsARunTogetherWithEverythingElse) {
  background_.is_prompt = false;
  ask(RunRequest{});
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  background_.work();
  EXPECT_FALSE(pass(0.1).is_running);
  EXPECT_EQ(*messenger_.last(me, "progress").find("outcome")->as<std::string>(), "cancelled");
}

TEST_F(LiveSessionTest, ShowsARunThatSomebodyElseStarted) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run});
  watched.opened(other);
  EXPECT_TRUE(watched.hello().readonly);
  run->update(0.5, "bend");
  run->state(7.25, {{{0.1, 0.2}, {0.3, 0.4}}, {1, 1}}, {});
  watched.advance(100.1);
  EXPECT_EQ(messenger_.state(other).time, 7.25);
  EXPECT_NEAR(messenger_.state(other).arm.bends[1].y(), 0.4, 1e-6);
  EXPECT_EQ(*messenger_.last(other, "progress").find("fraction")->as<double>(), 0.5);
  EXPECT_THROW(watched.take(other, bends({{0, 0}, {0, 0}}), [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, CancelRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_THROW(watched.take(other, HaltRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
  EXPECT_FALSE(run->cancelled()) << "what is seen changes nothing of a run";
  run->finish({"unsafe", "section 1: bend", folder_.path()});
  watched.advance(100.2);
  EXPECT_TRUE(watched.is_over());
  EXPECT_EQ(*messenger_.last(other, "progress").find("text")->as<std::string>(), "section 1: bend");
}

// The second camera slides, and starts elsewhere than it is believed to.
const std::string sliding_text =
    replaced(viewed_text, "mount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0] }",
             "mount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0], stage = { y = { limits = [-0.3, 0.3] "
             "} } }") +
    "[[truth.camera]]\nname = \"side\"\ninitial.pan_deg = 2\n";

class SlidingCamera : public LiveSessionTest {
 protected:
  SlidingCamera() : LiveSessionTest(sliding_text) {}
};

TEST_F(SlidingCamera, MovesAlongTheAxesThatItHas) {
  EXPECT_EQ(ask(StageRequest{"side", {}, 0.2, {}}).error, "");
  EXPECT_NEAR(pass(5).cameras[1].stage.y(), 0.2, 1e-6);
  EXPECT_EQ(ask(StageRequest{"side", {}, 0.1, 0.1}).error,
            "the stage of camera \"side\" does not move along z");
  EXPECT_NEAR(pass(5).cameras[1].stage.y(), 0.2, 1e-6);
}

// What a run reads from its cameras is where the page sees them, and through them.
TEST_F(SlidingCamera, StandsWhereAWatchedRunReadsIt) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run});
  watched.opened(other);
  const ArmState arm{{{0.1, 0.2}, {0.3, 0.4}}, {1, 1}};
  const auto picture = [&](std::span<const CameraReading> readings) {
    run->state(7, arm, readings);
    watched.advance(clock_ += 0.1);
    HttpAnswer got;
    watched.take(ImageAsk{"side", {}}, [&](const HttpAnswer& answer) { got = answer; });
    return got.body;
  };
  const std::string at_start = picture({});
  const StateMessage start = messenger_.state(other);
  EXPECT_NEAR(start.cameras[1].head.pan, 2 * std::numbers::pi / 180, 1e-6) << "where it truly stands";
  const CameraReading front{{0, 0, 1}, {}}, side{{0.05, -0.02, 1.5}, {{0, 0.25, 0}}};
  const std::string moved = picture(std::array{front, side});
  EXPECT_NE(moved, at_start);
  const CameraSample shown = messenger_.state(other).cameras[1];
  EXPECT_NEAR(shown.head.pan, 2 * std::numbers::pi / 180 + 0.05, 1e-6) << "from where it started";
  EXPECT_NEAR(shown.head.tilt, -0.02, 1e-6);
  EXPECT_NEAR(shown.head.zoom, 1.5, 1e-6);
  EXPECT_NEAR(shown.stage.y(), 0.25, 1e-6);
  EXPECT_NEAR((shown.X_WC.position - start.cameras[1].X_WC.position).norm(), 0.25, 0.01);
  EXPECT_NEAR(shown.fx, 1.5 * start.cameras[1].fx, 1e-3);
}

TEST_F(SlidingCamera, IsKnownByItsReadingsAlone) {
  const CameraReading read{{0.1, 0.05, 1.2}, {{0, -0.1, 0}}};
  const CameraReading again = rig_->reading(1, rig_->stance(1, read));
  EXPECT_NEAR(again.head.pan, read.head.pan, 1e-12);
  EXPECT_NEAR(again.head.tilt, read.head.tilt, 1e-12);
  EXPECT_NEAR(again.head.zoom, read.head.zoom, 1e-12);
  EXPECT_NEAR((again.stage.offset - read.stage.offset).norm(), 0, 1e-12);
  EXPECT_FALSE(rig_->believed_view(1, read).X_WC.rotation.isApprox(
      rig_->cameras[1].view(read.stage, rig_->stance(1, read).head).X_WC.rotation));
  // Whoever wrote the log.
  EXPECT_LE(std::abs(rig_->stance(1, {{1e300, 0, 1e9}, {{0, -1e300, 0}}}).stage.offset.y()), 0.3);
}

TEST_F(LiveSessionTest, MeasuresThePictureThatWasSent) {
  EXPECT_THAT(ask(MeasureRequest{"front", {}}).error,
              HasSubstr("no picture of the camera \"front\" was sent yet"));
  EXPECT_THAT(ask(MeasureRequest{"back", {}}).error, HasSubstr("expected one of \"front\", \"side\""));
  EXPECT_THAT(ask(ShapeRequest{}).error, HasSubstr("was sent yet"));
}

// An arm large enough to be measured, with bands, before cameras that see it well.
const std::string measured_text = R"(
[arm]
kind = "spatial"
initial = { bends = [[0.6, 0.4], [-0.8, 0.5]] }
look = { bands = { per_section = 3, width = 0.014, colors = [[0.85, 0.1, 0.1], [0.1, 0.2, 0.85]] } }
[[arm.section]]
length = 0.5
radius = 0.02
[[arm.section]]
length = 0.5
radius = 0.02
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2.2], look_at = [0, 0.5, 0] }
sensor = { psf = 0.7, pixels = "color" }
[[camera]]
name = "side"
mount = { position = [-2.2, 0.5, 0], look_at = [0, 0.5, 0] }
sensor = { psf = 0.7, bits = 12 }
[[truth.camera]]
name = "front"
initial.pan_deg = 0
)";

class MeasuredArm : public LiveSessionTest {
 protected:
  MeasuredArm() : LiveSessionTest(measured_text) {
    for (const char* camera : {"front", "side"}) ask(ImagesRequest{camera, 30, 80});
    pass(0.2);
  }
  static std::vector<Eigen::Vector2d> points_of(const Node& layer) {
    std::vector<Eigen::Vector2d> points;
    for (const Node& point : *layer.find("points")->as<Node::Array>()) {
      const auto& pair = *point.as<Node::Array>();
      points.emplace_back(*pair[0].as<double>(), *pair[1].as<double>());
    }
    return points;
  }
  static std::vector<const Node*> layers_of(const ViewAnswer& answer, const std::string& id) {
    std::vector<const Node*> layers;
    for (const Node& layer : *answer.result.find("layers")->as<Node::Array>())
      if (*layer.find("id")->as<std::string>() == id) layers.push_back(&layer);
    return layers;
  }
};

// Held against where the arm truly is, through the camera that truly took the picture.
TEST_F(MeasuredArm, LiesUnderItsLayers) {
  for (const char* camera : {"front", "side"}) {
    const ViewAnswer answer = ask(MeasureRequest{camera, {}});
    ASSERT_EQ(answer.error, "");
    ASSERT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
    const std::size_t place = *rig_->camera(camera);
    const std::string image = last_image(me, static_cast<std::uint32_t>(1 + place));
    EXPECT_EQ(*answer.result.find("number")->as<std::int64_t>(), static_cast<unsigned char>(image[4]));
    const CameraStance stance = rig_->first_stance(place);
    const View view = rig_->cameras[place].view(stance.stage, stance.head);
    const Backbone backbone(rig_->truth, rig_->initial);
    std::vector<Eigen::Vector2d> truth;
    for (int i = 0; i <= 1000; ++i)
      truth.push_back(*view.project(backbone.pose(1e-3 * i * backbone.length()).position));
    const auto distance = [&](const Eigen::Vector2d& pixel) {
      double nearest = 1e9;
      for (const Eigen::Vector2d& point : truth) nearest = std::min(nearest, (point - pixel).norm());
      return nearest;
    };
    const auto axis = points_of(*layers_of(answer, "axis").at(0));
    ASSERT_GT(axis.size(), 50);
    for (const Eigen::Vector2d& point : axis)
      EXPECT_LT(distance(point), 0.7) << camera << " " << point.transpose();
    ASSERT_GE(layers_of(answer, "silhouette").size(), 2);
    for (const Node* side : layers_of(answer, "silhouette"))
      for (const Eigen::Vector2d& point : points_of(*side)) EXPECT_NEAR(distance(point), 7.3, 2.5);
    EXPECT_EQ(layers_of(answer, "mask").size(), 1);
  }
  const ViewAnswer answer = ask(MeasureRequest{"front", {}});
  const auto markers = points_of(*layers_of(answer, "markers").at(0));
  EXPECT_GE(markers.size(), 5) << "of three bands a section; one may be seen too much from its end";
  EXPECT_LE(markers.size(), 6);
  const Backbone backbone(rig_->truth, rig_->initial);
  const CameraStance stance = rig_->first_stance(0);
  const View view = rig_->cameras[0].view(stance.stage, stance.head);
  const auto look = rig_->experiment.arm.look.markers(rig_->truth);
  for (const Eigen::Vector2d& seen : markers) {
    const bool is_one = std::ranges::any_of(look, [&](const Marker& marker) {
      return (*view.project(backbone.pose(marker.at).position) - seen).norm() < 1;
    });
    EXPECT_TRUE(is_one) << seen.transpose();
  }
  const ViewAnswer few = ask(MeasureRequest{"front", {{"axis"}}});
  EXPECT_EQ(few.result.find("layers")->as<Node::Array>()->size(), 1);
}

TEST_F(MeasuredArm, IsFoundInTwoPicturesAsItStands) {
  const ViewAnswer answer = ask(ShapeRequest{});
  ASSERT_EQ(answer.error, "");
  ASSERT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
  EXPECT_EQ(answer.result.find("numbers")->as<Node::Array>()->size(), 2);
  const Node::Array& tip = *answer.result.find("poses")->as<Node::Array>()->back().as<Node::Array>();
  const Eigen::Vector3d truth = tip_pose(rig_->truth, rig_->initial).position;
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(*tip[static_cast<std::size_t>(i)].as<double>(), truth[i], 2e-3);
  EXPECT_LT(*answer.result.find("rms_px")->as<double>(), 0.5);
}

TEST_F(MeasuredArm, IsMeasuredInTheNewestOfManyPictures) {
  background_.is_prompt = false;
  std::vector<std::string> ends;
  for (const char* name : {"first: ", "second: ", "third: "}) {
    session_.take(me, MeasureRequest{"front", {}}, [&ends, name](const ViewAnswer& answer) {
      ends.push_back(name + (answer.error.empty() ? std::string("done") : answer.error));
    });
  }
  EXPECT_THAT(ends, ::testing::ElementsAre("second: overtaken by a newer one"));
  EXPECT_EQ(background_.jobs[Lane::measures], 1);
  background_.work();
  EXPECT_EQ(background_.jobs[Lane::measures], 2);
  EXPECT_EQ(ends.back(), "third: done");
}

TEST_F(MeasuredArm, IsNotThereWhereTheCameraLooksAway) {
  ask(HeadRequest{"front", 1.2, {}, {}});
  pass(4);
  ask(AckRequest{"front", static_cast<unsigned char>(last_image(me, 1)[4])});
  pass(0.1);
  const ViewAnswer answer = ask(MeasureRequest{"front", {}});
  EXPECT_FALSE(*answer.result.find("found")->as<bool>());
  EXPECT_NE(*answer.result.find("reason")->as<std::string>(), "");
  EXPECT_TRUE(answer.result.find("layers")->as<Node::Array>()->empty());
}

// The arm is believed to stand where its way is free.
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

class LaboratoryArm : public LiveSessionTest {
 protected:
  LaboratoryArm()
      : LiveSessionTest(
            read_text_file(FLEXURA_SOURCE_DIR "/examples/02_laboratory_arm/experiment.toml", 1 << 20)) {}
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
