#include "flexura/estimate/shape_hint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "flexura/model/backbone.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

View seen_from_origin() {
  const Intrinsics lens{.fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5};
  return {Lens(lens), Pose{}, 640, 480};
}

// Two bent sections, some two metres in front of the camera.
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
Observation edges_of(const Shape& shape, double radius) {
  Observation seen;
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

// Returns the hint if the arm of this shape is found.
std::string found_hint(std::span<const Observation> observations, const Shape& shape) {
  ShapeEstimate estimate;
  estimate.is_found = true, estimate.shape = shape;
  return hint_of({.arm = shape.arm}, observations, estimate).value_or("none");
}

TEST(ShapeHint, TellsTheRadiusThatIsSeen) {
  const Shape described = shape_of(0.024);
  const std::array<Observation, 1> other = {edges_of(described, 0.018)}, same = {edges_of(described, 0.023)};
  EXPECT_THAT(found_hint(other, described),
              HasSubstr("show an arm with a radius of 0.018 m, but its file has 0.024 m"));
  EXPECT_EQ(found_hint(same, described), "none");
  Shape tapered = described;
  tapered.arm.sections[1].radius = {0.024, 0.012};
  const std::array<Observation, 1> twice = {edges_of(described, 0.048)};
  EXPECT_THAT(found_hint(twice, tapered), HasSubstr("times as thick as in its file"));
  // No hint for an arm without a radius or without visible edges.
  EXPECT_EQ(found_hint(other, shape_of(0)), "none");
  std::array<Observation, 1> none;
  none[0].view = seen_from_origin();
  EXPECT_EQ(found_hint(none, described), "none");
}

TEST(ShapeHint, TellsWhereTheBaseWouldBe) {
  std::array<Observation, 2> seen;
  for (Observation& one : seen) one.view = seen_from_origin();
  ShapePrior prior{.arm = shape_of(0.024).arm};
  const auto hint = [&] { return hint_of(prior, seen, ShapeEstimate{}).value_or("none"); };
  const Eigen::Vector2d there = seen[0].view.project(prior.arm.X_WB.position).value();
  EXPECT_EQ(hint(), "none") << "nothing is seen";
  seen[0].points = {{there + Eigen::Vector2d(30, 0), 0.02}, {there + Eigen::Vector2d(200, 0), 0.02}};
  seen[1].points = {{there + Eigen::Vector2d(200, 0), 0.02}};
  EXPECT_THAT(hint(), HasSubstr("in picture 2, 200 px from the arm"));
  seen[1].borders = {{there + Eigen::Vector2d(0, 39), 0.02}};
  EXPECT_EQ(hint(), "none");
  seen[1].borders.clear();
  prior.is_base_position_known = false;
  EXPECT_EQ(hint(), "none");
  prior.is_base_position_known = true, prior.arm.X_WB.position = {-3, -0.3, 2};
  EXPECT_EQ(hint(), "none") << "beside both";
  prior.arm.X_WB.position = {0, 0, -1};
  EXPECT_THAT(hint(), HasSubstr("the base is behind the camera of picture 1"));
}

TEST(ShapeHint, TellsAWrongUnitOfLengths) {
  TestRandom random(5);
  const Arm arm = three_section_arm();
  const Backbone truth(arm, random_bends(random, arm, 1.2));
  const std::vector<Observation> seen = observations_of(truth, random, 0.05);
  const auto hint = [](const Arm& described, std::span<const Observation> observations) {
    const ShapePrior prior = described_arm(described);
    const ShapeEstimate estimate = ShapeEstimator(prior).estimate(observations);
    EXPECT_FALSE(estimate.is_found);
    return hint_of(prior, observations, estimate).value_or("none");
  };
  Arm long_arm = arm;
  for (Section& section : long_arm.sections) section.length *= 1000;
  EXPECT_THAT(hint(long_arm, seen), HasSubstr("are the lengths of the arm in mm"));
  std::vector<Observation> far = seen;
  for (Observation& one : far) one.view.X_WC.position *= 100;
  Arm far_arm = arm;
  far_arm.X_WB.position *= 100;
  EXPECT_THAT(hint(far_arm, far), HasSubstr("are the positions of the cameras in cm"));
  // No unit explains twice the length.
  Arm twice = arm;
  for (Section& section : twice.sections) section.length *= 2;
  EXPECT_THAT(hint(twice, seen),
              AllOf(HasSubstr("m of an arm, but its length is given as"), Not(HasSubstr("Expected m"))));
}

}  // namespace
}  // namespace flexura
