#include "flexura/calibrate/arc_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm three_sections() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (const double length : {0.35, 0.35, 0.3}) {
    Section& section = arm.sections.emplace_back();
    section.length = length, section.max_bend = 2;
  }
  return arm;
}

TEST(ArcState, IsOneArcOfACircleInItsPlane) {
  const Arm arm = three_sections();
  for_random_cases(100, [&](TestRandom& random) {
    const double bend = random.uniform(0.3, 4), way = random.uniform(-3, 3);
    const Eigen::Vector3d towards(std::cos(way), 0, std::sin(way));
    const auto state = arc_state(arm, bend, towards);
    ASSERT_TRUE(state);
    const Backbone backbone(arm, *state);
    const double radius = arm.length() / bend;
    const Eigen::Vector3d center = radius * towards;
    for (int i = 0; i <= 20; ++i) {
      const Eigen::Vector3d p = backbone.pose(arm.length() * i / 20).position;
      EXPECT_NEAR((p - center).norm(), radius, 1e-12);
      EXPECT_NEAR(p.dot(towards.cross(Eigen::Vector3d::UnitY())), 0, 1e-12);
    }
  });
}

TEST(ArcState, IsNoneWhereTheArmCannot) {
  Arm arm = three_sections();
  EXPECT_FALSE(arc_state(arm, 6.1, Eigen::Vector3d::UnitX()));  // A section bends by 2 rad at most.
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitY()));
  arm.kind = ArmKind::planar;
  EXPECT_TRUE(arc_state(arm, 1, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitZ()));
}

// Two cameras, and markers on arcs in two planes as they see them with an arm that is wrong by `wrong` times
// what is allowed for.
struct ArcTrial {
  explicit ArcTrial(TestRandom& random, double wrong, double noise) {
    const Arm arm = three_sections();
    Arm true_arm = arm;
    std::vector<double> gains;
    for (Section& section : true_arm.sections) {
      section.length *= 1 + wrong * random.uniform(-0.005, 0.005);
      gains.push_back(1 + wrong * random.uniform(-0.01, 0.01));
    }
    Eigen::Matrix3d front, side;
    front << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    side << 0, 0, 1, 0, -1, 0, 1, 0, 0;
    believed[0].rotation = front, believed[0].position = {0.3, 0.4, 2.5};
    believed[1].rotation = side, believed[1].position = {-2.5, 0.4, -0.3};
    for (std::size_t i = 0; i < 2; ++i) {
      truth[i] = believed[i];
      truth[i].position += random.vector<3>(-0.2, 0.2);
      truth[i].rotation = believed[i].rotation * so3_exp(random.vector<3>(-0.15, 0.15));
    }
    for (const Eigen::Vector3d& towards :
         {Eigen::Vector3d::UnitX().eval(), (-Eigen::Vector3d::UnitZ()).eval()}) {
      const ArmState state = *arc_state(arm, std::numbers::pi / 2, towards);
      ArmState bent = state;
      for (std::size_t j = 0; j < 3; ++j) bent.bends[j] *= gains[j];
      const Backbone backbone(true_arm, bent);
      for (std::size_t i = 0; i < 2; ++i) {
        ArcPicture& picture = pictures.emplace_back(ArcPicture{i, Pose{}, state, {}});
        for (int k = 0; k < 12; ++k) {
          const double s = (k + 0.5) / 12;
          const double along = arc_length_of(true_arm, bent, material_point(arm, s));
          const auto pixel = Lens(lens).project(truth[i].inverse() * backbone.pose(along).position);
          if (pixel)
            picture.markers.push_back(
                {*pixel + noise * Eigen::Vector2d(normal_number(random), normal_number(random)), s, 0.2});
        }
      }
    }
  }
  Intrinsics lens;
  std::array<Pose, 2> believed, truth;
  std::vector<ArcPicture> pictures;
};

TEST(ArcFit, IsExactForAnArmThatIsRightAndPicturesWithoutNoise) {
  for_random_cases(20, [](TestRandom& random) {
    const ArcTrial trial(random, 0, 0);
    const ArcFit fit = fit_arcs(three_sections(), {trial.lens, trial.lens}, trial.pictures, trial.believed);
    ASSERT_EQ(fit.reason, "");
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((fit.X_WM[i].position - trial.truth[i].position).norm(), 1e-5);
      EXPECT_LT((fit.X_WM[i].rotation - trial.truth[i].rotation).norm(), 1e-5);
    }
  });
}

TEST(ArcFit, TurnsAreAsWrongAsItSays) {
  double squares = 0;
  int count = 0;
  for_random_cases(40, [&](TestRandom& random) {
    const ArcTrial trial(random, 1, 0.2);
    const ArcFit fit = fit_arcs(three_sections(), {trial.lens, trial.lens}, trial.pictures, trial.believed);
    ASSERT_EQ(fit.reason, "");
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d turn = so3_log(fit.X_WM[i].rotation * trial.truth[i].rotation.transpose());
      squares += turn.y() * turn.y() / (fit.turn_sigma[i] * fit.turn_sigma[i]), ++count;
      EXPECT_LT(std::abs(turn.y()), 6 * fit.turn_sigma[i]);
    }
  });
  // Evenly within what is taken for a standard deviation here: smaller than claimed.
  EXPECT_LT(std::sqrt(squares / count), 1.3);
  EXPECT_GT(std::sqrt(squares / count), 0.3);
}

TEST(ArcFit, RefusesMarkersThatFitNothing) {
  TestRandom random(3);
  ArcTrial trial(random, 0, 0);
  for (ArcPicture& picture : trial.pictures)
    for (SeenMarker& marker : picture.markers) marker.pixel = 300 * random.vector<2>(0, 2);
  EXPECT_NE(fit_arcs(three_sections(), {trial.lens, trial.lens}, trial.pictures, trial.believed).reason, "");
  trial.pictures.resize(1);
  trial.pictures[0].markers.resize(2);
  EXPECT_NE(fit_arcs(three_sections(), {trial.lens, trial.lens}, trial.pictures, trial.believed).reason, "");
}

}  // namespace
}  // namespace flexura
