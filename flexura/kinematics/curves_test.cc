#include "flexura/kinematics/curves.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/support/arms.h"

namespace flexura {
namespace {

// Eq. 11 as printed.
Eigen::Vector3d equation_11(double u, double tau, const std::vector<Eigen::Vector3d>& p, std::size_t i) {
  Eigen::Matrix4d M;
  M << 0, 1, 0, 0, -tau, 0, tau, 0, 2 * tau, tau - 3, 3 - 2 * tau, -tau, -tau, 2 - tau, tau - 2, tau;
  Eigen::Matrix<double, 4, 3> geometry;
  for (int k = 0; k < 4; ++k) geometry.row(k) = p[i - 2 + static_cast<std::size_t>(k)].transpose();
  return (Eigen::RowVector4d(1, u, u * u, u * u * u) * M * geometry).transpose();
}

TEST(CatmullRom, IsThePapersEquation11WithReflectedEnds) {
  for_random_cases(50, [](TestRandom& random) {
    std::vector<Eigen::Vector3d> points;
    for (int i = random.integer(2, 6); i > 0; --i) points.push_back(random.vector<3>(-1.0, 1.0));
    const double tau = random.uniform(0.1, 1.0);
    std::vector<Eigen::Vector3d> extended = points;
    extended.insert(extended.begin(), 2.0 * points[0] - points[1]);
    extended.emplace_back(2.0 * points.back() - points[points.size() - 2]);
    const std::vector<CubicBezier> spline = catmull_rom(points, tau);
    ASSERT_EQ(spline.size(), points.size() - 1);
    for (std::size_t i = 0; i < spline.size(); ++i) {
      for (const double u : {0.0, 0.3, 0.5, 0.9, 1.0}) {
        EXPECT_LE((spline[i].at(u) - equation_11(u, tau, extended, i + 2)).norm(), 1e-14);
      }
    }
  });
}

TEST(CatmullRom, OnlyTheStandardTensionKeepsEvenPointsOfALineEven) {
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  EXPECT_NEAR(catmull_rom(points, 0.5)[1].at(0.25).x(), 1.25, 1e-15);
  EXPECT_NEAR(catmull_rom(points, 0.5)[0].at(0.25).x(), 0.25, 1e-15);
  EXPECT_GT(std::abs(catmull_rom(points, 0.3)[1].at(0.25).x() - 1.25), 0.01);
}

// The table of docs/kinematic-model.md: the paper's arm in its final position, length 16.
struct Deviation {
  double distance;  // Share of the arm's length.
  double shorter;   // Share of the arm's length.
};
Deviation of_paper_arm(const std::vector<CubicBezier>& curve) {
  const CurveDeviation found = deviation(curve, Backbone(paper_arm(), paper_state()));
  return {found.distance / 16.0, (16.0 - found.length) / 16.0};
}

TEST(CurveDeviation, OfThePapersSplineThroughTheBasePointsIs1p5PercentAnd2p7Short) {
  const Deviation found = of_paper_arm(catmull_rom(Backbone(paper_arm(), paper_state()), 1));
  EXPECT_NEAR(found.distance, 0.01473, 5e-6);  // 0.236 m.
  EXPECT_NEAR(found.shorter, 0.0271, 5e-5);
}

TEST(CurveDeviation, OfThePapersSplineFallsWithThePointsASection) {
  const Backbone backbone(paper_arm(), paper_state());
  EXPECT_NEAR(of_paper_arm(catmull_rom(backbone, 4)).distance, 9.45e-4, 5e-7);
  EXPECT_NEAR(of_paper_arm(catmull_rom(backbone, 13)).distance, 8.66e-5, 5e-7);
  EXPECT_NEAR(of_paper_arm(catmull_rom(backbone, 4)).shorter, 6.0e-4, 5e-6);
  EXPECT_NEAR(of_paper_arm(catmull_rom(backbone, 13)).shorter, 1.6e-5, 5e-7);
}

TEST(CurveDeviation, OfOneTangentBezierASectionIs6em5) {
  const std::vector<CubicBezier> curve = tangent_bezier(Backbone(paper_arm(), paper_state()));
  EXPECT_EQ(curve.size(), 8u);
  const Deviation found = of_paper_arm(curve);
  EXPECT_NEAR(found.distance, 5.89e-5, 5e-8);
  EXPECT_NEAR(found.shorter, -1.2e-4, 5e-6);  // Longer.
}

TEST(CurveDeviation, SeesACurveThatIsMovedAside) {
  const Backbone backbone(paper_arm(), paper_state());
  std::vector<CubicBezier> curve = tangent_bezier(backbone);
  for (CubicBezier& piece : curve) {
    for (Eigen::Vector3d& point : piece.points) point.z() += 0.25;
  }
  EXPECT_NEAR(deviation(curve, backbone).distance, 0.25, 1e-5);
}

TEST(CurveDeviation, SeesACurveThatRunsOnPastTheBase) {
  Arm arm;
  arm.sections.resize(2);
  ArmState state = ArmState::straight(2);
  state.bends = {{1.0, 0.0}, {1.0, 0.0}};
  const std::vector<CubicBezier> both = tangent_bezier(Backbone(arm, state));
  arm.X_WB = Backbone(arm, state).arcs()[1].X_WS;
  arm.sections.resize(1);
  state = ArmState::straight(1);
  state.bends[0] = {1.0, 0.0};
  EXPECT_NEAR(deviation(both, Backbone(arm, state)).distance, 2.0 * std::sin(0.5), 1e-14);
}

TEST(TangentBezier, HasExactEndsTangentsAndMiddle) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    ArmState state = random_state(random, arm);
    for (Eigen::Vector2d& bend : state.bends) bend *= std::min(1.0, 3.1 / (bend.norm() + 1e-300));
    const Backbone backbone(arm, state);
    const std::vector<CubicBezier> curve = tangent_bezier(backbone);
    ASSERT_EQ(curve.size(), arm.sections.size());
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Arc& arc = backbone.arcs()[i];
      for (const double u : {0.0, 0.5, 1.0}) {
        EXPECT_LE((curve[i].at(u) - arc.pose(u * arc.length).position).norm(), 1e-13);
        const Eigen::Vector3d tangent = curve[i].velocity(u).normalized();
        EXPECT_LE((tangent - arc.pose(u * arc.length).rotation.col(2)).norm(), 1e-13);
      }
    }
  });
}

TEST(TangentBezier, OfAStraightSectionHasHandlesOfAThird) {
  const std::vector<CubicBezier> curve = tangent_bezier(Backbone(paper_arm(), ArmState::straight(8)));
  EXPECT_LE((curve[1].points[1] - Eigen::Vector3d(0, 3, 0)).norm(), 1e-15);
  EXPECT_LE((curve[1].points[2] - Eigen::Vector3d(0, 4, 0)).norm(), 1e-15);
}

TEST(TangentBezier, CutsSectionsBentMoreThanHalfATurn) {
  Arm arm;
  arm.sections.emplace_back().length = 1.0;
  ArmState state = ArmState::straight(1);
  for (const double bend : {3.0, 3.3, 2 * std::numbers::pi, 12.6}) {
    state.bends[0] = {0.0, bend};
    const Backbone backbone(arm, state);
    const std::vector<CubicBezier> curve = tangent_bezier(backbone);
    EXPECT_EQ(curve.size(), static_cast<std::size_t>(std::ceil(bend / std::numbers::pi)));
    EXPECT_LE(deviation(curve, backbone).distance, 0.019 / bend);  // 1.9 % of the radius, at half a turn.
  }
}

TEST(Curves, RefuseWhatIsNoCurve) {
  const Backbone backbone(paper_arm(), paper_state());
  const std::vector<Eigen::Vector3d> one = {{0, 0, 0}};
  EXPECT_THROW((void)catmull_rom(one), std::invalid_argument);
  EXPECT_THROW((void)catmull_rom(backbone, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
