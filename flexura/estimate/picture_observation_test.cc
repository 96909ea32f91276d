#include "flexura/estimate/picture_observation.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"

namespace flexura {
namespace {

// A straight axis along a row, 10 px wide, bridged from 30 to 70 px except for `chance` samples in the
// middle.
ArmObservation bridged_axis(std::size_t chance) {
  ArmObservation arm;
  arm.blur = 0.8, arm.covered = 1;
  for (std::size_t i = 0; i < 100; ++i) {
    AxisSample& sample = arm.axis.emplace_back();
    sample.pixel = {100.0 + static_cast<double>(i), 200}, sample.normal = {0, 1};
    sample.width = 10, sample.sigma = 0.01;
    sample.is_seen = i < 30 || i >= 70 || (i >= 50 && i < 50 + chance);
  }
  return arm;
}

// The axis of a foreshortened arm may meet a tube-like structure for a pixel or two, far from the arm.
TEST(PictureObservation, LeavesOutWhatIsSeenByChanceBetweenTwoBridges) {
  EXPECT_EQ(observation_of(bridged_axis(0), View{}).points.size(), 60U);
  const Observation few = observation_of(bridged_axis(3), View{});
  EXPECT_EQ(few.points.size(), 60U);
  EXPECT_EQ(few.edges[0].size(), 60U);
  EXPECT_EQ(few.edges[1].size(), 60U);
  EXPECT_EQ(observation_of(bridged_axis(8), View{}).points.size(), 68U);
}

// Noise hides single samples anywhere; those in between still count.
TEST(PictureObservation, KeepsWhatIsSeenBetweenShortBridges) {
  ArmObservation arm = bridged_axis(40);
  for (std::size_t i = 0; i < arm.axis.size(); i += 3) arm.axis[i].is_seen = false;
  EXPECT_EQ(observation_of(arm, View{}).points.size(), 53U);
}

// Pixels where distortion folds the image back have no ray and are not points of the backbone.
TEST(PictureObservation, LeavesOutWhatTheLensHasNoRayFor) {
  const ArmObservation arm = bridged_axis(40);
  View view;
  view.lens = Lens({.fx = 400, .fy = 400, .cx = 199.5, .cy = 200, .distortion = {-5, 0, 0, 0, 0}});
  const auto has_ray = [&](const Eigen::Vector2d& pixel) { return view.lens.unproject(pixel).has_value(); };
  const Observation seen = observation_of(arm, view), whole = observation_of(arm, View{});
  EXPECT_GT(seen.points.size(), 20U);
  EXPECT_LT(seen.points.size(), 80U);
  EXPECT_EQ(seen.edges[0].size(), seen.points.size());
  EXPECT_EQ(seen.edges[1].size(), seen.points.size());
  EXPECT_TRUE(seen.leaves_out);
  const std::vector<bool> is_backbone = backbone_axis(view.lens, arm.axis).is_backbone;
  std::size_t known = 0;
  for (std::size_t i = 0; i < arm.axis.size(); ++i) known += arm.axis[i].is_seen && is_backbone[i] ? 1 : 0;
  EXPECT_EQ(seen.points.size(), known) << "no more than elsewhere counts as the backbone";
  EXPECT_EQ(whole.points.size(), 80U);
  EXPECT_FALSE(whole.leaves_out);
  for (const CurvePoint& point : seen.points) EXPECT_TRUE(has_ray(point.pixel));
  for (const auto& edge : seen.edges)
    for (const CurvePoint& point : edge) EXPECT_TRUE(has_ray(point.pixel));
}

// There, the arm's ends, its border and its silhouette do not count either.
TEST(PictureObservation, LeavesOutEndsAndBordersWithoutARay) {
  ArmObservation arm = bridged_axis(40);
  arm.ends[0] = {AxisEndKind::free, {100, 200}, 0, 0.2},
  arm.ends[1] = {AxisEndKind::free, {199, 200}, 0, 0.2};
  arm.unexplained = {{.pixel = {100, 195}}, {.pixel = {198, 195}}};
  arm.places = {{101, 200}, {197, 200}};
  View view;
  view.lens = Lens({.fx = 400, .fy = 400, .cx = 199.5, .cy = 200, .distortion = {-5, 0, 0, 0, 0}});
  const Observation seen = observation_of(arm, view), whole = observation_of(arm, View{});
  EXPECT_TRUE(whole.ends[0] && whole.ends[1]);
  EXPECT_FALSE(seen.ends[0]);
  EXPECT_TRUE(seen.ends[1]);
  EXPECT_EQ(whole.borders.size(), 2U);
  ASSERT_EQ(seen.borders.size(), 1U);
  EXPECT_EQ(seen.borders[0].pixel.x(), 198);
  EXPECT_EQ(whole.figure.size(), 2U);
  ASSERT_EQ(seen.figure.size(), 1U);
  EXPECT_EQ(seen.figure[0].x(), 197);
}

// The backbone is where calibration and `measure` expect it.
TEST(PictureObservation, HasTheBackboneAsFarAsTheLensTells) {
  View view;
  view.lens = Lens({.fx = 400, .fy = 400, .cx = 199.5, .cy = 200, .distortion = {-5, 0, 0, 0, 0}});
  ArmObservation arm = bridged_axis(40);
  // Not through the middle, where nothing moves.
  for (AxisSample& sample : arm.axis) sample.pixel.y() += 8, sample.is_seen = true;
  const Observation seen = observation_of(arm, view);
  const std::vector<AxisSample> backbone = backbone_axis(view.lens, arm.axis).known();
  ASSERT_EQ(seen.points.size(), backbone.size());
  ASSERT_GT(backbone.size(), 20U);
  for (std::size_t i = 0; i < backbone.size(); ++i) EXPECT_EQ(seen.points[i].pixel, backbone[i].pixel) << i;
  EXPECT_GT(std::abs(backbone.front().pixel.y() - 208), 0.01);
}

}  // namespace
}  // namespace flexura
