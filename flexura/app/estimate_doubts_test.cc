#include "flexura/app/estimate_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "flexura/app/picture_doubts.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

using testing::HasSubstr;

View seen_from_origin() {
  const Intrinsics lens{.fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5};
  return {Lens(lens), Pose{}, 640, 480};
}

// Two sections, bent, some two metres before the camera.
Shape shape_of(double radius) {
  Shape shape;
  shape.arm.kind = ArmKind::spatial;
  shape.arm.X_WB.position = {-0.3, -0.3, 2};
  shape.arm.X_WB.rotation = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitY()).toRotationMatrix();
  shape.arm.sections.resize(2, {.length = 0.4, .radius = {radius, radius}});
  shape.state.bends = {{0.3, -0.5}, {0.7, 0.2}};
  shape.state.stretches = {1, 1};
  return shape;
}

// The edges of a tube along it.
Sighting edges_of(const Shape& shape, double radius) {
  Sighting seen;
  seen.view = seen_from_origin();
  const Backbone backbone(shape.arm, shape.state);
  for (double s = 0.02; s < backbone.length(); s += 0.02) {
    const Pose pose = backbone.pose(s);
    const Eigen::Vector3d aside = pose.rotation.col(2).cross(pose.position).normalized();
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
      seen.edges.at(side).push_back(
          {seen.view.project(pose.position + (side == 0 ? radius : -radius) * aside).value(), 0.02});
  }
  return seen;
}

TEST(EstimateDoubts, TellTheRadiusThatIsSeen) {
  const Shape described = shape_of(0.024);
  const std::array<Sighting, 1> other = {edges_of(described, 0.018)}, same = {edges_of(described, 0.023)};
  EXPECT_THAT(doubt_of_radius(other, described).value_or(""),
              HasSubstr("show an arm of 0.018 m radius, its file has 0.024 m"));
  EXPECT_EQ(doubt_of_radius(same, described), std::nullopt);
  Shape tapered = described;
  tapered.arm.sections[1].radius = {0.024, 0.012};
  const std::array<Sighting, 1> twice = {edges_of(described, 0.048)};
  EXPECT_THAT(doubt_of_radius(twice, tapered).value_or(""), HasSubstr("times as thick as it is described"));
  // An arm without a radius, or of which no edge is seen, says nothing.
  EXPECT_EQ(doubt_of_radius(other, shape_of(0)), std::nullopt);
  std::array<Sighting, 1> none;
  none[0].view = seen_from_origin();
  EXPECT_EQ(doubt_of_radius(none, described), std::nullopt);
}

TEST(EstimateDoubts, TellWhereTheBaseWouldBe) {
  std::array<Sighting, 2> seen;
  for (Sighting& one : seen) one.view = seen_from_origin();
  const Eigen::Vector3d base(-0.3, -0.3, 2);
  const Eigen::Vector2d there = seen[0].view.project(base).value();
  EXPECT_EQ(doubt_of_base(seen, base), std::nullopt) << "nothing is seen";
  seen[0].points = {{there + Eigen::Vector2d(30, 0), 0.02}, {there + Eigen::Vector2d(200, 0), 0.02}};
  seen[1].points = {{there + Eigen::Vector2d(200, 0), 0.02}};
  EXPECT_THAT(doubt_of_base(seen, base).value_or(""), HasSubstr("of picture 2, 200 px from the arm there"));
  seen[1].borders = {{there + Eigen::Vector2d(0, 39), 0.02}};
  EXPECT_EQ(doubt_of_base(seen, base), std::nullopt);
  seen[1].borders.clear();
  EXPECT_EQ(doubt_of_base(seen, {-3, -0.3, 2}), std::nullopt) << "beside both";
}

TEST(EstimateDoubts, TellForWhichSizeOfPicturesACameraIsDescribed) {
  View view = seen_from_origin();
  EXPECT_EQ(doubt_of_size(view), std::nullopt);
  view.width = 320, view.height = 240;
  EXPECT_THAT(doubt_of_size(view).value_or(""), HasSubstr("of another size, 2 times as large?"));
  // A part of a picture is no picture of another size.
  view.width = 400, view.height = 480;
  EXPECT_THAT(doubt_of_size(view).value_or(""), HasSubstr("of another size?"));
}

}  // namespace
}  // namespace flexura
