#include "flexura/equipment/visca_head.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "flexura/base/degree.h"
#include "flexura/equipment/guard.h"
#include "flexura/equipment/visca_device.h"
#include "tests/support/visca_wire.h"

namespace flexura {
namespace {

ViscaConfig visca_config(ViscaFraming framing = ViscaFraming::stream) {
  ViscaConfig config;
  config.bus.link = "/dev/head@9600";
  config.bus.framing = framing;
  config.zoom.positions = {1, 10};
  return config;
}

// Heads on a wire, with time that passes only while the driver waits.
struct ViscaBench {
  explicit ViscaBench(const ViscaConfig& with = visca_config(), const ViscaHeadModel& model = {},
                      std::size_t heads = 1)
      : config(with), device(visca_framing(with.bus)) {
    for (std::size_t i = 0; i < heads; ++i) device.add(model);
    auto made = std::make_unique<ViscaWire>(device);
    wire = made.get();
    bus = std::make_shared<ViscaBus>(std::move(made), config.bus, [this] { return wire->time; });
    head = std::make_unique<ViscaHead>(bus, config);
  }
  [[nodiscard]] std::string start() const {
    if (const auto fault = bus->start().fault()) return fault->what;
    if (const auto fault = head->start().fault()) return fault->what;
    return {};
  }
  // Reads until the head stands, for at most `most` s. Returns the message of a fault.
  [[nodiscard]] std::string settle(ViscaHead& one, double most = 60) const {
    for (const double end = wire->time + most; wire->time < end; wire->pass(0.05)) {
      const auto read = one.read();
      if (!read) return read.fault()->what;
      if (!read.value().moving) return {};
    }
    return "still moves";
  }
  [[nodiscard]] std::string settle() const { return settle(*head); }
  [[nodiscard]] std::string command(const HeadState& state) const {
    const auto fault = head->command(state).fault();
    return fault ? fault->what : std::string();
  }
  SteadyViscaMotors& motors() { return dynamic_cast<SteadyViscaMotors&>(device.motors(0)); }

  ViscaConfig config;
  ViscaDevice device;
  ViscaWire* wire = nullptr;
  std::shared_ptr<ViscaBus> bus;
  std::unique_ptr<ViscaHead> head;
};

constexpr HeadState visca_target{40 * degree, 20 * degree, 5.5};
// Of visca_target, by the default configuration.
constexpr ViscaCounts visca_target_counts{-576, 288, 0x2000};

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

class ViscaFramings : public testing::TestWithParam<ViscaFraming> {};
INSTANTIATE_TEST_SUITE_P(All, ViscaFramings,
                         testing::Values(ViscaFraming::stream, ViscaFraming::datagram, ViscaFraming::sony),
                         [](const auto& one) { return name_of(one.param); });

TEST_P(ViscaFramings, MovesAndReportsThePosition) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  EXPECT_FALSE(bench.head->read().value().moving);
  ASSERT_EQ(bench.command(visca_target), "");
  EXPECT_TRUE(bench.head->read().value().moving);
  ASSERT_EQ(bench.settle(), "");
  const HeadReading reading = bench.head->read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_NEAR(reading.state.pan, visca_target.pan, 1e-9);
  EXPECT_NEAR(reading.state.tilt, visca_target.tilt, 1e-9);
  EXPECT_NEAR(reading.state.zoom, visca_target.zoom, 1e-9);
  EXPECT_EQ(bench.device.counts(0, bench.wire->time), visca_target_counts);
  EXPECT_EQ(bench.device.moves(), 2U);
}

TEST_P(ViscaFramings, ACommandReplacesThePreviousOne) {
  for (const auto overlap : {ViscaHeadModel::Overlap::replaces, ViscaHeadModel::Overlap::is_refused}) {
    ViscaHeadModel model;
    model.overlap = overlap;
    ViscaBench bench(visca_config(GetParam()), model);
    ASSERT_EQ(bench.start(), "");
    // Far more commands than sockets.
    for (int i = 0; i < 12; ++i) {
      ASSERT_EQ(bench.command({(100 - 20 * i) * degree, 5 * i * degree, 1 + 0.5 * (i % 7)}), "") << i;
      bench.wire->pass(0.1);
      ASSERT_TRUE(bench.head->read()) << i;
    }
    ASSERT_EQ(bench.command(visca_target), "");
    ASSERT_EQ(bench.settle(), "");
    EXPECT_EQ(bench.device.counts(0, bench.wire->time), visca_target_counts);
  }
}

TEST_P(ViscaFramings, HaltStopsAndForgetsTheTarget) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  for (int i = 0; i < 3; ++i) {  // Fills the sockets.
    ASSERT_EQ(bench.command({(90 + i) * degree, 60 * degree, 9.0 - i}), "");
    bench.wire->pass(0.1);
  }
  ASSERT_TRUE(bench.device.is_moving(0, bench.wire->time));
  ASSERT_TRUE(bench.head->halt());
  EXPECT_FALSE(bench.device.is_moving(0, bench.wire->time));
  EXPECT_EQ(bench.settle(), "");
  const ViscaCounts at = bench.device.counts(0, bench.wire->time);
  EXPECT_EQ(bench.head->counts(), at);
  EXPECT_GT(at.pan, -1296);
}

TEST_P(ViscaFramings, TheStopMessagesOfTheGuardStop) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({90 * degree, 60 * degree, 9}), "");
  const StopMessages stop = visca_stop(bench.config);
  EXPECT_LE(stop.first.size() + stop.then.size(), Guard::most_messages);
  for (const std::string& message : stop.first) (void)bench.device.receive(message, bench.wire->time);
  EXPECT_FALSE(bench.device.is_moving(0, bench.wire->time));
  for (const std::string& message : stop.then) (void)bench.device.receive(message, bench.wire->time + 0.2);
  // Later commands move it again, whatever the sequence numbers are.
  ASSERT_TRUE(bench.head->halt());
  ASSERT_EQ(bench.command(visca_target), "");
  EXPECT_EQ(bench.settle(), "");
}

// A program may die in the middle of a packet, with all sockets of the head in use.
TEST_P(ViscaFramings, TheStopMessagesStopAHeadThatIsBusy) {
  for (const bool is_cut : {false, true}) {
    ViscaBench bench(visca_config(GetParam()));
    ASSERT_EQ(bench.start(), "");
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(bench.command({(90 + i) * degree, 60 * degree, 9.0 - i}), "");
      bench.wire->pass(0.1);
    }
    ASSERT_TRUE(bench.device.is_moving(0, bench.wire->time));
    if (is_cut) (void)bench.device.receive("\x81\x01\x06", bench.wire->time);
    const StopMessages stop = visca_stop(bench.config);
    for (const std::string& message : stop.first) (void)bench.device.receive(message, bench.wire->time);
    bench.wire->pass(stop.delay);
    for (const std::string& message : stop.then) (void)bench.device.receive(message, bench.wire->time);
    const ViscaCounts resting = bench.device.counts(0, bench.wire->time);
    for (int i = 0; i < 20; ++i) {
      bench.wire->pass(0.2);
      ASSERT_EQ(bench.device.counts(0, bench.wire->time), resting);
    }
  }
}

TEST_P(ViscaFramings, ASilentHeadIsLostAndFoundAgain) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  bench.wire->is_silent = true;
  EXPECT_TRUE(contains(bench.command(visca_target), "no answer")) << bench.command(visca_target);
  EXPECT_EQ(bench.head->read().fault()->kind, FaultKind::link_lost);
  EXPECT_FALSE(bench.head->halt());
  bench.wire->is_silent = false;
  EXPECT_EQ(bench.command(visca_target), "");
  EXPECT_EQ(bench.settle(), "");
}

TEST_P(ViscaFramings, AHeadThatWasSwitchedOffAndOnIsUsedAgain) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({90 * degree, 60 * degree, 9}), "");
  bench.device.restart(bench.wire->time);
  bench.wire->pass(0.1);
  std::string problem = bench.command(visca_target);
  if (!problem.empty()) problem = bench.command(visca_target);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(bench.settle(), "");
}

TEST_P(ViscaFramings, AnAlarmInMidMoveEndsAtTheTargetOrWithAMessage) {
  ViscaBench bench(visca_config(GetParam()));
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({90 * degree, 60 * degree, 9}), "");
  bench.wire->pass(0.3);
  bench.device.fail(0, ViscaError::not_executable, bench.wire->time);
  EXPECT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.head->counts()->pan, -1296);
  // For good: the axis is blocked.
  ASSERT_EQ(bench.command({}), "");
  bench.wire->pass(0.3);
  bench.motors().block(ViscaMotors::pan, true, bench.wire->time);
  bench.device.fail(0, ViscaError::not_executable, bench.wire->time);
  const std::string problem = bench.settle();
  EXPECT_TRUE(contains(problem, "accepted a move to pan")) << problem;
  EXPECT_TRUE(contains(problem, "stands at")) << problem;
  EXPECT_EQ(bench.head->read().fault()->kind, FaultKind::refused) << "until the next command";
  bench.motors().block(ViscaMotors::pan, false, bench.wire->time);
  EXPECT_EQ(bench.command({}), "");
  EXPECT_EQ(bench.settle(), "");
}

TEST_P(ViscaFramings, AHeadThatAcceptsAndDoesNothingIsReported) {
  ViscaHeadModel model;
  model.obeys = false;
  ViscaBench bench(visca_config(GetParam()), model);
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command(visca_target), "");
  const std::string problem = bench.settle();
  EXPECT_TRUE(contains(problem, "/dev/head, VISCA head 1: accepted a move to pan 40.00 deg")) << problem;
  EXPECT_EQ(problem.find('\n'), std::string::npos);
  ASSERT_TRUE(bench.head->halt());
  EXPECT_TRUE(bench.head->read());
}

TEST_P(ViscaFramings, HeadsMayOmitAnswers) {
  ViscaConfig config = visca_config(GetParam());
  config.bus.reply_timeout = 5;  // Longer than the move, whose end is the only answer of the second head.
  ViscaHeadModel without_end, without_acceptance, quick;
  without_end.reports_end = false;
  without_acceptance.reports_acceptance = false;
  quick.reply_delay = 0;
  for (const ViscaHeadModel& model : {without_end, without_acceptance, quick}) {
    ViscaBench bench(config, model);
    ASSERT_EQ(bench.start(), "");
    EXPECT_EQ(bench.command(visca_target), "");
    EXPECT_EQ(bench.settle(), "");
    EXPECT_EQ(bench.command({}), "");
    EXPECT_EQ(bench.settle(), "");
    EXPECT_EQ(bench.device.counts(0, bench.wire->time), (ViscaCounts{0, 0, 0}));
  }
}

TEST(ViscaHead, RefusesNumbersThatAreNotFiniteAndClampsOthers) {
  ViscaBench bench;
  ASSERT_EQ(bench.start(), "");
  EXPECT_EQ(bench.head->command({NAN, 0, 1}).fault()->kind, FaultKind::refused);
  EXPECT_EQ(bench.head->command({0, INFINITY, 1}).fault()->kind, FaultKind::refused);
  EXPECT_EQ(bench.device.moves(), 0U);
  ASSERT_EQ(bench.command({50, -50, 50}), "");
  ASSERT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.head->counts(), (ViscaCounts{-2448, -432, 0x4000}));
}

TEST(ViscaHead, AHeadInStandbyRefusesMoves) {
  ViscaHeadModel model;
  model.is_on = false;
  ViscaBench bench(visca_config(), model);
  ASSERT_EQ(bench.start(), "");
  EXPECT_EQ(
      bench.command(visca_target),
      "/dev/head, VISCA head 1: refuses a move (not executable): switch it on, close its menu, and check "
      "that nothing blocks it");
}

TEST(ViscaHead, WrongNumbersOfDigitsAreReported) {
  ViscaHeadModel model;
  model.digits = {5, 4};
  ViscaBench bench(visca_config(), model);
  EXPECT_EQ(
      bench.start(),
      "/dev/head, VISCA head 1: answers with 9 bytes of data instead of 8: set pan.digits and tilt.digits "
      "as in its manual");
}

TEST(ViscaHead, FiveDigitsWork) {
  ViscaHeadModel model;
  model.digits = {5, 4};
  model.lowest = {-0x8A58, -0x186A, 0}, model.highest = {0x8A58, 0x493D, 0x4000};
  ViscaConfig config = visca_config();
  config.pan.digits = 5;
  config.pan.counts_per_degree = 208.35;  // 8A58h at 170 degrees to the left.
  config.pan.limits = {-0x8A58, 0x8A58};
  config.tilt.counts_per_degree = 208.35;
  config.tilt.limits = {-0x186A, 0x493D};
  config.tilt.speed = 0;
  ViscaBench bench(config, model);
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({-160 * degree, 80 * degree, 2}), "");
  ASSERT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.head->counts()->pan, -33336);
  EXPECT_NEAR(bench.head->read().value().state.pan, -160 * degree, 1e-4);
}

TEST(ViscaHead, AMissingHeadOfAChainIsReported) {
  ViscaConfig config = visca_config();
  config.address = 2;
  ViscaBench bench(config);
  EXPECT_EQ(bench.start(), "/dev/head, VISCA head 2: only 1 heads are on the chain");
}

TEST(ViscaHead, ABrokenLinkIsReportedAtOnce) {
  ViscaBench bench;
  ASSERT_EQ(bench.start(), "");
  bench.wire->is_broken = true;
  EXPECT_EQ(bench.command(visca_target), "/dev/head, VISCA head 1: Input/output error");
  EXPECT_FALSE(bench.head->read());
  EXPECT_FALSE(bench.head->halt());
}

TEST(ViscaHead, TwoHeadsShareAChain) {
  ViscaBench bench(visca_config(), {}, 2);
  ASSERT_EQ(bench.start(), "");
  ViscaConfig config = visca_config();
  config.address = 2;
  ViscaHead second(bench.bus, config);
  ASSERT_TRUE(second.start());
  ASSERT_EQ(bench.command(visca_target), "");
  ASSERT_TRUE(second.command({-10 * degree, 5 * degree, 2}));
  EXPECT_TRUE(bench.device.is_moving(0, bench.wire->time) && bench.device.is_moving(1, bench.wire->time));
  EXPECT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.settle(second), "");
  EXPECT_EQ(bench.device.counts(0, bench.wire->time), visca_target_counts);
  EXPECT_EQ(bench.device.counts(1, bench.wire->time), (ViscaCounts{144, 72, 1820}));
}

TEST(ViscaHead, APersonMayMoveTheHead) {
  ViscaBench bench;
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command(visca_target), "");
  ASSERT_EQ(bench.settle(), "");
  bench.motors().go(ViscaMotors::pan, 300, 1, bench.wire->time);
  bench.wire->pass(0.1);
  EXPECT_TRUE(bench.head->read().value().moving);
  bench.wire->pass(10);
  EXPECT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.head->counts()->pan, 300);
  // The same command moves it back.
  ASSERT_EQ(bench.command(visca_target), "");
  EXPECT_EQ(bench.settle(), "");
  EXPECT_EQ(bench.device.counts(0, bench.wire->time), visca_target_counts);
}

}  // namespace
}  // namespace flexura
