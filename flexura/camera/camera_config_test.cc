#include "flexura/camera/camera_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"
#include "flexura/camera/camera.h"
#include "tests/support/cameras.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

Node node(const CameraConfig& camera) { return Codec<CameraConfig>::write(camera); }

// Error message for a camera's table in which the value at `path` is replaced.
std::string error_of(const CameraConfig& camera, const std::string& path, Node::Value value) {
  Node table = node(camera);
  EXPECT_EQ(set_at_path(table, path, {std::move(value), {}}), "");
  try {
    (void)read_as<CameraConfig>(table);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

CameraConfig front() { return cameras_at({5, 4})[0]; }

TEST(CameraConfig, WritesWhatItReads) {
  for_random_cases(20, [](TestRandom& random) {
    const CameraConfig camera = random_camera(random);
    const auto again = read_as<CameraConfig>(node(camera));
    EXPECT_EQ(node(again).literal(), node(camera).literal());
    EXPECT_EQ(again.mount.position, camera.mount.position);
    EXPECT_EQ(again.mount.stage.x.limits, camera.mount.stage.x.limits);
    EXPECT_EQ(again.head.tilt_axis, camera.head.tilt_axis);
    EXPECT_EQ(again.lens.zoom.size(), camera.lens.zoom.size());
  });
}

TEST(CameraConfig, HasThePapersHeadByDefault) {
  const HeadConfig head;
  EXPECT_NEAR(head.pan.limits[1] / degree, 135, 1e-12);
  EXPECT_NEAR(head.tilt.limits[0] / degree, -45, 1e-12);
  EXPECT_NEAR(head.tilt.limits[1] / degree, 90, 1e-12);
  EXPECT_NEAR(head.pan.max_rate / degree, 50, 1e-12);
  EXPECT_NEAR(head.tilt.max_rate / degree, 25, 1e-12);
  EXPECT_EQ(Camera(front()).head_axes()[2].limits, (std::array<double, 2>{1, 10}));
}

TEST(CameraConfig, SaysWhatIsWrong) {
  const Node::Array swapped{{1.0, {}}, {-1.0, {}}};
  EXPECT_THAT(error_of(front(), "name", std::string()), HasSubstr("name: is empty"));
  for (const std::string name : {"/tmp/x", "../../x", ".x", "a\\b", "\xc3\xa4"})
    EXPECT_THAT(error_of(front(), "name", name), HasSubstr("cannot be a file name: expected")) << name;
  EXPECT_THAT(error_of(front(), "name", std::string(101, 'a')), HasSubstr("at most 100 letters"));
  EXPECT_EQ(error_of(front(), "name", std::string("Sony 2.B_left-1")), "no error");
  EXPECT_THAT(error_of(front(), "lens.fx", 0.0), HasSubstr("lens.fx = 0: expected a number from 0.001"));
  EXPECT_THAT(error_of(front(), "head.pan.limits", swapped),
              HasSubstr("head.pan.limits: expected the smaller"));
  EXPECT_THAT(error_of(front(), "head.zoom.limits", swapped),
              HasSubstr("head.zoom.limits: expected the smaller"));
  EXPECT_THAT(error_of(front(), "head.zoom.limits", Node::Array{{0.0, {}}, {5.0, {}}}),
              HasSubstr("head.zoom.limits: reach to 0 or below"));
  EXPECT_THAT(error_of(front(), "initial.pan", 3.0), HasSubstr("initial.pan: 3 is outside"));
  EXPECT_THAT(error_of(front(), "initial.zoom", 0.5), HasSubstr("initial.zoom: 0.5 is outside"));
  EXPECT_THAT(error_of(front(), "initial.stage", Node::Array{{0.1, {}}, {0.0, {}}, {0.0, {}}}),
              HasSubstr("initial.stage[0]: 0.1 is outside"));
  EXPECT_THAT(error_of(front(), "mount.look_at", Node::Array{{0.0, {}}, {9.0, {}}, {5.0, {}}}),
              HasSubstr("mount.look_at: is straight above"));
  EXPECT_THAT(error_of(front(), "mount.rotation", Node::Array{{1.0, {}}, {0.0, {}}, {0.0, {}}, {0.0, {}}}),
              HasSubstr("mount.rotation: is given together with look_at"));
  EXPECT_THAT(error_of(front(), "head.pan.max_rate", -1.0), HasSubstr("expected a number above 0 rad/s"));
  EXPECT_THAT(error_of(front(), "mount.stage.x.max_rate", 0.0), HasSubstr("expected a number above 0 m/s"));
  CameraConfig counted = front();
  counted.lens.zoom = sony_zoom();
  EXPECT_THAT(error_of(counted, "head.zoom.limits", Node::Array{{0.0, {}}, {20000.0, {}}}),
              HasSubstr("head.zoom.limits: leave the lens's table: expected 0 to 16384"));
  EXPECT_THAT(error_of(counted, "lens.zoom.3.ratio", 30.0),
              HasSubstr("lens.zoom[4].ratio: expected a ratio that increases from row to row"));
}

TEST(CameraConfig, CamerasHaveNamesOfTheirOwn) {
  Reader reader;
  std::vector<CameraConfig> cameras = cameras_at({5, 5});
  check_cameras(cameras, "camera", reader);
  EXPECT_TRUE(reader.problems().empty());
  cameras[1].name = "front";
  check_cameras(cameras, "camera", reader);
  ASSERT_EQ(reader.problems().size(), 1);
  EXPECT_THAT(reader.problems()[0].what, HasSubstr("camera[1].name: \"front\" is the name of another"));
}

// The image of camera 1 shows X to the right and Y up, that of camera 2 Z to the right and Y up.
TEST(DefaultCameras, FaceThePapersPlanes) {
  const auto cameras = cameras_at({5, 4});
  const View front = Camera(cameras[0]).view({{}, {}}), side = Camera(cameras[1]).view({{}, {}});
  const auto pixel = [](const View& view, double x, double y, double z) { return *view.project({x, y, z}); };
  const Eigen::Vector2d middle(319.5, 239.5);
  EXPECT_LE((pixel(front, 0, 0, 0) - middle).norm(), 1e-12);
  EXPECT_LE((pixel(front, 1, 0, 0) - middle - Eigen::Vector2d(160, 0)).norm(), 1e-12);
  EXPECT_LE((pixel(front, 0, 1, 0) - middle - Eigen::Vector2d(0, -160)).norm(), 1e-12);
  EXPECT_LE((pixel(side, 0, 0, 0) - middle).norm(), 1e-12);
  EXPECT_LE((pixel(side, 0, 0, 1) - middle - Eigen::Vector2d(200, 0)).norm(), 1e-12);
  EXPECT_LE((pixel(side, 0, 1, 0) - middle - Eigen::Vector2d(0, -200)).norm(), 1e-12);
}

TEST(DefaultCameras, HaveTheWholeReachInView) {
  for_random_cases(500, [](TestRandom& random) {
    const double reach = random.uniform(0.1, 20);
    const std::array<double, 3> center = {random.uniform(-1, 1), random.uniform(-1, 1),
                                          random.uniform(-1, 1)};
    const Eigen::Vector3d p_WP =
        reach * random.vector<3>(-1, 1).normalized() + Eigen::Vector3d(center[0], center[1], center[2]);
    for (const CameraConfig& camera : default_cameras(reach, center)) {
      const auto pixel = Camera(camera).view({{}, {}}).project(p_WP);
      ASSERT_TRUE(pixel);
      EXPECT_GT(pixel->x(), 10);
      EXPECT_GT(pixel->y(), 10);
      EXPECT_LT(pixel->x(), 629);
      EXPECT_LT(pixel->y(), 469);
    }
  });
  EXPECT_THROW((void)default_cameras(0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
