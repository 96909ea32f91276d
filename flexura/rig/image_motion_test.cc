#include "flexura/rig/image_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "flexura/camera/camera.h"
#include "flexura/model/arm.h"

namespace flexura {
namespace {

using std::numbers::pi;

// A camera 2 m in front of an arm, with 100 px per radian in the middle of its image.
class ImageMotion : public ::testing::Test {
 protected:
  ImageMotion() : camera_(config()) {
    arm_.kind = ArmKind::spatial;
    arm_.sections.resize(1);
    arm_.sections[0].length = 1;
    sensor_.exposure = 0.1;
    shot_.sensor = &sensor_;
    shot_.start = 3;
    shot_.view = [this](double) { return camera_.view({{}, {}}); };
    shot_.backbone = [this](double) { return Backbone(arm_, ArmState::straight(1)); };
    Screen screen;
    screen.X_WS.position = {0, 0, -1};
    stand_.screens.push_back(screen);
  }
  static CameraConfig config() {
    CameraConfig config = cameras_at({2, 2})[0];
    config.lens.fx = 100;
    config.sensor.width = 64, config.sensor.height = 48;
    return config;
  }
  void bend(double (*angle)(double)) {
    shot_.backbone = [this, angle](double time) {
      ArmState state = ArmState::straight(1);
      state.bends[0].x() = angle(time - 3);
      return Backbone(arm_, state);
    };
  }
  Arm arm_;
  Camera camera_;
  SensorConfig sensor_;
  Shot shot_;
  Scene stand_;
};

TEST_F(ImageMotion, IsNothingWhereNothingMoves) {
  EXPECT_EQ(fastest_image_motion(shot_, stand_), 0);
  sensor_.exposure = 0;
  bend([](double time) { return time; });
  EXPECT_EQ(fastest_image_motion(shot_, stand_), 0) << "in an instant";
}

TEST_F(ImageMotion, IsThatOfTheTip) {
  bend([](double time) { return 0.5 * time; });
  // The tip moves by half the bend; 100 px at 2 m are 50 px/m.
  EXPECT_NEAR(fastest_image_motion(shot_, stand_), 50 * 0.5 * 0.5, 0.2);
}

TEST_F(ImageMotion, SeesAMotionThereAndBack) {
  bend([](double time) { return 0.1 * std::sin(2 * pi * time / 0.1); });
  EXPECT_NEAR(fastest_image_motion(shot_, stand_), 50 * 0.5 * 0.1 * 2 * pi / 0.1, 10);
}

TEST_F(ImageMotion, SeesTheStandUnderACameraThatPans) {
  shot_.view = [this](double time) { return camera_.view({{.pan = 0.5 * (time - 3)}, {}}); };
  shot_.backbone = [this](double) { return Backbone(arm_, ArmState::straight(1)); };
  arm_.X_WB.position = {0, 0, 5};  // Behind the camera.
  EXPECT_GE(fastest_image_motion(shot_, stand_), 50);
  EXPECT_EQ(fastest_image_motion(shot_, Scene{}), 0) << "nothing stands there";
}

TEST_F(ImageMotion, LooksUntilTheLastRowIsExposed) {
  sensor_.exposure = 0.01;
  bend([](double time) { return time < 0.02 ? 0 : time - 0.02; });
  EXPECT_EQ(fastest_image_motion(shot_, stand_), 0);
  sensor_.readout = Readout::rolling, sensor_.row_time = 0.001;
  EXPECT_GT(fastest_image_motion(shot_, stand_), 5);
}

}  // namespace
}  // namespace flexura
