#include "flexura/view/seen_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "flexura/store/json.h"
#include "flexura/view/live_session.h"
#include "tests/support/experiment_files.h"
#include "tests/support/live_sessions.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

TEST_F(LiveSessionTest, MeasuresThePictureThatWasSent) {
  EXPECT_THAT(ask(MeasureRequest{"front", {}}).error,
              HasSubstr("no picture of the camera \"front\" was sent yet"));
  EXPECT_THAT(ask(MeasureRequest{"back", {}}).error, HasSubstr("expected one of \"front\", \"side\""));
  EXPECT_THAT(ask(ShapeRequest{}).error, HasSubstr("was sent yet"));
}

// An arm large enough to be measured, with bands, in front of cameras that see it well.
const std::string measured_text = R"(
[arm]
kind = "spatial"
initial = { bends = [[0.6, 0.4], [-0.8, 0.5]] }
look = { bands = { per_section = 3, width = 0.014, colors = [[0.85, 0.1, 0.1], [0.1, 0.2, 0.85]] } }
[[arm.section]]
length = 0.5
radius = 0.02
[[arm.section]]
length = 0.5
radius = 0.02
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2.2], look_at = [0, 0.5, 0] }
sensor = { psf = 0.7, pixels = "color" }
[[camera]]
name = "side"
mount = { position = [-2.2, 0.5, 0], look_at = [0, 0.5, 0] }
sensor = { psf = 0.7, bits = 12 }
[[truth.camera]]
name = "front"
initial.pan_deg = 0
)";

class MeasuredArm : public LiveSessionTest {
 protected:
  explicit MeasuredArm(const std::string& text = measured_text) : LiveSessionTest(text) {
    for (const char* camera : {"front", "side"}) ask(ImagesRequest{camera, 30, 80});
    pass(0.2);
  }
  static std::vector<Eigen::Vector2d> points_of(const Node& layer) {
    std::vector<Eigen::Vector2d> points;
    for (const Node& point : *layer.find("points")->as<Node::Array>()) {
      const auto& pair = *point.as<Node::Array>();
      points.emplace_back(*pair[0].as<double>(), *pair[1].as<double>());
    }
    return points;
  }
  static std::vector<const Node*> layers_of(const ViewAnswer& answer, const std::string& id) {
    std::vector<const Node*> layers;
    for (const Node& layer : *answer.result.find("layers")->as<Node::Array>())
      if (*layer.find("id")->as<std::string>() == id) layers.push_back(&layer);
    return layers;
  }
};

// Compared with the true arm through the true camera.
TEST_F(MeasuredArm, LiesUnderItsLayers) {
  for (const char* camera : {"front", "side"}) {
    const ViewAnswer answer = ask(MeasureRequest{camera, {}});
    ASSERT_EQ(answer.error, "");
    ASSERT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
    const std::size_t place = *rig_->camera(camera);
    const std::string image = last_image(me, static_cast<std::uint32_t>(1 + place));
    EXPECT_EQ(*answer.result.find("number")->as<std::int64_t>(), static_cast<unsigned char>(image[4]));
    const CameraStance stance = rig_->first_stance(place);
    const View view = rig_->cameras[place].view(stance);
    const Backbone backbone = rig_->truth.backbone(rig_->initial);
    std::vector<Eigen::Vector2d> truth;
    for (int i = 0; i <= 1000; ++i)
      truth.push_back(*view.project(backbone.pose(1e-3 * i * backbone.length()).position));
    const auto distance = [&](const Eigen::Vector2d& pixel) {
      double nearest = 1e9;
      for (const Eigen::Vector2d& point : truth) nearest = std::min(nearest, (point - pixel).norm());
      return nearest;
    };
    const auto axis = points_of(*layers_of(answer, "axis").at(0));
    ASSERT_GT(axis.size(), 50);
    for (const Eigen::Vector2d& point : axis)
      EXPECT_LT(distance(point), 0.7) << camera << " " << point.transpose();
    ASSERT_GE(layers_of(answer, "silhouette").size(), 2);
    for (const Node* side : layers_of(answer, "silhouette"))
      for (const Eigen::Vector2d& point : points_of(*side)) EXPECT_NEAR(distance(point), 7.3, 2.5);
    EXPECT_EQ(layers_of(answer, "mask").size(), 1);
  }
  const ViewAnswer answer = ask(MeasureRequest{"front", {}});
  const auto markers = points_of(*layers_of(answer, "markers").at(0));
  EXPECT_GE(markers.size(), 5) << "of three bands a section; one may be seen too much from its end";
  EXPECT_LE(markers.size(), 6);
  const Backbone backbone = rig_->truth.backbone(rig_->initial);
  const CameraStance stance = rig_->first_stance(0);
  const View view = rig_->cameras[0].view(stance);
  const auto look = rig_->experiment.arm.look.markers(rig_->truth.driven());
  for (const Eigen::Vector2d& seen : markers) {
    const bool is_one = std::ranges::any_of(look, [&](const Marker& marker) {
      return (*view.project(backbone.pose(marker.at).position) - seen).norm() < 1;
    });
    EXPECT_TRUE(is_one) << seen.transpose();
  }
  const ViewAnswer few = ask(MeasureRequest{"front", {{"axis"}}});
  EXPECT_EQ(few.result.find("layers")->as<Node::Array>()->size(), 1);
}

// The chosen region and colour replace those of the experiment in this request only.
TEST_F(MeasuredArm, IsSearchedWhereTheClientSays) {
  MeasureRequest request{"front", {{"axis"}}};
  const auto top = [&] {
    double least = 1e9;
    for (const Eigen::Vector2d& point : points_of(*layers_of(ask(request), "axis").at(0)))
      least = std::min(least, point.y());
    return least;
  };
  const double whole = top();
  request.seeing.emplace().region = {{0, 240}, {639, 479}};
  EXPECT_GT(top(), 235) << "the lower half only";
  request.seeing->region = {{0, 240}, {639, 240}, {639, 479}, {0, 479}};
  EXPECT_GT(top(), 235);
  request.seeing->region = {{1000, 1000}, {2000, 2000}};
  const ViewAnswer outside = ask(request);
  EXPECT_EQ(outside.error, "");
  EXPECT_THAT(*outside.result.find("reason")->as<std::string>(), HasSubstr("the region has fewer"));
  request.seeing.reset();
  EXPECT_EQ(top(), whole) << "nothing is kept";
  EXPECT_EQ(ask(ColorRequest{"front", 320, 240}).error, "");
  EXPECT_THAT(ask(ColorRequest{"side", 320, 240}).error, HasSubstr("gray"));
  ShapeRequest shape;
  shape.seeing.resize(1);
  shape.seeing[0].camera = "front";
  shape.seeing[0].region = {{1000, 1000}, {2000, 2000}};
  EXPECT_THAT(write_json(*ask(shape).result.find("notes")), HasSubstr("camera front: the region has fewer"));
  shape.seeing[0].camera = "back";
  EXPECT_THAT(ask(shape).error, HasSubstr("there is no camera with this name"));
}

TEST_F(MeasuredArm, HasAMaskWithinTheRegion) {
  MeasureRequest request{"front", {{"mask"}}};
  const auto rows = [&] {
    return layers_of(ask(request), "mask").at(0)->find("rows")->as<Node::Array>()->size();
  };
  const std::size_t whole = rows();
  request.seeing.emplace().region = {{0, 240}, {639, 479}};
  EXPECT_LT(rows(), whole);
  const Node::Array all = *layers_of(ask(request), "mask").at(0)->find("rows")->as<Node::Array>();
  for (const Node& row : all) EXPECT_GE(*row.as<Node::Array>()->at(0).as<std::int64_t>(), 240);
}

// Bent in a plane parallel to the front camera's image.
TEST_F(MeasuredArm, LiesOnTheCircleThatItsArcIs) {
  ask(bends({{-0.8, 0}, {-0.8, 0}}));
  pass(0.5);
  ask(AckRequest{"front", static_cast<unsigned char>(last_image(me, 1)[4])});
  pass(0.2);
  const ViewAnswer answer = ask(MeasureRequest{"front", {{"circle"}}});
  const Node* circle = layers_of(answer, "circle").at(0);
  const double radius = 0.5 / 0.8, distance = 2.2;
  const CameraStance stance = rig_->first_stance(0);
  const View view = rig_->cameras[0].view(stance);
  const auto& axes = *circle->find("axes")->as<Node::Array>();
  EXPECT_NEAR(*axes[0].as<double>(), view.lens.intrinsics().fx * radius / distance, 0.5);
  EXPECT_EQ(*axes[1].as<double>(), *axes[0].as<double>());
  const Eigen::Vector2d center = *view.project({-radius, 0, 0});
  const auto& seen = *circle->find("center")->as<Node::Array>();
  EXPECT_NEAR(*seen[0].as<double>(), center.x(), 0.5);
  EXPECT_NEAR(*seen[1].as<double>(), center.y(), 0.5);
  EXPECT_TRUE(*circle->find("verified")->as<bool>());
  // A straight arm has no circle.
  ask(bends({{0, 0}, {0, 0}}));
  pass(0.5);
  ask(AckRequest{"front", static_cast<unsigned char>(last_image(me, 1)[4])});
  pass(0.2);
  EXPECT_TRUE(layers_of(ask(MeasureRequest{"front", {{"circle"}}}), "circle").empty());
}

TEST_F(MeasuredArm, IsFoundInTwoPicturesAsItStands) {
  const ViewAnswer answer = ask(ShapeRequest{});
  ASSERT_EQ(answer.error, "");
  ASSERT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
  EXPECT_EQ(answer.result.find("numbers")->as<Node::Array>()->size(), 2);
  const Node::Array& tip = *answer.result.find("poses")->as<Node::Array>()->back().as<Node::Array>();
  const Eigen::Vector3d truth = tip_pose(rig_->truth.driven(), rig_->initial).position;
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(*tip[static_cast<std::size_t>(i)].as<double>(), truth[i], 2e-3);
  EXPECT_LT(*answer.result.find("rms_px")->as<double>(), 0.5);
  EXPECT_EQ(write_json(*answer.result.find("notes")), "[]");
}

TEST_F(MeasuredArm, IsMeasuredInTheNewestOfManyPictures) {
  background_.is_prompt = false;
  std::vector<std::string> ends;
  for (const char* name : {"first: ", "second: ", "third: "}) {
    session_.take(me, MeasureRequest{"front", {}}, [&ends, name](const ViewAnswer& answer) {
      ends.push_back(name + (answer.error.empty() ? std::string("done") : answer.error));
    });
  }
  EXPECT_THAT(ends, ::testing::ElementsAre("second: replaced by a newer request"));
  EXPECT_EQ(background_.jobs[Lane::measures], 1);
  background_.work();
  EXPECT_EQ(background_.jobs[Lane::measures], 2);
  EXPECT_EQ(ends.back(), "third: done");
}

TEST_F(MeasuredArm, IsNotThereWhereTheCameraLooksAway) {
  ask(HeadRequest{"front", 1.2, {}, {}});
  pass(4);
  ask(AckRequest{"front", static_cast<unsigned char>(last_image(me, 1)[4])});
  pass(0.1);
  const ViewAnswer answer = ask(MeasureRequest{"front", {}});
  EXPECT_FALSE(*answer.result.find("found")->as<bool>());
  EXPECT_NE(*answer.result.find("reason")->as<std::string>(), "");
  EXPECT_TRUE(answer.result.find("layers")->as<Node::Array>()->empty());
}

class ThickerArm : public MeasuredArm {
 protected:
  ThickerArm()
      : MeasuredArm(measured_text +
                    "[[truth.arm.section]]\nradius = 0.026\n[[truth.arm.section]]\nradius = 0.026\n") {}
};

// The distortion of the front camera's model folds back within the picture.
class FoldedPicture : public MeasuredArm {
 protected:
  FoldedPicture()
      : MeasuredArm(
            replaced(measured_text, "sensor = {", "lens = { distortion = [-5, 0, 0, 0, 0] }\nsensor = {") +
            "lens = { distortion = [0, 0, 0, 0, 0] }\n") {}
};

TEST_F(FoldedPicture, SaysThatPixelsHaveNoRay) {
  EXPECT_THAT(write_json(ask(ShapeRequest{}).result),
              HasSubstr("camera front: the camera's distortion has no ray for some pixels of the arm"));
  const ViewAnswer answer = ask(MeasureRequest{"front", {{"axis", "circle"}}});
  EXPECT_THAT(write_json(answer.result), HasSubstr("there the axis is its middle"));
  EXPECT_EQ(layers_of(answer, "axis").size(), 1);
}

TEST_F(ThickerArm, IsFoundWithAWordOnItsRadius) {
  const ViewAnswer answer = ask(ShapeRequest{});
  ASSERT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
  EXPECT_THAT(write_json(*answer.result.find("notes")), HasSubstr("show an arm with a radius of 0.026 m"));
}

}  // namespace
}  // namespace flexura
