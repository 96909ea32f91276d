#include "flexura/rig/dry_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "flexura/equipment/cia402_codec.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/port/driven_arm.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// An arm of one section with three tendons, and a camera with a head.
Setup dry_setup() {
  Setup setup;
  setup.arm.kind = ArmKind::spatial;
  Section section;
  section.length = 0.3;
  setup.arm.section = {section};
  setup.drive.emplace();
  setup.drive->radius = 0.01;
  for (const double angle : {0.0, 2.0943951, 4.1887902}) {
    TendonConfig tendon;
    tendon.angle = angle;
    setup.drive->tendon.push_back(tendon);
  }
  CameraConfig camera;
  camera.name = "front";
  camera.sensor.width = 32, camera.sensor.height = 24;
  camera.lens.fx = 40;
  camera.mount.position = {0, 0.1, 1};
  camera.mount.look_at = {0, 0, 0.1};
  setup.camera = {camera};
  setup.equipment.emplace();
  setup.equipment->camera.resize(1);
  setup.equipment->camera[0].name = "front";
  setup.equipment->camera[0].gstreamer.emplace();
  return setup;
}

ArmState bent() {
  ArmState state = ArmState::straight(1);
  state.bends[0] = {0.3, 0.2};
  return state;
}

// What a dry run of a move to bent() sends, in 1 s.
std::vector<DryMessage> moved(const Setup& setup) {
  std::vector<DryMessage> sent;
  {
    const auto rig = dry_rig(setup, [&](const DryMessage& message) { sent.push_back(message); });
    EXPECT_FALSE(rig->is_simulated()) << "unsafe motions are not played";
    rig->pass_to(0, ArmState::straight(1));
    for (int i = 1; i <= 50; ++i) {
      ArmState state = bent();
      state.bends[0] *= 0.02 * i;
      rig->pass_to(0.02 * i, state);
    }
  }
  return sent;
}

std::vector<double> expected_motors(const Setup& setup) {
  const ArmSetup arm(setup.model_rig());
  std::vector<double> motors;
  for (const std::int64_t one : nominal_positions(arm.arm, *arm.drive, bent()))
    motors.push_back(static_cast<double>(one));
  return motors;
}

// The reported bytes alone move another controller to the shape.
TEST(DryRig, ReportsTheBytesThatMoveAGrblController) {
  auto setup = dry_setup();
  setup.equipment->grbl.resize(1);
  setup.equipment->grbl[0].link = "/dev/ttyUSB0";
  const std::vector<DryMessage> sent = moved(setup);
  ASSERT_FALSE(sent.empty());
  EXPECT_TRUE(std::ranges::is_sorted(sent, {}, &DryMessage::time));
  EXPECT_LT(sent.front().time, 0) << "the connection is made before the run";
  EXPECT_EQ(sent.front().sent.text, "0x18 (reset)");
  GrblDevice other(
      {.settings = {{100, 100}, {101, 100}, {102, 100}, {110, 60000}, {111, 60000}, {112, 60000}}});
  double now = 0;
  std::size_t jogs = 0;
  for (const DryMessage& message : sent) {
    EXPECT_EQ(message.device, "/dev/ttyUSB0");
    if (message.sent.text.starts_with("$J=")) ++jogs;
    now = std::max(now, message.time + 100);
    if (message.sent.text.find("cancel") == std::string::npos) (void)other.receive(message.bytes, now);
  }
  EXPECT_GE(jogs, 45u);
  EXPECT_EQ(other.positions(now + 10), expected_motors(setup));
}

TEST(DryRig, ReportsTheFramesOfCanopenDrives) {
  auto setup = dry_setup();
  setup.equipment->cia402.emplace();
  for (const int node : {1, 2, 3}) setup.equipment->cia402->axes.push_back({.node = node});
  const std::vector<DryMessage> sent = moved(setup);
  const std::vector<double> expected = expected_motors(setup);
  // The last target of each node.
  std::vector<std::int32_t> last(3, 0);
  for (const DryMessage& message : sent) {
    const auto frame = parse_can_frame(message.bytes);
    ASSERT_TRUE(frame);
    const std::uint32_t node = frame->id & 0x7FU;
    if ((frame->id & ~0x7FU) == cob::rpdo1 && (number_at(*frame, 0, 2) & control_word::start) != 0)
      last.at(node - 1) = static_cast<std::int32_t>(number_at(*frame, 2, 4));
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(last[i], expected[i]) << i;
  EXPECT_TRUE(std::ranges::any_of(
      sent, [](const DryMessage& one) { return one.sent.text.find("node 1: start") != std::string::npos; }));
}

TEST(DryRig, PassesHeadsToTheirDrivers) {
  for (const bool is_visca : {true, false}) {
    auto setup = dry_setup();
    setup.equipment->grbl.resize(1);
    setup.equipment->grbl[0].link = "/dev/ttyUSB0";
    if (is_visca) {
      setup.equipment->camera[0].visca.emplace();
      setup.equipment->camera[0].visca->bus.link = "/dev/ttyUSB1@9600";
    } else {
      setup.equipment->camera[0].v4l2_head.emplace();
    }
    std::vector<std::string> sent;
    const auto rig = dry_rig(setup, [&](const DryMessage& message) {
      if (!message.sent.asks && message.device != "/dev/ttyUSB0") sent.push_back(message.sent.text);
    });
    HeadPort* head = rig->ports().cameras[0].head;
    ASSERT_NE(head, nullptr);
    HeadState state = head->read().value().state;
    state.pan += 0.1;
    sent.clear();
    EXPECT_TRUE(head->command(state));
    ASSERT_FALSE(sent.empty());
    // 0.1 rad are 5.73 degrees: 14.4 counts each, or 3600 seconds of arc; both count to the right.
    const std::string expected = is_visca ? "pan to -83" : "pan_absolute = -20626";
    EXPECT_NE(sent.front().find(expected), std::string::npos) << sent.front();
  }
}

TEST(DryRig, OfACameraWithoutAHeadHasNone) {
  auto setup = dry_setup();
  setup.equipment->grbl.resize(1);
  setup.equipment->grbl[0].link = "/dev/ttyUSB0";
  const auto rig = dry_rig(setup, [](const DryMessage&) {});
  EXPECT_EQ(rig->ports().cameras.at(0).head, nullptr);
  EXPECT_EQ(rig->truth(), nullptr) << "as on equipment";
}

}  // namespace
}  // namespace flexura
