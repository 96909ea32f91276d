#include "flexura/report/arm_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace flexura {
namespace {

using std::numbers::pi;

Arc planar_arc(double bend_x) {
  Arm arm;
  arm.sections.resize(2);
  arm.sections[1].length = 2.0;
  ArmState state = ArmState::straight(2);
  state.bends = {{-0.7, 0.0}, {bend_x, 0.0}};
  return Backbone(arm, state).arcs()[1];
}

// Where a piece of a circle is half way, from its ends, radius and turn alone.
Eigen::Vector2d middle_of(const CirclePiece& piece) {
  const Eigen::Vector2d chord = piece.to - piece.from;
  if (piece.angle == 0.0) return piece.from + chord / 2;
  const double height = piece.radius * (1 - std::cos(piece.angle / 2));
  const Eigen::Vector2d right = Eigen::Vector2d(chord.y(), -chord.x()).normalized();
  return piece.from + chord / 2 + (piece.angle > 0.0 ? height : -height) * right;
}

TEST(CirclePieces, EndWhereKinematicsSaysAndRunAlongTheArc) {
  for (const double bend : {0.0, 1e-12, -1e-6, 0.3, -0.3, pi / 2, -pi, 4.0, -2 * pi, 9.0, -20.0}) {
    SCOPED_TRACE(bend);
    const Arc arc = planar_arc(bend);
    const std::vector<CirclePiece> pieces = circle_pieces(arc);
    const auto count = static_cast<double>(pieces.size());
    EXPECT_EQ(pieces.front().from, seen(PlotView::xoy, arc.X_WS.position));
    EXPECT_LT((pieces.back().to - seen(PlotView::xoy, arc.pose(arc.length).position)).norm(), 1e-9);
    double turn = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_LT(std::abs(pieces[i].angle), pi / 2);
      turn += pieces[i].angle;
      const double middle = arc.length * (static_cast<double>(i) + 0.5) / count;
      EXPECT_LT((middle_of(pieces[i]) - seen(PlotView::xoy, arc.pose(middle).position)).norm(), 1e-9);
    }
    EXPECT_NEAR(turn, -bend, 1e-12) << "bend_x > 0 is clockwise to camera 1";
  }
}

TEST(CirclePieces, TurnTheOtherWayForABaseSeenFromBehind) {
  Arc arc = planar_arc(1.0);
  arc.X_WS.rotation.col(0) *= -1;
  arc.X_WS.rotation.col(1) *= -1;
  EXPECT_GT(circle_pieces(arc).front().angle, 0.0);
}

TEST(BezierPieces, StayWithinFiveMillionthsOfTheRadius) {
  for (const double bend : {1e-9, 0.2, pi / 4, 2.0, 7.0}) {
    Arc arc = planar_arc(0.0);
    arc.bend = {bend * std::cos(0.4), bend * std::sin(0.4)};
    const std::vector<Bezier> pieces = bezier_pieces(arc, PlotView::zoy);
    const auto count = static_cast<double>(pieces.size());
    EXPECT_LT((pieces.back()[3] - seen(PlotView::zoy, arc.pose(arc.length).position)).norm(), 1e-9);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Bezier& b = pieces[i];
      const Eigen::Vector2d middle = (b[0] + 3 * b[1] + 3 * b[2] + b[3]) / 8;
      const double s = arc.length * (static_cast<double>(i) + 0.5) / count;
      EXPECT_LT((middle - seen(PlotView::zoy, arc.pose(s).position)).norm(), 5e-6 * arc.length / bend + 1e-15)
          << bend;
    }
  }
}

TEST(ArcPath, IsALineWhereTheEyeCannotTellAndArcsElsewhere) {
  const PlotFrame frame = {{-5.0, 5.0}, {0.0, 10.0}, {0.0, 0.0}, {400.0, 400.0}};
  EXPECT_EQ(arc_path(planar_arc(1e-9), PlotView::xoy, frame, true).find('A'), std::string::npos);
  const std::string path = arc_path(planar_arc(-1.0), PlotView::xoy, frame, true);
  EXPECT_NE(path.find("A80 80 0 0 0 "), std::string::npos) << path;
  EXPECT_NE(arc_path(planar_arc(1.0), PlotView::xoy, frame, true).find("A80 80 0 0 1 "), std::string::npos);
  EXPECT_NE(arc_path(planar_arc(1.0), PlotView::zoy, frame, false).find('C'), std::string::npos);
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
