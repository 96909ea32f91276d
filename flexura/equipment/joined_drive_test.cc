#include "flexura/equipment/joined_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/grbl_drive.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

using testing::ElementsAre;

constexpr double joined_patience = 30;  // s

class Part : public DrivePort {
 public:
  explicit Part(std::size_t size, DriveQuantity quantity = DriveQuantity::motor_positions)
      : size_(size), quantity_(quantity) {}
  [[nodiscard]] DriveQuantity quantity() const override { return quantity_; }
  [[nodiscard]] std::size_t axes() const override { return size_; }
  CommandOutcome command(std::span<const double> targets, double duration) override {
    if (fails) return PortFault{FaultKind::refused, "part: broken"};
    positions.assign(targets.begin(), targets.end());
    lasts = duration;
    return Accepted{};
  }
  CommandOutcome halt() override {
    ++halts;
    return Accepted{};
  }
  Outcome<DriveReading> read() override {
    if (fails) return PortFault{FaultKind::link_lost, "part: broken"};
    return DriveReading{.time = time, .values = positions, .carried = positions, .moving = time > 1};
  }
  bool fails = false;
  int halts = 0;
  double lasts = 0, time = 1;
  std::vector<double> positions;

 private:
  std::size_t size_;
  DriveQuantity quantity_;
};

TEST(JoinedDrive, SharesOutTargetsAndJoinsReadings) {
  for (const auto calls : {JoinedDrive::Calls::one_by_one, JoinedDrive::Calls::at_once}) {
    Part first(2), second(3);
    second.time = 2;
    JoinedDrive joined({&first, &second}, calls);
    EXPECT_EQ(joined.axes(), 5U);
    ASSERT_TRUE(joined.command(std::vector<double>{1, 2, 3, 4, 5}, 0.5));
    EXPECT_THAT(first.positions, ElementsAre(1, 2));
    EXPECT_THAT(second.positions, ElementsAre(3, 4, 5));
    EXPECT_EQ(second.lasts, 0.5);
    const DriveReading reading = joined.read().value();
    EXPECT_THAT(reading.values, ElementsAre(1, 2, 3, 4, 5));
    EXPECT_EQ(reading.carried, reading.values);
    EXPECT_EQ(reading.time, 1.5);
    EXPECT_TRUE(reading.moving);
  }
}

TEST(JoinedDrive, HaltsAllIfOneFails) {
  Part first(1), second(1);
  JoinedDrive joined({&first, &second});
  second.fails = true;
  const auto outcome = joined.command(std::vector<double>{1, 2}, 1);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(text(*outcome.fault()), "refused: part: broken");
  EXPECT_EQ(first.halts, 1);
  EXPECT_EQ(second.halts, 1);
  EXPECT_FALSE(joined.read());
}

TEST(JoinedDrive, RefusesBadCommandsBeforeAnyPartMoves) {
  Part first(1), second(1), other(1, DriveQuantity::tendon_tensions);
  JoinedDrive joined({&first, &second});
  EXPECT_FALSE(joined.command(std::vector<double>{1}, 1));
  EXPECT_FALSE(joined.command(std::vector<double>{1, std::nan("")}, 1));
  EXPECT_FALSE(joined.command(std::vector<double>{1, 2}, -1));
  EXPECT_TRUE(first.positions.empty());
  EXPECT_THROW(JoinedDrive({}), std::invalid_argument);
  EXPECT_THROW(JoinedDrive({&first, &other}), std::invalid_argument);
}

// Controllers behind serial lines, in real time.
struct Boards {
  Boards() {
    for (std::size_t i = 0; i < devices.size(); ++i) {
      SerialPair pair = open_serial_pair();
      // A serial line is opened before the device has a thread.
      auto link = open_link(parse_link_address(pair.path));
      servers[i] = std::make_unique<DeviceServer>(std::move(pair.device), devices[i]);
      GrblConfig config;
      config.answer_timeout = 5;  // Of a machine that is busy.
      config.connect_timeout = config.stop_timeout = joined_patience;
      drives[i] = std::make_unique<GrblDrive>(std::move(link).value(), clock, config);
    }
  }
  WallClock clock;
  std::array<GrblDevice, 2> devices;
  std::array<std::unique_ptr<DeviceServer>, 2> servers;
  std::array<std::unique_ptr<GrblDrive>, 2> drives;
};

TEST(JoinedDrive, MovesGrblControllersOverSerialLines) {
  Boards boards;
  for (const auto& drive : boards.drives) {
    const auto connected = drive->connect();
    ASSERT_TRUE(connected) << text(*connected.fault());
    ASSERT_TRUE(drive->set_positions(std::vector<double>{0, 0, 0}));
  }
  JoinedDrive joined({boards.drives[0].get(), boards.drives[1].get()});
  const std::vector<double> target{300, -200, 100, 1, 2, 3};
  const auto moved = joined.command(target, 0.2);
  ASSERT_TRUE(moved) << text(*moved.fault());
  auto reading = joined.read();
  for (const double start = steady_seconds();
       reading && reading.value().moving && steady_seconds() < start + joined_patience;)
    reading = joined.read();
  ASSERT_TRUE(reading) << text(*reading.fault());
  EXPECT_EQ(reading.value().values, target);
}

TEST(JoinedDrive, IsHaltedByAnotherThread) {
  Boards boards;
  for (const auto& drive : boards.drives) {
    ASSERT_TRUE(drive->connect());
    ASSERT_TRUE(drive->set_positions(std::vector<double>{0, 0, 0}));
  }
  JoinedDrive joined({boards.drives[0].get(), boards.drives[1].get()}, JoinedDrive::Calls::one_by_one);
  std::atomic<bool> is_over = false;
  std::thread commander([&] {
    for (double target = 0; !is_over; target += 50)
      (void)joined.command(std::vector<double>(6, target), 0.05);
  });
  for (int i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto halted = joined.halt();
    EXPECT_TRUE(halted) << text(*halted.fault());
  }
  is_over = true;
  commander.join();
  const auto halted = joined.halt();
  EXPECT_TRUE(halted) << text(*halted.fault());
  const auto reading = joined.read();
  ASSERT_TRUE(reading) << text(*reading.fault());
  EXPECT_FALSE(reading.value().moving);
}

TEST(GrblDrive, StopsHomingFromAnotherThread) {
  GrblDeviceConfig board{.settings = {{22, 1}, {25, 60}}};
  board.low = {-1e5, -1e5, -1e5};
  board.high = {1e5, 1e5, 1e5};
  GrblDevice device(board);
  SerialPair pair = open_serial_pair();
  auto link = open_link(parse_link_address(pair.path));
  DeviceServer server(std::move(pair.device), device);
  const WallClock clock;
  GrblConfig config;
  config.answer_timeout = 5;
  config.connect_timeout = config.stop_timeout = config.homing_timeout = joined_patience;
  GrblDrive drive(std::move(link).value(), clock, config);
  ASSERT_TRUE(drive.connect());
  Outcome<Accepted> homed = Accepted{};
  std::thread homing([&] { homed = drive.home(std::vector<double>{0, 0, 0}); });
  const auto state = [&] {
    const auto lock = server.lock();
    return device.state();
  };
  for (const double start = steady_seconds();
       state() != GrblState::home && steady_seconds() < start + joined_patience;)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(drive.halt());
  homing.join();
  EXPECT_FALSE(homed);
  EXPECT_EQ(state(), GrblState::alarm);
  EXPECT_FALSE(drive.knows_position());
}

}  // namespace
}  // namespace flexura
