#include "flexura/report/arm_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

TEST(ArcPoints, FollowTheArcAndStandAside) {
  const PlotFrame frame = {{-2.0, 2.0}, {-2.0, 2.0}, {10.0, 20.0}, {400.0, 400.0}};
  for (const double bend : {0.0, 1e-9, 0.3, -2.0, 7.0}) {
    SCOPED_TRACE(bend);
    Arm arm;
    arm.sections.resize(1);
    ArmState state = ArmState::straight(1);
    state.bends[0].x() = bend;
    const Backbone backbone(arm, state);
    const Arc& arc = backbone.arcs()[0];
    for (const double aside : {0.0, 6.0}) {
      const auto points = arc_points(arc, PlotView::xoy, frame, {aside, aside});
      EXPECT_TRUE(bend != 0.0 || points.size() == 2);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Eigen::Vector2d middle = (points[i] + points[i + 1]) / 2;
        double nearest = 1e9;
        for (int k = 0; k <= 4000; ++k) {
          const Eigen::Vector2d at =
              frame.page(seen(PlotView::xoy, arc.pose(arc.length * k / 4000).position));
          nearest = std::min(nearest, (middle - at).norm());
        }
        EXPECT_NEAR(nearest, aside, 0.15);
      }
    }
    const auto left = arc_points(arc, PlotView::xoy, frame, {3.0, 5.0});
    const auto middle = arc_points(arc, PlotView::xoy, frame);
    EXPECT_NEAR((left.front() - middle.front()).norm(), 3.0, 1e-9);
    EXPECT_NEAR((left.back() - middle.back()).norm(), 5.0, 1e-9);
  }
}

TEST(LiesInXoy, AsksForAPlanarArmWithItsPlaneUpright) {
  Arm arm;
  EXPECT_TRUE(lies_in_xoy(arm));
  arm.kind = ArmKind::spatial;
  EXPECT_FALSE(lies_in_xoy(arm));
  arm.kind = ArmKind::planar;
  arm.X_WB.rotation = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(lies_in_xoy(arm)) << "its plane is ZOX";
}

}  // namespace
}  // namespace flexura
