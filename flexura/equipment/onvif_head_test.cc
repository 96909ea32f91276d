#include "flexura/equipment/onvif_head.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/names.h"
#include "tests/support/onvif_wire.h"

namespace flexura {
namespace {

constexpr HeadState onvif_target{-45 * degree, 30 * degree, 0.5};

bool says(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// Whatever happens, a message has one line and no credentials.
void expect_clean(const std::string& message) {
  EXPECT_NE(message, "");
  EXPECT_FALSE(says(message, "\n")) << message;
  EXPECT_FALSE(says(message, "secret")) << message;
  EXPECT_TRUE(message.starts_with("tcp:camera:80, ONVIF head: ")) << message;
}

class OnvifSpaces : public testing::TestWithParam<OnvifPositions> {};
INSTANTIATE_TEST_SUITE_P(All, OnvifSpaces, testing::Values(OnvifPositions::generic, OnvifPositions::degrees),
                         [](const auto& one) { return name_of(one.param); });

TEST_P(OnvifSpaces, MovesAndReportsThePosition) {
  OnvifConfig config = OnvifBench::usual();
  config.space = GetParam();
  for (const bool reports_motion : {true, false}) {
    OnvifModel model;
    model.reports_degrees = GetParam() == OnvifPositions::degrees;
    model.reports_motion = reports_motion;
    OnvifBench bench(config, model);
    ASSERT_EQ(bench.start(), "");
    EXPECT_FALSE(bench.head.read().value().moving);
    ASSERT_EQ(bench.command(onvif_target), "");
    EXPECT_TRUE(bench.head.read().value().moving);
    ASSERT_EQ(bench.settle(), "");
    const HeadReading reading = bench.head.read().value();
    EXPECT_FALSE(reading.moving);
    // Reported with five digits.
    EXPECT_NEAR(reading.state.pan, onvif_target.pan, 0.002 * degree);
    EXPECT_NEAR(reading.state.tilt, onvif_target.tilt, 0.002 * degree);
    EXPECT_NEAR(reading.state.zoom, onvif_target.zoom, 1e-4);
    const OnvifPlace at = bench.device.place(bench.wire.time);
    EXPECT_NEAR(at.pan, 0.25, 1e-5) << "the camera's right";
    EXPECT_NEAR(at.tilt, 1.0 / 3, 1e-5);
    EXPECT_EQ(bench.device.executed("AbsoluteMove"), 1U);
    EXPECT_EQ(bench.wire.connections, 1) << "one kept connection";
  }
}

TEST(OnvifHead, ACommandReplacesThePreviousOne) {
  OnvifBench bench;
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({170 * degree, 0, 1}), "");
  bench.wire.pass(0.2);
  ASSERT_EQ(bench.command(onvif_target), "");
  ASSERT_EQ(bench.settle(), "");
  EXPECT_NEAR(bench.device.place(bench.wire.time).pan, 0.25, 1e-5);
}

TEST(OnvifHead, HaltStopsAndForgetsTheTarget) {
  OnvifBench bench;
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({-170 * degree, 80 * degree, 1}), "");
  bench.wire.pass(0.3);
  ASSERT_TRUE(bench.device.is_moving(bench.wire.time));
  ASSERT_EQ(bench.halt(), "");
  EXPECT_FALSE(bench.device.is_moving(bench.wire.time));
  ASSERT_EQ(bench.settle(), "");
  EXPECT_LT(bench.device.place(bench.wire.time).pan, 0.5);
  EXPECT_GT(bench.device.place(bench.wire.time).pan, 0.05);
}

// The answer to the move arrives after the halt was sent, over its own connection.
TEST(OnvifHead, AHaltDuringACommandWins) {
  OnvifModel model;
  model.reply_delay = 0.5;
  OnvifBench bench(OnvifBench::usual(), model);
  ASSERT_EQ(bench.start(), "");
  bool is_halted = false;
  bench.wire.on_wait = [&](double) {
    if (std::exchange(is_halted, true)) return;
    EXPECT_EQ(bench.halt(), "");
  };
  const std::string problem = bench.command(onvif_target);
  EXPECT_TRUE(says(problem, "replaced by a halt")) << problem;
  EXPECT_FALSE(bench.device.is_moving(bench.wire.time));
  EXPECT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.device.executed("Stop"), 2U) << "once more, since the move may have come after the halt";
}

TEST(OnvifHead, AHeadThatAcceptsAndDoesNothingIsReported) {
  OnvifModel model;
  model.obeys = false;
  OnvifBench bench(OnvifBench::usual(), model);
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command(onvif_target), "");
  const std::string problem = bench.settle();
  expect_clean(problem);
  EXPECT_TRUE(says(problem, "accepted a move to pan -45.00 deg, tilt 30.00 deg")) << problem;
  EXPECT_EQ(bench.device.executed("AbsoluteMove"), 3U);
  EXPECT_EQ(bench.head.read().fault()->kind, FaultKind::refused) << "until the next command";
  bench.device.model().obeys = true;
  ASSERT_EQ(bench.command(onvif_target), "");
  EXPECT_EQ(bench.settle(), "");
}

TEST(OnvifHead, AnObstacleIsOvercomeOrReported) {
  OnvifBench bench;
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({-170 * degree, 0, 0}), "");
  bench.wire.pass(0.3);
  bench.device.block(true, bench.wire.time);
  for (int i = 0; i < 10; ++i, bench.wire.pass(0.1)) ASSERT_TRUE(bench.head.read().value().moving);
  bench.device.block(false, bench.wire.time);
  EXPECT_EQ(bench.settle(), "") << "commanded again";
  EXPECT_NEAR(bench.device.place(bench.wire.time).pan, 17.0 / 18, 1e-5);
  ASSERT_EQ(bench.command({}), "");
  bench.wire.pass(0.3);
  bench.device.block(true, bench.wire.time);
  EXPECT_TRUE(says(bench.settle(), "but stands at"));
}

TEST(OnvifHead, RefusalsAreOneLine) {
  OnvifModel model;
  model.refuses = true;
  OnvifBench bench(OnvifBench::usual(), model);
  ASSERT_EQ(bench.start(), "");
  const std::string problem = bench.command(onvif_target);
  expect_clean(problem);
  EXPECT_EQ(
      problem,
      "tcp:camera:80, ONVIF head: AbsoluteMove: the head refuses: \"MovingPTZ: The head\\ncannot move now\"");
  EXPECT_EQ(bench.head.command({NAN, 0, 0}).fault()->kind, FaultKind::refused);
  EXPECT_EQ(bench.head.command({0, 0, INFINITY}).fault()->kind, FaultKind::refused);
  EXPECT_EQ(bench.device.executed("AbsoluteMove"), 0U);
}

TEST(OnvifHead, PositionsOutsideTheRangeAreClamped) {
  OnvifConfig config = OnvifBench::usual();
  config.pan.limits = {-0.5, 0.75};
  OnvifBench bench(config);
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({50, -50, 50}), "");
  ASSERT_EQ(bench.settle(), "");
  const OnvifPlace at = bench.device.place(bench.wire.time);
  EXPECT_NEAR(at.pan, -0.5, 1e-6);
  EXPECT_NEAR(at.tilt, -1, 1e-6);
  EXPECT_NEAR(at.zoom.value(), 1, 1e-6);
}

TEST(OnvifHead, UsesGetCapabilitiesOfOlderCameras) {
  OnvifModel model;
  model.has_services = false;
  OnvifBench bench(OnvifBench::usual(), model);
  EXPECT_EQ(bench.start(), "");
}

TEST(OnvifHead, AHeadWithoutAZoomIsTurnedOnly) {
  OnvifModel model;
  model.has_zoom = false;
  OnvifBench bench(OnvifBench::usual(), model);
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command(onvif_target), "");
  ASSERT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.head.read().value().state.zoom, 0);
}

TEST(OnvifHead, WrongConfigurationsAreNamedAtTheStart) {
  const auto started = [](auto change) {
    OnvifConfig config = OnvifBench::usual();
    OnvifModel model;
    change(config, model);
    OnvifBench bench(config, model);
    const std::string problem = bench.start();
    expect_clean(problem);
    EXPECT_EQ(bench.device.executed("AbsoluteMove"), 0U);
    return problem;
  };
  using Config = OnvifConfig;
  using Model = OnvifModel;
  EXPECT_TRUE(says(started([](Config& c, Model&) { c.profile = "other"; }),
                   "no media profile \"other\" with a head; the camera has: profile_1"));
  EXPECT_TRUE(says(started([](Config& c, Model&) { c.pan.limits = {-2, 2}; }),
                   "pan.limits: -2 to 2 is outside the head's range, -1 to 1"));
  EXPECT_TRUE(says(started([](Config& c, Model&) { c.zoom.points = {0, 5}; }),
                   "zoom.points: 0 to 5 is outside the head's range, 0 to 1"));
  EXPECT_TRUE(
      says(started([](Config& c, Model& m) { c.space = OnvifPositions::degrees, m.has_degrees = false; }),
           "no absolute moves in the position space \"degrees\""));
  EXPECT_TRUE(
      says(started([](Config&, Model& m) { m.reports_degrees = true; }), "SphericalPositionSpaceDegrees"));
  EXPECT_TRUE(says(started([](Config&, Model& m) { m.wants_http_login = true; }), "allow WS-Security"));
}

TEST(OnvifHead, LoginsAreChecked) {
  OnvifBench wrong(OnvifBench::usual(), {}, "wrong");
  const std::string problem = wrong.start();
  expect_clean(problem);
  EXPECT_TRUE(says(problem, "the login is refused: check user, password_file")) << problem;
  EXPECT_FALSE(says(problem, "wrong")) << problem;
  OnvifConfig open = OnvifBench::usual();
  open.user.clear(), open.password_file.clear();
  OnvifBench without(open);
  EXPECT_TRUE(says(without.start(), "a login is required: set user and password_file"));
  OnvifModel model;
  model.user.clear();
  OnvifBench none(open, model);
  EXPECT_EQ(none.start(), "");
  for (const std::string& message : none.wire.written) EXPECT_FALSE(says(message, "Security"));
}

// The camera's clock is wrong by years, and is set during the work.
TEST(OnvifHead, SignaturesFollowTheCamerasClock) {
  OnvifModel model;
  model.epoch = 1e6;
  OnvifBench bench(OnvifBench::usual(), model);
  ASSERT_EQ(bench.start(), "");
  bench.device.model().epoch = 1.8e9;
  EXPECT_EQ(bench.command(onvif_target), "");
  EXPECT_EQ(bench.settle(), "");
  for (const std::string& message : bench.wire.written) EXPECT_FALSE(says(message, "secret"));
}

TEST(OnvifDevice, RefusesReplayedAndOldSignatures) {
  OnvifBench bench;
  ASSERT_EQ(bench.start(), "");
  const auto asks = [&](const std::string& text) {
    OnvifStream stream(bench.device);
    return stream.receive(text, bench.wire.time).front().bytes;
  };
  const std::string request = bench.head.stop_request();
  EXPECT_TRUE(says(asks(request), "StopResponse"));
  EXPECT_TRUE(says(asks(request), "NotAuthorized")) << "replayed";
  const std::string late = bench.head.stop_request();
  bench.wire.pass(20);
  EXPECT_TRUE(says(asks(late), "NotAuthorized")) << "old";
  EXPECT_TRUE(says(asks(bench.head.stop_request()), "StopResponse"));
}

TEST(OnvifHead, SharesAStopBeforeEachMove) {
  OnvifBench bench;
  ASSERT_EQ(bench.start(), "");
  std::vector<std::string> shared;
  bench.head.share_stop([&](const std::string& request) -> CommandOutcome {
    shared.push_back(request);
    return Accepted{};
  });
  ASSERT_EQ(bench.command(onvif_target), "");
  ASSERT_EQ(shared.size(), 1U);
  bench.wire.pass(0.2);
  ASSERT_TRUE(bench.device.is_moving(bench.wire.time));
  OnvifStream other(bench.device);
  EXPECT_TRUE(says(other.receive(shared[0], bench.wire.time).front().bytes, "StopResponse"));
  EXPECT_FALSE(bench.device.is_moving(bench.wire.time));
  bench.head.share_stop([](const std::string&) { return PortFault{FaultKind::refused, "no guard"}; });
  EXPECT_EQ(bench.command(onvif_target), "no guard");
  EXPECT_EQ(bench.device.executed("AbsoluteMove"), 1U);
}

}  // namespace
}  // namespace flexura
