#include "flexura/port/camera_moves.h"

#include <gtest/gtest.h>

#include "flexura/camera/camera_config.h"
#include "tests/support/stub_ports.h"

namespace flexura {
namespace {

TEST(CameraMoves, ACameraWithoutAHeadOrAStageStaysWhereItStands) {
  CameraConfig config;
  config.name = "side";
  config.mount.look_at = {0, 0, 1};
  config.initial.pan = 0.1;
  const Camera optics(config);
  const CameraPorts bare{"side"};
  EXPECT_TRUE(command_head(bare, optics, optics.initial_head()));
  EXPECT_TRUE(command_stage(bare, optics, optics.initial_stage()));
  EXPECT_TRUE(halt_camera(bare));
  EXPECT_EQ(measured_stance(bare, optics).value(), optics.initial_stance());
  EXPECT_EQ(text(*command_head(bare, optics, {0.2, 0, 1}).fault()),
            "refused: camera side has no head: it cannot pan, tilt or zoom");
  EXPECT_EQ(text(*command_stage(bare, optics, {{0, 0, 0.1}}).fault()),
            "refused: camera side has no stage: it cannot be translated");
  EXPECT_EQ(missing_head(bare), "camera side has no head: it cannot pan, tilt or zoom");
  EXPECT_EQ(missing_stage(bare, optics), "") << "it was never believed to travel";
  config.mount.stage.z.limits = {0, 1};
  EXPECT_EQ(missing_stage(bare, Camera(config)),
            "camera side has no stage: it cannot be translated, but its mount.stage has travel");
}

TEST(CameraMoves, ACameraWithBothIsToldAndAskedAsItIs) {
  CameraConfig config;
  config.mount.look_at = {0, 0, 1};
  StubHead head;
  StubStage stage;
  const CameraPorts ports{"side", nullptr, &head, &stage};
  const Camera optics(config);
  EXPECT_TRUE(command_head(ports, optics, {0.2, 0, 1}));
  EXPECT_TRUE(command_stage(ports, optics, {{0, 0, 0.1}}));
  EXPECT_EQ(measured_stance(ports, optics).value(),
            (CameraStance{head.next_reading.state, stage.next_reading.state}));
  EXPECT_EQ(missing_head(ports) + missing_stage(ports, optics), "");
  stage.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(measured_stance(ports, optics).fault()->what, "gone");
  EXPECT_EQ(halt_camera(ports).fault()->what, "gone");
}

}  // namespace
}  // namespace flexura
