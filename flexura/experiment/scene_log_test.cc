#include "flexura/experiment/scene_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "flexura/base/table.h"
#include "flexura/log/recorder.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

const std::string furnished = R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
radius = 0.03
[[arm.section]]
length = 0.5
radius = [0.03, 0.01]
[stand.etalon]
position = [0.5, 0, 0]
rotation = [0.7071067811865476, 0, 0, 0.7071067811865476]
[[obstacle]]
kind = "plane"
normal = [0, 1, 0]
point = [0, -1, 0]
[[obstacle]]
kind = "capsule"
from = [1, 0, 0]
to = [1, 2, 0]
radius = 0.1
[[obstacle]]
kind = "box"
center = [-1, 0, 0]
half_sizes = [0.1, 0.2, 0.3]
[[obstacle]]
kind = "sphere"
center = [-1, 1, 0]
radius = 0.1
[[task]]
kind = "move"
duration = 1
to = { bends = [[1, 0], [0, 0]] }
)";

Experiment experiment_of(const std::string& text) { return parse_experiment(text, "x.toml"); }

TEST(SceneLog, DrawsWhatStandsThere) {
  const SceneMessage scene = stand_message(experiment_of(furnished));
  ASSERT_EQ(scene.entities.size(), 2);
  const EntityMessage& stand = scene.entities[0];
  EXPECT_EQ(stand.cubes.size(), 2) << "the screens";
  ASSERT_EQ(stand.cylinders.size(), 1);
  // The etalon's axis is E's +Y, here W's -X; a cylinder's is its z.
  const QuaternionMessage& q = stand.cylinders[0].pose.orientation;
  const Eigen::Vector3d axis = Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(axis.isApprox(Eigen::Vector3d(-1, 0, 0), 1e-9)) << axis.transpose();
  EXPECT_NEAR(stand.cylinders[0].pose.position.x, 0.3, 1e-9) << "in its middle";
  const EntityMessage& obstacles = scene.entities[1];
  EXPECT_EQ(obstacles.cubes.size(), 2) << "the plane and the box";
  EXPECT_EQ(obstacles.spheres.size(), 3) << "the ball and the capsule's ends";
  ASSERT_EQ(obstacles.cylinders.size(), 1);
  EXPECT_NEAR(obstacles.cylinders[0].size.z, 2, 1e-12);
  EXPECT_NEAR(obstacles.cylinders[0].pose.position.y, 1, 1e-12);
}

TEST(SceneLog, DrawsTheArmNearItsBackbone) {
  const Experiment experiment = experiment_of(furnished);
  const Arm arm = experiment.arm.arm();
  const Backbone backbone(arm, {{{1.5, 0.5}, {-2, 0}}, {1, 1}});
  const SceneMessage scene = arm_message({0, 0, 0}, 1.25, backbone);
  const EntityMessage& drawn = scene.entities.at(0);
  EXPECT_EQ(drawn.id, "arm");
  EXPECT_EQ(drawn.timestamp.nsec, 250'000'000);
  ASSERT_EQ(drawn.lines.size(), 2) << "as thick as each section";
  EXPECT_NEAR(drawn.lines[0].thickness, 0.06, 1e-12);
  EXPECT_NEAR(drawn.lines[1].thickness, 0.04, 1e-12);
  const VectorMessage& tip = drawn.lines[1].points.back();
  EXPECT_LT((Eigen::Vector3d(tip.x, tip.y, tip.z) - backbone.tip().position).norm(), 1e-6);
  EXPECT_EQ(drawn.lines[1].points.front().x, drawn.lines[0].points.back().x);
}

TEST(SceneLog, SaysWhereTheFramesStand) {
  const FramesMessage frames = frames_message(experiment_of(furnished));
  ASSERT_EQ(frames.transforms.size(), 4);
  EXPECT_EQ(frames.transforms[0].child_frame_id, "base");
  EXPECT_EQ(frames.transforms[1].child_frame_id, "camera/front");
  EXPECT_GT(frames.transforms[1].translation.z, 1);
  const FrameMessage& upright = frames.transforms[3];
  EXPECT_EQ(upright.child_frame_id, "upright");
  const QuaternionMessage& q = upright.rotation;
  const Eigen::Vector3d up = Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(up.isApprox(Eigen::Vector3d::UnitY(), 1e-12)) << up.transpose();
}

// Returns the messages of a topic of a log, in order.
template <class M>
std::vector<M> messages_on(const McapReader& log, std::string_view topic) {
  std::vector<M> found;
  for (const McapMessage& message : log.messages())
    if (message.channel->topic == topic) found.push_back(read_as<M>(parse_json(message.text(), "the log")));
  return found;
}

TEST(SceneLog, HasEachLensAtTheStartAndWhenItsZoomHasChanged) {
  const TemporaryFolder folder;
  CameraConfig config;
  config.name = "front";
  config.mount.position = {0, 0, 2};
  config.mount.look_at = {0, 0, 0};
  config.sensor.frame_rate = 10;
  config.lens.fx = 800;
  config.lens.cx = 300;
  config.lens.distortion = {-0.1, 0.02, 0.001, 0.002, 0};
  const Camera camera(config);
  CameraStance stance = camera.initial_stance();
  {
    Recorder recorder(folder.path() / "log.mcap", experiment_of(furnished).arm.arm());
    CameraConfig model = config;
    model.initial.pan = 0.25;  // The true camera stands otherwise.
    CameraDrawing drawing(config, model, recorder);
    CameraStance reported = drawing.first_report();
    EXPECT_EQ(reported.head.pan, 0.25);
    drawing.report(0.5, reported, recorder);  // Nothing has changed.
    for (int i = 1; i <= 100; ++i) {          // Every hundredth of a second for 1 s.
      reported.head.zoom = 1 + 0.01 * std::min(i, 90);
      drawing.report(1 + 0.01 * i, reported, recorder);
    }
    reported.head.pan += 0.1;
    drawing.report(3, reported, recorder);
    stance.head.zoom = 1.9;
    stance.head.pan += 0.1;
    recorder.close();
  }
  const McapReader log(folder.path() / "log.mcap");
  const auto lenses = messages_on<CameraCalibrationMessage>(log, "/intrinsics/front");
  EXPECT_GE(lenses.size(), 10U);
  EXPECT_LE(lenses.size(), 12U) << "at most one per frame";
  EXPECT_EQ(lenses.front().frame_id, "camera/front");
  EXPECT_EQ(lenses.front().width, 640);
  EXPECT_EQ(lenses.front().height, 480);
  EXPECT_EQ(lenses.front().distortion_model, "plumb_bob");
  EXPECT_THAT(lenses.front().distortion, testing::ElementsAre(-0.1, 0.02, 0.001, 0.002, 0));
  const std::array<double, 9> at_start{800, 0, 300, 0, 800, 239.5, 0, 0, 1};
  EXPECT_EQ(lenses.front().intrinsics, at_start);
  EXPECT_NEAR(lenses.back().intrinsics[0], 800 * 1.9, 1e-9) << "the last zoom is not lost";
  const std::array<double, 12> projection{1520, 0, 300, 0, 0, 1520, 239.5, 0, 0, 0, 1, 0};
  for (std::size_t i = 0; i < projection.size(); ++i)
    EXPECT_NEAR(lenses.back().projection[i], projection[i], 1e-9) << i;
  const auto frames = messages_on<FramesMessage>(log, "/frames");
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(frames.back().transforms.at(0).timestamp.sec, 3);
  const Pose pose = camera.pose(stance);
  const QuaternionMessage& q = frames.back().transforms.at(0).rotation;
  EXPECT_TRUE(Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix().isApprox(pose.rotation, 1e-9));
}

TEST(SceneLog, IsKeptTenTimesASecondUnlessItIsNotWanted) {
  Runs runs;
  const RunResult kept = runs.run(furnished);
  auto counts = logged_counts(kept);
  EXPECT_EQ(counts["/arm/state"], 51U);
  EXPECT_EQ(counts["/scene"], 1U + 11U);
  EXPECT_EQ(counts["/frames"], 1U);
  EXPECT_EQ(counts["/intrinsics/front"], 1U);
  std::map<std::string, std::string> schemas;
  const McapReader log = open_log(kept.folder);
  for (const McapMessage& message : log.messages())
    schemas[message.channel->topic] = message.channel->schema.name;
  EXPECT_EQ(schemas["/scene"], "foxglove.SceneUpdate");
  EXPECT_EQ(schemas["/frames"], "foxglove.FrameTransforms");
  EXPECT_EQ(schemas["/arm/poses"], "foxglove.PosesInFrame");
  EXPECT_EQ(schemas["/events"], "foxglove.Log");
  const auto left_out = logged_counts(runs.run("record.scene = false\n" + furnished));
  EXPECT_FALSE(left_out.contains("/scene"));
  EXPECT_FALSE(left_out.contains("/frames"));
  EXPECT_FALSE(left_out.contains("/intrinsics/front"));
}

}  // namespace
}  // namespace flexura
