#include "flexura/equipment/cia402_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "flexura/base/node.h"
#include "flexura/base/table.h"
#include "flexura/equipment/cia402_config.h"
#include "flexura/equipment/cia402_ramp.h"
#include "flexura/equipment/cia402_sdo.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

CanFrame frame_of(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame frame{.id = id};
  for (const int byte : bytes) append(frame, static_cast<std::uint32_t>(byte), 1);
  return frame;
}

TEST(CanFrame, KeepsItsPartsInTheBytesOfSocketCan) {
  const CanFrame frame = frame_of(0x603, {0x23, 0x7A, 0x60, 0x00, 0xE8, 0x03, 0x00, 0x00});
  const std::string bytes = bytes_of(frame);
  ASSERT_EQ(bytes.size(), can_frame_size);
  EXPECT_EQ(bytes[4], 8);
  EXPECT_EQ(parse_can_frame(bytes), frame);
  CanFrame other{.id = 0x1ABCDEF0, .is_extended = true, .is_remote = true};
  EXPECT_EQ(parse_can_frame(bytes_of(other)), other);
  EXPECT_FALSE(parse_can_frame(bytes.substr(1)));
  EXPECT_FALSE(parse_can_frame(bytes + bytes));
  std::string long_frame = bytes;
  long_frame[4] = 9;
  EXPECT_FALSE(parse_can_frame(long_frame));
}

TEST(CanFrame, SaysWhatAnErrorFrameReports) {
  EXPECT_EQ(can_error_text({.id = 0x40, .size = 8, .is_error = true}), "bus off");
  EXPECT_THAT(can_error_text({.id = 0x04, .size = 8, .data = {0, 0x20}, .is_error = true}),
              HasSubstr("passive"));
}

// Ziehl-Abegg, AM-CAN-OPEN, L-BAL-E199-GB 1846, page 15: "Change status to In operation", "Reset device".
TEST(Cia402Codec, WritesNmtCommandsAsInAManual) {
  EXPECT_EQ(nmt_frame(NmtCommand::start, 1), frame_of(0x000, {0x01, 0x01}));
  EXPECT_EQ(nmt_frame(NmtCommand::reset_node, 1), frame_of(0x000, {0x81, 0x01}));
  EXPECT_EQ(heartbeat_frame(1, NmtState::operational), frame_of(0x701, {0x05}));
}

// Nanotec, N5 (CANopen) technical manual 2.0.1, page 108: target position 1000 of node 3.
TEST(SdoTransfer, WritesAsInAManual) {
  SdoTransfer transfer = SdoTransfer::writing(3, {0x607A, 0}, 1000, 4);
  EXPECT_EQ(transfer.request(), frame_of(0x603, {0x23, 0x7A, 0x60, 0x00, 0xE8, 0x03, 0x00, 0x00}));
  EXPECT_FALSE(transfer.take(frame_of(0x584, {0x60, 0x7A, 0x60, 0x00, 0, 0, 0, 0})));
  EXPECT_FALSE(transfer.take(frame_of(0x583, {0x60, 0x7B, 0x60, 0x00, 0, 0, 0, 0})));
  EXPECT_TRUE(transfer.take(frame_of(0x583, {0x60, 0x7A, 0x60, 0x00, 0, 0, 0, 0})));
  EXPECT_TRUE(transfer.is_over());
  EXPECT_EQ(transfer.abort_code(), 0U);
}

// Festo, GDCP-CMMS/D-C-CO-EN 1404NH, page 20: examples of objects of 1, 2 and 4 bytes.
TEST(SdoTransfer, ReadsAsInAManual) {
  const auto read = [](ObjectAddress object, const CanFrame& answer) {
    SdoTransfer transfer = SdoTransfer::reading(1, object);
    EXPECT_EQ(transfer.request().data[0], 0x40);
    EXPECT_TRUE(transfer.take(answer));
    EXPECT_TRUE(transfer.is_over());
    return transfer.number();
  };
  EXPECT_EQ(read({0x6061, 0}, frame_of(0x581, {0x4F, 0x61, 0x60, 0x00, 0x01})), 1U);
  EXPECT_EQ(read({0x6041, 0}, frame_of(0x581, {0x4B, 0x41, 0x60, 0x00, 0x34, 0x12})), 0x1234U);
  EXPECT_EQ(read({0x6093, 1}, frame_of(0x581, {0x43, 0x93, 0x60, 0x01, 0x78, 0x56, 0x34, 0x12})),
            0x12345678U);
  EXPECT_EQ(SdoTransfer::writing(1, {0x1401, 2}, 0xEF, 1).request(),
            frame_of(0x601, {0x2F, 0x01, 0x14, 0x02, 0xEF, 0, 0, 0}));
  EXPECT_EQ(SdoTransfer::writing(1, {0x6040, 0}, 0x3E8, 2).request(),
            frame_of(0x601, {0x2B, 0x40, 0x60, 0x00, 0xE8, 0x03, 0, 0}));
}

// ICP DAS, CAN-8123/8223/8423 user's manual, device name 0x1008, steps 1 to 4 of the segmented read: 00 43 41
// 4E 2D 38 34 32 is the first segment, "CAN-842".
TEST(SdoTransfer, ReadsTextInSegmentsAsInAManual) {
  SdoTransfer transfer = SdoTransfer::reading(1, {0x1008, 0});
  ASSERT_TRUE(transfer.take(frame_of(0x581, {0x41, 0x08, 0x10, 0x00, 0x08, 0, 0, 0})));
  EXPECT_EQ(transfer.request(), frame_of(0x601, {0x60, 0, 0, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(transfer.take(frame_of(0x581, {0x00, 0x43, 0x41, 0x4E, 0x2D, 0x38, 0x34, 0x32})));
  EXPECT_EQ(transfer.request(), frame_of(0x601, {0x70, 0, 0, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(transfer.take(frame_of(0x581, {0x1D, 0x33, 0, 0, 0, 0, 0, 0})));
  EXPECT_TRUE(transfer.is_over());
  EXPECT_EQ(transfer.data(), "CAN-8423");
}

TEST(SdoTransfer, EndsTransfersThatGoWrong) {
  SdoTransfer toggled = SdoTransfer::reading(1, {0x1008, 0});
  ASSERT_TRUE(toggled.take(frame_of(0x581, {0x41, 0x08, 0x10, 0x00, 0x10, 0, 0, 0})));
  ASSERT_TRUE(toggled.take(frame_of(0x581, {0x10, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(toggled.abort_code(), 0x05030000U);
  EXPECT_EQ(toggled.request(), frame_of(0x601, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  SdoTransfer endless = SdoTransfer::reading(1, {0x1008, 0});
  ASSERT_TRUE(endless.take(frame_of(0x581, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0})));
  for (int i = 0; i < 1000 && !endless.is_over(); ++i)
    endless.take(frame_of(0x581, {i % 2 == 0 ? 0x00 : 0x10, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(endless.abort_code(), 0x05040005U);
}

TEST(SdoServer, AnswersTransfersOfAllLengths) {
  for (std::size_t size = 0; size <= 40; ++size) {
    const std::string content = std::string("The name of a drive, in several segments").substr(0, size);
    SdoServer server(
        5, [&](ObjectAddress) { return SdoServer::ReadResult(content); },
        [](ObjectAddress, const std::string&) { return 0U; });
    SdoTransfer transfer = SdoTransfer::reading(5, {0x1008, 0});
    for (int i = 0; i < 20 && !transfer.is_over(); ++i) {
      const auto answer = server.answer(transfer.request());
      ASSERT_TRUE(answer);
      ASSERT_TRUE(transfer.take(*answer));
    }
    EXPECT_EQ(transfer.data(), content);
    EXPECT_EQ(transfer.abort_code(), 0U);
  }
}

// Isel, IMD20/IMD40, "CanOpen protocol", page 82, lists the codes.
TEST(Cia402Codec, ExplainsCodes) {
  EXPECT_THAT(sdo_abort_text(0x06090031), HasSubstr("too large (abort code 0x06090031)"));
  EXPECT_THAT(drive_error_text(0x8611), HasSubstr("following error"));
  EXPECT_THAT(drive_error_text(0x3221), HasSubstr("undervoltage"));
  EXPECT_THAT(drive_error_text(0xFF12), HasSubstr("specific to the device"));
  EXPECT_EQ(drive_error_text(0), "no error code");
  EXPECT_EQ(text(ObjectAddress{0x607D, 1}), "0x607D:1");
}

// Toshiba, TOSVERT VF-S15, CANopen option, page 30: patterns of the statusword.
TEST(Cia402Codec, ReadsStates) {
  using enum DriveState;
  for (const DriveState state : {switch_on_disabled, ready_to_switch_on, switched_on, operation_enabled,
                                 quick_stop_active, fault_reaction_active, fault})
    EXPECT_EQ(drive_state(static_cast<std::uint16_t>(statusword_of(state) | 0x1690)), state)
        << name_of(state);
  EXPECT_EQ(drive_state(0x0250), switch_on_disabled);
  EXPECT_EQ(drive_state(0x1637), operation_enabled);
}

TEST(Cia402Ramp, ArrivesAtItsTargetFromAnyMotion) {
  Cia402Ramp ramp(0);
  double now = 0;
  for (const double target : {1000.0, -500.0, -480.0, 3000.0, 2999.0, 0.0}) {
    ramp.move(now, target, 800, 5000, 3000);
    Cia402Ramp whole = ramp;
    double before = whole.position(now);
    for (double t = now; t < whole.end(); t += 0.001) {
      EXPECT_LE(std::abs(whole.position(t) - before), 0.81);
      before = whole.position(t);
    }
    EXPECT_NEAR(before, target, 1);
    EXPECT_EQ(whole.position(whole.end()), target);
    EXPECT_EQ(whole.velocity(whole.end()), 0);
    now += 0.4 * (ramp.end() - now);  // The next target comes in mid-move.
  }
  ramp.stop(now, 10000);
  EXPECT_LE(ramp.end() - now, 0.081);
}

TEST(Cia402Ramp, TakesTheTimeThatASpeedWasComputedFor) {
  for (const double velocity : {0.0, 100.0, -150.0, 600.0}) {
    for (const double distance : {300.0, 1000.0, 2500.0}) {
      Cia402Ramp ramp;
      ramp.set(0, 0, velocity);
      const double speed = cia402_speed(distance, velocity, 4, 2000, 5000);
      ramp.move(0, distance, speed, 2000, 2000);
      EXPECT_NEAR(ramp.end(), 4, 1e-9) << velocity << " " << distance;
    }
  }
  EXPECT_EQ(cia402_speed(100, 0, 0, 2000, 5000), 5000);
  EXPECT_EQ(cia402_speed(1e6, 0, 1, 2000, 5000), 5000);
}

TEST(Cia402Config, RefusesWhatDrivesCannotDo) {
  Cia402Config config;
  EXPECT_THAT(problem_of(config), HasSubstr("axes"));
  config.axes.resize(2);
  EXPECT_THAT(problem_of(config), HasSubstr("the number of another node"));
  config.axes[1].node = 2;
  EXPECT_EQ(problem_of(config), "");
  config.axes[1].limits = {0, 1e10};
  EXPECT_THAT(problem_of(config), HasSubstr("axes[1]: positions must fit"));
  config.axes[1].limits = {0, std::nan("")};
  EXPECT_THAT(problem_of(config), HasSubstr("axes[1]: limits"));
}

TEST(Cia402Config, IsWrittenAndReadByItsTable) {
  Cia402Config config;
  config.axes = {{.node = 4, .limits = {-10, 20}}};
  const Node node = fields_of(&config).write(config);
  const auto back = read_as<Cia402Config>(node);
  ASSERT_EQ(back.axes.size(), 1U);
  EXPECT_EQ(back.axes[0].node, 4);
  EXPECT_EQ(back.axes[0].limits[1], 20);
}

}  // namespace
}  // namespace flexura
