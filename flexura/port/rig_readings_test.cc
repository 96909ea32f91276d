#include "flexura/port/rig_readings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/support/said_ports.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct SaidCamera {
  CameraConfig config;
  StoppedClock clock;
  bool has_head = true, has_stage = true;
  SaidHead head;
  SaidStage stage;

  SaidCamera() {
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
  std::string trouble() {
    auto reading = read();
    const auto* why = std::get_if<std::string>(&reading);
    return why != nullptr ? *why : "none";
  }
};

std::string trouble_of(SaidArm& arm) {
  auto reading = read_arm(arm, 2);
  const auto* why = std::get_if<std::string>(&reading);
  return why != nullptr ? *why : "none";
}

TEST(RigReadings, AnArmIsAsItsDrivesSay) {
  SaidArm arm;
  const auto reading = std::get<ArmReading>(read_arm(arm, 2));
  EXPECT_EQ(reading.time, 1);
  EXPECT_EQ(reading.state.bends[0], Eigen::Vector2d(0.1, 0.2));
}

TEST(RigReadings, AnArmThatIsInNoStateIsToldInWords) {
  SaidArm arm;
  for (double* number : {&arm.says.state.bends[1].y(), &arm.says.state.stretches[1]}) {
    const double before = *number;
    *number = none;
    EXPECT_EQ(trouble_of(arm), "the arm's readings are not finite");
    *number = before;
  }
  arm.says.time = none;
  EXPECT_EQ(trouble_of(arm), "the arm's timestamp is not finite");
  arm.says.time = 0;
  arm.says.state.stretches.pop_back();
  EXPECT_EQ(trouble_of(arm), "the arm's drives report 2 sections and 1 stretches: expected 2");
  arm.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(trouble_of(arm), "the arm: link lost: gone");
}

TEST(RigReadings, ACameraStandsAsItsHeadAndStageSay) {
  SaidCamera camera;
  camera.stage.says.moving = true;
  const auto reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.time, 2);
  EXPECT_EQ(reading.stance.camera, 1U);
  EXPECT_EQ(reading.stance.head.tilt, 0.2);
  EXPECT_EQ(reading.stance.stage.offset.x(), 0.1);
  EXPECT_TRUE(reading.moving);
}

TEST(RigReadings, WithoutAHeadOrAStageACameraStandsWhereItStarts) {
  SaidCamera camera;
  camera.config.initial = {.pan = -0.3, .tilt = 0.15, .zoom = 2, .stage = {0.2, 0, 0}};
  camera.has_head = false;
  auto reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.head, (HeadState{-0.3, 0.15, 2}));
  EXPECT_EQ(reading.stance.stage, camera.stage.says.state);
  EXPECT_EQ(reading.time, 2) << "the stage's";
  camera.has_stage = false, camera.has_head = true;
  reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.head, camera.head.says.state);
  EXPECT_EQ(reading.stance.stage.offset, Eigen::Vector3d(0.2, 0, 0));
  camera.has_head = false;
  reading = std::get<StanceReading>(camera.read());
  EXPECT_EQ(reading.stance.stance(), Camera(camera.config).initial_stance());
  EXPECT_EQ(reading.time, 3) << "the clock's";
  EXPECT_FALSE(reading.moving);
  // A fault of the stage that exists still counts.
  camera.has_stage = true;
  camera.stage.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(camera.trouble(), "the stage of camera side: link lost: gone");
}

TEST(RigReadings, ACameraThatTellsNoViewIsToldInWords) {
  SaidCamera camera;
  for (double* number : {&camera.head.says.time, &camera.head.says.state.pan, &camera.head.says.state.tilt,
                         &camera.head.says.state.zoom, &camera.stage.says.state.offset.z()}) {
    const double before = *number;
    *number = none;
    EXPECT_THAT(camera.trouble(), HasSubstr("camera side does not tell how it stands"));
    *number = before;
  }
  camera.stage.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(camera.trouble(), "the stage of camera side: link lost: gone");
  camera.head.fault = camera.stage.fault;
  EXPECT_EQ(camera.trouble(), "the head of camera side: link lost: gone");
}

// A head may stop slightly beyond the end of its zoom range, and counts in steps.
TEST(RigReadings, AZoomWithinAStepOfTheLensesEndIsThatEnd) {
  SaidCamera camera;
  for (const auto& [says, is] : {std::pair{0.995, 1.0}, {4.009, 4.0}, {3.9, 3.9}}) {
    camera.head.says.state.zoom = says;
    const auto reading = std::get<StanceReading>(camera.read());
    EXPECT_EQ(reading.stance.head.zoom, is);
    EXPECT_NO_THROW((void)Camera(camera.config).view(reading.stance.stance()));
  }
  for (const double says : {0.98, 4.02, -1.0}) {
    camera.head.says.state.zoom = says;
    EXPECT_THAT(camera.trouble(), HasSubstr("and its lens is known from 1 to 4"));
  }
  camera.config.lens.zoom.clear();
  camera.head.says.state.zoom = 0;
  EXPECT_EQ(camera.trouble(), "the head of camera side reads a zoom of 0, expected one above 0");
  camera.head.says.state.zoom = 12;
  EXPECT_EQ(std::get<StanceReading>(camera.read()).stance.head.zoom, 12);
}

}  // namespace
}  // namespace flexura
