// Positions of cameras with a stage that start elsewhere than in the model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/view/live_session.h"
#include "tests/support/experiment_files.h"
#include "tests/support/live_sessions.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

// The second camera has a stage, and starts elsewhere than in the model.
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

// Its true offset is no command: what is not commanded stays.
TEST_F(SlidingCamera, KeepsItsOtherAxesWhereTheyAre) {
  const CameraSample before = pass(0.1).cameras[1];
  EXPECT_NEAR(before.head.pan, 2 * degree, 1e-6);
  EXPECT_EQ(before.commanded_head.pan, 0);
  EXPECT_EQ(ask(HeadRequest{"side", {}, {}, 1.5}).error, "");
  EXPECT_EQ(ask(StageRequest{"side", {}, 0.2, {}}).error, "");
  const CameraSample after = pass(5).cameras[1];
  EXPECT_NEAR(after.head.pan, 2 * degree, 1e-6);
  EXPECT_EQ(after.head.tilt, before.head.tilt);
  EXPECT_NEAR(after.head.zoom, 1.5, 1e-6);
  EXPECT_EQ(after.commanded_head.pan, 0);
  EXPECT_EQ(after.commanded_head.zoom, 1.5);
  EXPECT_NEAR(after.commanded_stage.y(), 0.2, 1e-6);
  EXPECT_EQ(ask(HeadRequest{"side", 0.1, {}, {}}).error, "");
  EXPECT_NEAR(pass(5).cameras[1].head.pan, 2 * degree + 0.1, 1e-6);
  EXPECT_EQ(ask(HaltRequest{}).error, "");
  EXPECT_NEAR(pass(1).cameras[1].commanded_head.pan, 0.1, 1e-6);
}

TEST_F(SlidingCamera, SaysWhereItIsCommandedToWithinItsEnds) {
  EXPECT_EQ(ask(StageRequest{"side", {}, 7, {}}).error, "");
  EXPECT_NEAR(pass(5).cameras[1].commanded_stage.y(), 0.3, 1e-6);
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
  EXPECT_NEAR(start.cameras[1].head.pan, 2 * degree, 1e-6) << "where it truly stands";
  const CameraReading front{{0, 0, 1}, {}}, side{{0.05, -0.02, 1.5}, {{0, 0.25, 0}}};
  const std::string moved = picture(std::array{front, side});
  EXPECT_NE(moved, at_start);
  const CameraSample shown = messenger_.state(other).cameras[1];
  EXPECT_NEAR(shown.head.pan, 2 * degree + 0.05, 1e-6) << "from where it started";
  EXPECT_NEAR(shown.head.tilt, -0.02, 1e-6);
  EXPECT_NEAR(shown.head.zoom, 1.5, 1e-6);
  EXPECT_NEAR(shown.stage.y(), 0.25, 1e-6);
  EXPECT_NEAR((shown.X_WC.position - start.cameras[1].X_WC.position).norm(), 0.25, 0.01);
  EXPECT_NEAR(shown.fx, 1.5 * start.cameras[1].fx, 1e-3);
}

// Covers follow the run's clock: everything is at rest, and the page's own time differs.
class CoveredCamera : public LiveSessionTest {
 protected:
  CoveredCamera()
      : LiveSessionTest(
            viewed_text +
            "[[truth.camera]]\nname = \"side\"\nsensor.exposure = 0\nsensor.covered = [[1, 2]]\n") {}
};

TEST_F(CoveredCamera, IsDarkWhileTheRunSaysSo) {
  auto run = std::make_shared<RunLink>();
  LiveSession watched(rig_, messenger_, background_, {.start = 100, .results = {}, .run = run});
  watched.opened(other);
  const auto picture = [&](double time) {
    run->state(time, {{{0.1, 0.2}, {0.3, 0.4}}, {1, 1}}, {});
    watched.advance(clock_ += 0.1);
    HttpAnswer got;
    watched.take(ImageAsk{"side", {}}, [&](const HttpAnswer& answer) { got = answer; });
    return got.body;
  };
  const std::string before = picture(0.9), within = picture(1.5), after = picture(2.1);
  EXPECT_NE(within, before);
  EXPECT_LT(within.size(), before.size() / 2) << "of one colour";
  EXPECT_EQ(after, before);
  // A rig without a run is not dark either, whatever its clock shows.
  HttpAnswer still;
  session_.advance(clock_ = 1.5);
  session_.take(ImageAsk{"side", {}}, [&](const HttpAnswer& answer) { still = answer; });
  EXPECT_GT(still.body.size(), before.size() / 2);
}

TEST_F(SlidingCamera, IsKnownByItsReadingsAlone) {
  const CameraReading read{{0.1, 0.05, 1.2}, {{0, -0.1, 0}}};
  const CameraReading again = rig_->reading(1, rig_->stance(1, read));
  EXPECT_NEAR(again.head.pan, read.head.pan, 1e-12);
  EXPECT_NEAR(again.head.tilt, read.head.tilt, 1e-12);
  EXPECT_NEAR(again.head.zoom, read.head.zoom, 1e-12);
  EXPECT_NEAR((again.stage.offset - read.stage.offset).norm(), 0, 1e-12);
  EXPECT_FALSE(rig_->nominal_view(1, read).X_WC.rotation.isApprox(
      rig_->cameras[1].view({rig_->stance(1, read).head, read.stage}).X_WC.rotation));
  // Readings are clamped to the axis limits, whatever a log contains.
  EXPECT_LE(std::abs(rig_->stance(1, {{1e300, 0, 1e9}, {{0, -1e300, 0}}}).stage.offset.y()), 0.3);
}

// Pixels that are not square, and a principal point off the centre.
TEST(CameraSample, HasTheNumbersOfItsLensEachInItsPlace) {
  const ViewedRigPtr rig =
      viewed_rig(replaced(viewed_text, "lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }",
                          "lens = { fx = 80, fy = 90, cx = 30, cy = 20 }"));
  const CameraSample sample = camera_sample(*rig, 0, {{0.1, -0.2, 1.5}, {}});
  EXPECT_NEAR(sample.fx, 120, 1e-9);
  EXPECT_NEAR(sample.fy, 135, 1e-9);
  EXPECT_EQ(sample.cx, 30);
  EXPECT_EQ(sample.cy, 20);
  EXPECT_EQ(sample.head, (HeadState{0.1, -0.2, 1.5}));
}

}  // namespace
}  // namespace flexura
