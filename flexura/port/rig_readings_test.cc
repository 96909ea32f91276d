#include "flexura/port/rig_readings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/support/stub_ports.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct StubCamera {
  CameraConfig config;
  StoppedClock clock;
  bool has_head = true, has_stage = true;
  StubHead head;
  StubStage stage;

  StubCamera() {
    for (const double ratio : {1, 2, 4}) config.lens.zoom.emplace_back().ratio = ratio;
    config.mount.look_at = {0, 0, 1};
    config.head.zoom.resolution = 0.01;
  }
  std::variant<StanceReading, std::string> read() {
    return read_camera(
        {&clock,
         nullptr,
         {{"front"}, {"side", nullptr, has_head ? &head : nullptr, has_stage ? &stage : nullptr}}},
        1, Camera(config));
  }
  std::string error() {
    auto reading = read();
    const auto* why = std::get_if<std::string>(&reading);
    return why != nullptr ? *why : "none";
  }
};

std::string error_of_read(StubArm& arm) {
  auto reading = read_arm(arm, 2);
  const auto* why = std::get_if<std::string>(&reading);
  return why != nullptr ? *why : "none";
}

TEST(RigReadings, AnArmIsAsItsDrivesSay) {
  StubArm arm;
  const auto reading = std::get<ArmReading>(read_arm(arm, 2));
  EXPECT_EQ(reading.time, 1);
  EXPECT_EQ(reading.state.bends[0], Eigen::Vector2d(0.1, 0.2));
}

TEST(RigReadings, AnArmThatIsInNoStateIsToldInWords) {
  StubArm arm;
  for (double* number : {&arm.next_reading.state.bends[1].y(), &arm.next_reading.state.stretches[1]}) {
    const double before = *number;
    *number = none;
    EXPECT_EQ(error_of_read(arm), "the arm's readings are not finite");
    *number = before;
  }
  arm.next_reading.time = none;
  EXPECT_EQ(error_of_read(arm), "the arm's timestamp is not finite");
  arm.next_reading.time = 0;
  arm.next_reading.state.stretches.pop_back();
  EXPECT_EQ(error_of_read(arm), "the arm's drives report 2 sections and 1 stretches: expected 2");
  arm.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(error_of_read(arm), "the arm: link lost: gone");
}

TEST(RigReadings, ACameraStandsAsItsHeadAndStageSay) {
  StubCamera camera;
  camera.stage.next_reading.moving = true;
  const auto reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.time, 2);
  EXPECT_EQ(reading.stance.camera, 1U);
  EXPECT_EQ(reading.stance.head.tilt, 0.2);
  EXPECT_EQ(reading.stance.stage.offset.x(), 0.1);
  EXPECT_TRUE(reading.moving);
}

TEST(RigReadings, WithoutAHeadOrAStageACameraStandsWhereItStarts) {
  StubCamera camera;
  camera.config.initial = {.pan = -0.3, .tilt = 0.15, .zoom = 2, .stage = {0.2, 0, 0}};
  camera.has_head = false;
  auto reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.head, (HeadState{-0.3, 0.15, 2}));
  EXPECT_EQ(reading.stance.stage, camera.stage.next_reading.state);
  EXPECT_EQ(reading.time, 2) << "the stage's";
  camera.has_stage = false, camera.has_head = true;
  reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.head, camera.head.next_reading.state);
  EXPECT_EQ(reading.stance.stage.offset, Eigen::Vector3d(0.2, 0, 0));
  camera.has_head = false;
  reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.stance(), Camera(camera.config).initial_stance());
  EXPECT_EQ(reading.time, 3) << "the clock's";
  EXPECT_FALSE(reading.moving);
  // A fault of the stage that exists still counts.
  camera.has_stage = true;
  camera.stage.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(camera.error(), "the stage of camera side: link lost: gone");
}

TEST(RigReadings, ACameraThatTellsNoViewIsToldInWords) {
  StubCamera camera;
  for (double* number : {&camera.head.next_reading.time, &camera.head.next_reading.state.pan,
                         &camera.head.next_reading.state.tilt, &camera.head.next_reading.state.zoom,
                         &camera.stage.next_reading.state.offset.z()}) {
    const double before = *number;
    *number = none;
    EXPECT_THAT(camera.error(), HasSubstr("camera side: the readings of its head or stage are not finite"));
    *number = before;
  }
  camera.stage.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(camera.error(), "the stage of camera side: link lost: gone");
  camera.head.fault = camera.stage.fault;
  EXPECT_EQ(camera.error(), "the head of camera side: link lost: gone");
}

// A head may stop slightly beyond the end of its zoom range, and counts in steps.
TEST(RigReadings, AZoomWithinAStepOfTheLensesEndIsThatEnd) {
  StubCamera camera;
  for (const auto& [next_reading, is] : {std::pair{0.995, 1.0}, {4.009, 4.0}, {3.9, 3.9}}) {
    camera.head.next_reading.state.zoom = next_reading;
    const auto reading = std::get<StanceReading>(camera.read());
    EXPECT_EQ(reading.stance.head.zoom, is);
    EXPECT_NO_THROW((void)Camera(camera.config).view(reading.stance.stance()));
  }
  for (const double next_reading : {0.98, 4.02, -1.0}) {
    camera.head.next_reading.state.zoom = next_reading;
    EXPECT_THAT(camera.error(), HasSubstr("but the lens's table is from 1 to 4"));
  }
  camera.config.lens.zoom.clear();
  camera.head.next_reading.state.zoom = 0;
  EXPECT_EQ(camera.error(), "the head of camera side reports a zoom of 0: expected a zoom above 0");
  camera.head.next_reading.state.zoom = 12;
  EXPECT_EQ(std::get<StanceReading>(camera.read()).stance.head.zoom, 12);
}

}  // namespace
}  // namespace flexura
