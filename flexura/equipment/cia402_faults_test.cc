#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "flexura/equipment/wall_clock.h"
#include "tests/support/cia402_loop.h"

namespace flexura {
namespace {

// A position that a reading may report: one that the axis had within the last `age` s.
class History {
 public:
  explicit History(Cia402Bench& bench) : bench_(bench) {
    bench.bus.observer = [this] { add(); };
  }
  ~History() {
    bench_.bus.observer = [] {};
  }
  History(const History&) = delete;
  History& operator=(const History&) = delete;
  void add() { samples_.push_back({bench_.clock.time, bench_.positions()}); }
  [[nodiscard]] bool had(std::size_t axis, double value, double since, double slack) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& [time, positions] : samples_) {
      if (time < since) continue;
      low = std::min(low, positions[axis]), high = std::max(high, positions[axis]);
    }
    return value >= low - slack && value <= high + slack;
  }

 private:
  Cia402Bench& bench_;
  std::vector<std::pair<double, std::vector<double>>> samples_;
};

void run_with_faults(const LinkFaults& faults, std::uint64_t seed) {
  Cia402Bench bench(2, seed);
  ASSERT_TRUE(bench.drive.start());
  bench.bus.faults = faults;
  History history(bench);
  int good = 0;
  for (int i = 0; i < 60; ++i) {
    const double target = 100.0 * (i % 7);
    const auto commanded = bench.drive.command(std::vector{target, -target}, 0.1);
    const double asked = bench.clock.time;
    const auto reading = bench.drive.read();
    bench.bus.pass(0.1);
    if (reading) {
      ++good;
      for (std::size_t axis = 0; axis < 2; ++axis)
        EXPECT_TRUE(history.had(axis, reading.value().values[axis], asked - 0.4, 1))
            << "seed " << seed << ", round " << i << ": " << reading.value().values[axis];
    }
    for (const auto& fault : {commanded.fault(), reading.fault()})
      if (fault) {
        EXPECT_THAT(fault->what, ::testing::MatchesRegex("can:loop: [^\n]+"));
      }
    if (!commanded || !reading) (void)bench.drive.start();
  }
  EXPECT_GT(good, 10) << "seed " << seed;
  // After the faults, all is well again.
  bench.bus.faults = {};
  bench.bus.pass(1);
  const auto started = bench.drive.start();
  ASSERT_TRUE(started) << text(*started.fault());
  ASSERT_TRUE(bench.drive.command(std::vector{5.0, 6.0}, 0.1));
  bench.bus.pass(1);
  EXPECT_THAT(bench.drive.read().value().values, ::testing::ElementsAre(5, 6));
  EXPECT_THAT(bench.positions(), ::testing::ElementsAre(5, 6));
}

TEST(Cia402Faults, LostFramesAreAskedForAgain) {
  for (const std::uint64_t seed : {1, 2, 3}) run_with_faults({.lose = 0.05}, seed);
}

TEST(Cia402Faults, LateDoubledAndReorderedFramesDoNotGiveWrongPositions) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    run_with_faults({.delay = 0.2, .most_late = 0.1}, seed);
    run_with_faults({.repeat = 0.2}, seed);
    run_with_faults({.swap = 0.1}, seed);
  }
}

TEST(Cia402Faults, TruncatedFramesAreIgnored) {
  for (const std::uint64_t seed : {1, 2, 3}) run_with_faults({.cut = 0.05}, seed);
}

// Controllers check each frame's CRC, so damaged frames do not arrive. If they do, the driver survives.
TEST(Cia402Faults, DamagedFramesDoNotStopTheDriverForEver) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Cia402Bench bench(2, seed);
    ASSERT_TRUE(bench.drive.start());
    bench.bus.faults = {.lose = 0.02, .repeat = 0.02, .cut = 0.02, .damage = 0.05, .swap = 0.02};
    for (int i = 0; i < 40; ++i) {
      if (!bench.drive.command(std::vector{100.0, 10.0 * i}, 0.1) || !bench.drive.read())
        (void)bench.drive.start();
      bench.bus.pass(0.05);
    }
    (void)bench.drive.halt();
    bench.bus.faults = {};
    // A damaged frame may have changed anything in a drive.
    ASSERT_TRUE(bench.bus.write(bytes_of(nmt_frame(NmtCommand::reset_node, 0))));
    bench.bus.pass(1);
    const auto started = bench.drive.start();
    ASSERT_TRUE(started) << text(*started.fault());
    ASSERT_TRUE(bench.drive.command(std::vector{5.0, 6.0}, 0.1));
    bench.bus.pass(1);
    EXPECT_THAT(bench.drive.read().value().values, ::testing::ElementsAre(5, 6));
  }
}

bool is_target(const CanFrame& frame, bool is_new) {
  return frame.id == cob::rpdo1 + 2 && ((frame.data[0] & control_word::start) != 0) == is_new;
}

TEST(Cia402Faults, ATargetThatIsLostOnceIsSentAgain) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  int lost = 0;
  bench.bus.passes = [&](const CanFrame& frame) { return !is_target(frame, true) || lost++ > 0; };
  const auto commanded = bench.drive.command(std::vector{10.0, 20.0}, 0.1);
  ASSERT_TRUE(commanded) << text(*commanded.fault());
  bench.bus.pass(1);
  EXPECT_GE(lost, 2);
  EXPECT_THAT(bench.positions(), ::testing::ElementsAre(10, 20));
}

TEST(Cia402Faults, ATargetIsNewAlsoIfTheEndOfThePreviousOneWasLost) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{10.0, 20.0}, 0.1));
  int lost = 0;
  bool has_begun = false;
  bench.bus.passes = [&](const CanFrame& frame) {
    has_begun = has_begun || is_target(frame, true);
    return !(has_begun && is_target(frame, false)) || lost++ > 0;
  };
  ASSERT_TRUE(bench.drive.command(std::vector{30.0, 40.0}, 0.1));
  const auto commanded = bench.drive.command(std::vector{50.0, 60.0}, 0.1);
  ASSERT_TRUE(commanded) << text(*commanded.fault());
  bench.bus.pass(1);
  EXPECT_GE(lost, 2);
  EXPECT_THAT(bench.positions(), ::testing::ElementsAre(50, 60));
}

// The worst moment: the command has looked for a halt for the last time, and its target follows the quick
// stop.
TEST(Cia402Faults, AHaltStopsATargetThatIsSentAtTheSameTime) {
  Cia402Bench bench(1);
  ASSERT_TRUE(bench.drive.start());
  std::thread halter;
  std::atomic<bool> is_sent = false, has_halted = false;
  const auto mover = std::this_thread::get_id();
  bench.bus.passes = [&](const CanFrame& frame) {
    if (std::this_thread::get_id() != mover) {
      if (frame.id == cob::sync) {
        is_sent = true;
        is_sent.notify_all();
      }
      return true;
    }
    if (frame.id == cob::rpdo1 + 1 && (frame.data[0] & control_word::start) != 0 && !halter.joinable()) {
      halter = std::thread([&] {
        const auto halted = bench.drive.halt();
        EXPECT_TRUE(halted) << text(*halted.fault());
        has_halted = true;
      });
      is_sent.wait(false);
      bench.bus.pass(0.001);
    }
    return true;
  };
  EXPECT_FALSE(bench.drive.command(std::vector{4000.0}, 1));
  halter.join();
  EXPECT_TRUE(has_halted);
  EXPECT_EQ(bench.device.node(0).state(), DriveState::quick_stop_active);
  bench.bus.pass(0.1);
  const double stopped = bench.positions()[0];
  bench.bus.pass(1);
  EXPECT_EQ(bench.positions()[0], stopped);
}

// Two ends of a line that carries messages whole.
struct CanLine {
  CanLine() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw std::runtime_error("no sockets");
    host = adopt_link(Descriptor(ends[0]), "can:test"), device = adopt_link(Descriptor(ends[1]), "device");
  }
  std::unique_ptr<Link> host, device;
};

struct ServedBench {
  ServedBench()
      : config(Cia402Bench::made(2, slow())),
        device(Cia402Bench::nodes(2)),
        server(std::move(line.device), device),
        drive(*line.host, clock, config) {}
  static Cia402Config slow() {
    Cia402Config config;
    config.answer_timeout = 2;  // A busy machine is no fault.
    config.power_timeout = config.settling = 60;
    return config;
  }
  std::vector<double> positions() {
    const auto lock = server.lock();
    return device.positions(DeviceServer::now());
  }
  Cia402Config config;
  CanLine line;
  Cia402Device device;
  DeviceServer server;
  WallClock clock;
  Cia402Drive drive;
};

// Waits until the axes rest, for at most 60 s.
bool comes_to_rest(Cia402Drive& drive) {
  for (const double start = steady_seconds(); steady_seconds() < start + 60;) {
    const auto reading = drive.read();
    if (reading && !reading.value().moving) return true;
  }
  return false;
}

TEST(Cia402Served, MovesInRealTimeOverASocket) {
  ServedBench bench;
  const auto started = bench.drive.start();
  ASSERT_TRUE(started) << text(*started.fault());
  ASSERT_TRUE(bench.drive.command(std::vector{200.0, -300.0}, 0.05));
  ASSERT_TRUE(comes_to_rest(bench.drive));
  EXPECT_THAT(bench.positions(), ::testing::ElementsAre(200, -300));
}

TEST(Cia402Served, IsHaltedByAnotherThread) {
  ServedBench bench;
  ASSERT_TRUE(bench.drive.start());
  std::atomic<bool> is_over = false;
  std::thread mover([&] {
    for (int i = 0; !is_over; ++i) {
      (void)bench.drive.command(std::vector(2, i % 2 == 0 ? 4000.0 : -4000.0), 1);
      (void)bench.drive.read();
    }
  });
  for (int i = 0; i < 5; ++i) {
    bench.drive.keep_alive();
    // A halt may be interrupted by nothing, so it succeeds each time; the mover then goes on.
    const auto halted = bench.drive.halt();
    EXPECT_TRUE(halted) << text(*halted.fault());
  }
  is_over = true;
  mover.join();
  ASSERT_TRUE(bench.drive.halt());
  const auto lock = bench.server.lock();
  EXPECT_EQ(bench.device.node(0).state(), DriveState::quick_stop_active);
  EXPECT_EQ(bench.device.node(1).state(), DriveState::quick_stop_active);
}

TEST(Cia402Served, HaltInterruptsACommandThatWaits) {
  ServedBench bench;
  ASSERT_TRUE(bench.drive.start());
  bench.server.set_silent(true);
  std::atomic<bool> has_returned = false;
  std::thread waiter([&] {
    const auto commanded = bench.drive.command(std::vector(2, 100.0), 1);
    EXPECT_FALSE(commanded);
    has_returned = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  bench.server.set_silent(false);
  EXPECT_TRUE(bench.drive.halt());
  waiter.join();
  EXPECT_TRUE(has_returned);
}

TEST(Cia402Served, GuardStopsTheDrives) {
  ServedBench bench;
  ASSERT_TRUE(bench.drive.start());
  Guard guard(1000);
  guard.protect(*bench.line.host, cia402_stop(bench.config));
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0, 4000.0}, 100));
  guard.stop();
  for (const double start = steady_seconds(); steady_seconds() < start + 60;) {
    const auto lock = bench.server.lock();
    if (bench.device.node(1).nmt_state() == NmtState::stopped) break;
  }
  const auto lock = bench.server.lock();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(bench.device.node(i).state(), DriveState::quick_stop_active);
    EXPECT_EQ(bench.device.node(i).nmt_state(), NmtState::stopped);
  }
}

}  // namespace
}  // namespace flexura
