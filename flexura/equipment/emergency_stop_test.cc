// The emergency stop acts whatever state a controller is in: its messages reach the simulated devices in
// every state, and at random moments. Afterwards no motor moves, and no queued motion is left.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/grbl_config.h"
#include "flexura/equipment/grbl_device.h"
#include "tests/support/cia402_loop.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A board and its time, which only the test moves on.
struct StoppedGrbl {
  void wait(double duration) {
    for (const double end = now + duration; now < end;) {
      now = std::min(end, now + 0.005);
      (void)device.advance(now);
    }
  }
  void send(std::string_view bytes, double duration = 0.01) {
    (void)device.receive(bytes, now);
    wait(duration);
  }
  // As the guard does. `braked`: called after the first messages and their delay.
  void stop(const StopMessages& stop, const std::function<void()>& braked = [] {}) {
    for (const std::string& message : stop.first) send(message, 0);
    wait(stop.delay);
    braked();
    for (const std::string& message : stop.then) send(message, 0);
  }
  GrblDevice device;
  double now = 0;
};

// Checks that no motor moves within the next seconds. A motor whose pulses stop at speed turns on a little.
void expect_rest(StoppedGrbl& bench, double overrun) {
  bench.wait(overrun);
  const auto resting = bench.device.positions(bench.now);
  for (int i = 0; i < 50; ++i) {
    bench.wait(0.1);
    ASSERT_EQ(bench.device.positions(bench.now), resting) << "after " << 0.1 * (i + 1) << " s";
  }
}

// A board with limit switches that homes, and that brakes from 200 mm/s within 0.2 s.
GrblDeviceConfig homing_board(bool is_grblhal) {
  GrblDeviceConfig board{.is_grblhal = is_grblhal, .settings = {{22, 1}, {23, 2}, {24, 300}, {25, 3000}}};
  board.low = {-9000, -4000, -9000};
  board.high = {3000, 9000, 5000};
  board.boot_time = 0.5;
  return board;
}

struct GrblSituation {
  std::string name;
  GrblState state;  // That it reaches.
  std::function<void(StoppedGrbl&)> reach;
  bool brakes = true;  // Whether the hold already stops the motors.
};

// Whatever the state at power-on: the board is unlocked first.
const std::vector<GrblSituation>& grbl_situations() {
  static const std::vector<GrblSituation> all = {
      {"idle", GrblState::idle, [](StoppedGrbl&) {}},
      {"a motion", GrblState::run, [](StoppedGrbl& board) { board.send("G1X25F6000\n", 0.1); }},
      {"a jog", GrblState::jog, [](StoppedGrbl& board) { board.send("$J=G90X25F6000\n", 0.1); }},
      {"a jog that is being canceled", GrblState::jog,
       [](StoppedGrbl& board) {
         board.send("$J=G90X25F6000\n", 0.1);
         board.send("\x85", 0.01);
       }},
      {"full buffers and half a line", GrblState::run,
       [](StoppedGrbl& board) {
         std::string lines;
         for (int i = 0; i < 23; ++i) lines += i % 2 == 0 ? "G1X9F60\n" : "G1X0\n";
         board.send(lines.substr(0, lines.size() - 3), 0.1);
       }},
      {"a hold that brakes", GrblState::hold,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\n", 0.1);
         board.send("!", 0.005);
       }},
      {"a hold that rests", GrblState::hold,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\nG1X0\n", 0.1);
         board.send("!", 0.5);
       }},
      {"a hold that has just ended", GrblState::run,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\n", 0.1);
         board.send("!", 0.3);
         board.send("~", 0.02);
       }},
      {"a dwell before a motion", GrblState::idle,
       [](StoppedGrbl& board) { board.send("G4P0.4\nG1X25F6000\n", 0.1); }},
      {"homing towards a switch", GrblState::home, [](StoppedGrbl& board) { board.send("$H\n", 0.2); },
       false},
      {"homing away from a switch", GrblState::home, [](StoppedGrbl& board) { board.send("$H\n", 1.1); },
       false},
      {"an alarm", GrblState::alarm, [](StoppedGrbl& board) { board.device.raise_alarm(2, board.now); }},
      {"an alarm in mid-motion", GrblState::alarm,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\nG1X0\n", 0.1);
         board.device.raise_alarm(1, board.now);
       }},
      {"a reset in mid-motion", GrblState::alarm,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\n", 0.1);
         board.send("\x18", 0.01);
       }},
      {"a start", GrblState::alarm, [](StoppedGrbl& board) { board.device.restart(board.now); }},
      {"a start in mid-motion", GrblState::alarm,
       [](StoppedGrbl& board) {
         board.send("G1X25F6000\n", 0.1);
         board.device.restart(board.now);
       }},
      {"check mode", GrblState::check, [](StoppedGrbl& board) { board.send("$C\nG1X25F6000\n", 0.1); }},
  };
  return all;
}

TEST(EmergencyStop, StopsGrblInEveryState) {
  const StopMessages stop = grbl_stop({});
  for (const bool is_grblhal : {false, true}) {
    for (const GrblSituation& situation : grbl_situations()) {
      SCOPED_TRACE((is_grblhal ? "grblHAL, " : "Grbl, ") + situation.name);
      StoppedGrbl board{GrblDevice(homing_board(is_grblhal))};
      board.wait(1);
      board.send("$X\n", 0.1);
      situation.reach(board);
      EXPECT_EQ(board.device.state(), situation.state);
      std::vector<double> braked;
      board.stop(stop, [&] { braked = board.device.positions(board.now); });
      expect_rest(board, 0.01);
      if (situation.brakes) {
        EXPECT_EQ(board.device.positions(board.now), braked) << "the reset lost steps";
      }
      EXPECT_TRUE(board.device.state() == GrblState::idle || board.device.state() == GrblState::alarm);
      // Nothing of the old lines is left: after unlocking, the next line is the next motion.
      board.send("$X\n", 0.1);
      expect_rest(board, 0);
    }
  }
}

// Lines and realtime bytes that a program may have sent at random times, and pieces of them.
TEST(EmergencyStop, StopsGrblAtRandomMoments) {
  const StopMessages stop = grbl_stop({});
  const std::vector<std::string> parts = {
      "G1X9F6000\n", "G1X0Y5F3000\n", "$J=G90X20F6000\n", "$H\n", "!",    "~",  "\x85",   "?",
      "\x18",        "$X\n",          "G4P0.2\n",         "$C\n", "G0X1", "\n", "G92X0\n"};
  for_random_cases(300, [&](TestRandom& random) {
    StoppedGrbl board{GrblDevice(homing_board(random.integer(0, 1) == 1))};
    board.wait(1);
    board.send("$X\n", 0.1);
    for (int i = random.integer(1, 30); i > 0; --i) {
      const auto& part =
          parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(parts.size()) - 1))];
      board.send(part, random.uniform(0, 1) < 0.7 ? 0 : random.uniform(0, 0.6));
      if (random.uniform(0, 1) < 0.03) board.device.raise_alarm(random.integer(1, 2), board.now);
    }
    board.stop(stop);
    expect_rest(board, 0.01);
  });
}

CanFrame target_frame(std::uint16_t word, std::int32_t target) {
  CanFrame frame{.id = cob::rpdo1 + 1};
  append(frame, word, 2);
  append(frame, static_cast<std::uint32_t>(target), 4);
  return frame;
}

// Reaches states of the first of two drives beyond those that the driver's own tests have.
TEST(EmergencyStop, StopsCanDrivesInEveryState) {
  const std::vector<std::pair<std::string, std::function<void(Cia402Bench&)>>> situations = {
      {"drives that nobody has started", [](Cia402Bench&) {}},
      {"drives at rest", [](Cia402Bench& bench) { ASSERT_TRUE(bench.drive.start()); }},
      {"a motion",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 2));
         bench.bus.pass(0.5);
       }},
      {"a motion whose halt brakes",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 0.5));
         bench.bus.pass(0.2);
         (void)bench.device.receive(bytes_of(target_frame(control_word::enable | control_word::halt, 4000)),
                                    bench.clock.time);
         (void)bench.device.receive(bytes_of(sync_frame()), bench.clock.time);
       }},
      {"a setpoint that waits for a SYNC",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         (void)bench.device.receive(
             bytes_of(
                 target_frame(control_word::enable | control_word::start | control_word::immediately, 3000)),
             bench.clock.time);
       }},
      {"one drive that has failed and one that moves",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 2));
         bench.bus.pass(0.5);
         bench.device.node(0).fail(0x2310, bench.clock.time);
       }},
      {"one drive that was restarted and one that moves",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 2));
         bench.bus.pass(0.5);
         bench.device.node(0).restart();
       }},
      {"homing",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         // Profile of the driver's own homing: mode 6, then start.
         for (std::uint8_t node = 1; node <= 2; ++node) {
           const auto write = [&](std::uint16_t index, std::uint8_t sub, std::uint32_t value, int size) {
             (void)bench.device.receive(
                 bytes_of(SdoTransfer::writing(node, {index, sub}, value, size).request()), bench.clock.time);
           };
           write(0x6060, 0, 6, 1);
           write(0x6098, 0, 21, 1);
           write(0x6099, 1, 100, 4);
           write(0x6099, 2, 50, 4);
           write(0x609A, 0, 1000, 4);
           write(0x6040, 0, control_word::enable | control_word::start, 2);
         }
         bench.bus.pass(0.3);
         ASSERT_TRUE(bench.device.node(0).is_moving(bench.clock.time)) << "homing";
       }},
      {"nodes that are stopped",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 2));
         bench.bus.pass(0.5);
         (void)bench.device.receive(bytes_of(nmt_frame(NmtCommand::stop, 0)), bench.clock.time);
       }},
      {"a quick stop that brakes",
       [](Cia402Bench& bench) {
         ASSERT_TRUE(bench.drive.start());
         ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 0.5));
         bench.bus.pass(0.2);
         (void)bench.device.receive(bytes_of(target_frame(control_word::quick_stop, 0)), bench.clock.time);
       }},
  };
  for (const auto& [name, reach] : situations) {
    SCOPED_TRACE(name);
    Cia402Bench bench(2);
    reach(bench);
    if (testing::Test::HasFatalFailure()) return;
    const StopMessages stop = cia402_stop(bench.config);
    for (const std::string& message : stop.first) (void)bench.device.receive(message, bench.clock.time);
    bench.bus.pass(stop.delay);
    const std::vector<double> braked = bench.positions();
    for (const std::string& message : stop.then) (void)bench.device.receive(message, bench.clock.time);
    for (int i = 0; i < 50; ++i) {
      // Frames of the dead program that the interface still sends move nothing either.
      (void)bench.device.receive(bytes_of(sync_frame()), bench.clock.time);
      bench.bus.pass(0.1);
      ASSERT_EQ(bench.positions(), braked) << "after " << 0.1 * (i + 1) << " s";
    }
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NE(bench.device.node(i).state(), DriveState::operation_enabled);
  }
}

}  // namespace
}  // namespace flexura
