#include "flexura/kinematics/planar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

using std::numbers::pi;

std::vector<double> lengths(const Arm& arm) {
  std::vector<double> result;
  result.reserve(arm.sections.size());
  for (const Section& section : arm.sections) result.push_back(section.length);
  return result;
}

// Returns E of the paper's arm, with the cord angles a fraction of the way from upright to their final
// values.
Eigen::Vector2d paper_end_effector(double fraction) {
  std::vector<double> cord_angles;
  for (const double final_angle : paper_cord_angles()) {
    cord_angles.push_back((1.0 - fraction) * pi / 2 + fraction * final_angle);
  }
  const std::vector<double> archings = archings_from_cord_angles(cord_angles, pi / 2);
  return base_points(lengths(paper_arm()), archings, {0.0, 0.0}, pi / 2).back();
}

TEST(Planar, ThePapersArmHasThePapersArchings) {
  const std::vector<double> archings = archings_from_cord_angles(paper_cord_angles(), pi / 2);
  const std::vector<double> expected = {.05, .05, .1, .1, .05, -.3, .2, -.35};
  ASSERT_EQ(archings.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(archings[i] / pi, expected[i], 2e-15) << i;
}

TEST(Planar, ThePapersArmEndsWhereThePaperSays) {
  const Eigen::Vector2d E = paper_end_effector(1.0);
  EXPECT_NEAR(E.x(), -10.737859, 5e-7);
  EXPECT_NEAR(E.y(), 5.201359, 5e-7);
}

TEST(Planar, ThePapersArmPassesItsIntermediatePoints) {
  const auto expect_near = [](double fraction, double x, double y) {
    EXPECT_NEAR(paper_end_effector(fraction).x(), x, 5e-7) << fraction;
    EXPECT_NEAR(paper_end_effector(fraction).y(), y, 5e-7) << fraction;
  };
  expect_near(0.0, 0.0, 16.0);
  expect_near(0.25, -4.343670, 15.116249);
  expect_near(0.5, -7.924923, 12.648849);
  expect_near(0.75, -10.152819, 9.106058);
}

TEST(Planar, ReadingEquation5BackwardsUndoesIt) {
  for_random_cases(100, [](TestRandom& random) {
    std::vector<double> archings(static_cast<std::size_t>(random.integer(1, 10)));
    for (double& arching : archings) arching = random.uniform(-2 * pi, 2 * pi);
    const double base_tangent = random.uniform(-pi, pi);
    const std::vector<double> back =
        archings_from_cord_angles(cord_angles_from_archings(archings, base_tangent), base_tangent);
    for (std::size_t i = 0; i < archings.size(); ++i) EXPECT_NEAR(back[i], archings[i], 1e-12);
  });
}

TEST(Planar, AnErrorInOneCordAlternatesWithGain2) {
  std::vector<double> cord_angles(5, pi / 2);
  cord_angles[1] += 0.01;
  const std::vector<double> archings = archings_from_cord_angles(cord_angles, pi / 2);
  const std::vector<double> expected = {0.0, 0.01, -0.02, 0.02, -0.02};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(archings[i], expected[i], 1e-15) << i;
}

TEST(Planar, ANoisyCordIsFivefoldInTheArchingOfTheEighthSection) {
  // Independent errors of equal size in every cord: the root of the sum of their squared effects.
  double squares = 0.0;
  const std::vector<double> exact = archings_from_cord_angles(paper_cord_angles(), pi / 2);
  for (std::size_t i = 0; i < 8; ++i) {
    auto noisy = paper_cord_angles();
    constexpr double error = 1e-3;
    noisy[i] += error;
    const double effect = (archings_from_cord_angles(noisy, pi / 2)[7] - exact[7]) / error;
    squares += effect * effect;
  }
  EXPECT_NEAR(std::sqrt(squares), std::sqrt(1.0 + 7 * 4.0), 1e-9);  // Its own cord, and twice each before it.
  EXPECT_NEAR(std::sqrt(squares), 5.39, 5e-3);
}

TEST(Planar, Equations9And10AsPrintedEndElsewhere) {
  // Every cord at the angle that eq. 5 gives for n = 8, the end effector, which has no arching of its own.
  const Arm arm = paper_arm();
  const std::vector<double> archings = archings_from_cord_angles(paper_cord_angles(), pi / 2);
  double angle = pi / 2;
  double sum = 0.0;
  for (std::size_t i = 0; i < 8; ++i) {
    angle += 2 * archings[i];
    sum += arm.sections[i].length * std::sin(archings[i]) / archings[i];
  }
  EXPECT_NEAR(sum * std::cos(angle), 9.038, 5e-4);
  EXPECT_NEAR(sum * std::sin(angle), 12.440, 5e-4);
  // With the angle of the section that is being summed, the sum is the paper's E.
  EXPECT_NEAR(paper_end_effector(1.0).x(), -10.738, 5e-4);
  EXPECT_NEAR(paper_end_effector(1.0).y(), 5.201, 5e-4);
}

TEST(Planar, AgreesWithTheSpatialArmInItsPlane) {
  for_random_cases(200, [](TestRandom& random) {
    Arm arm;
    std::vector<double> archings;
    for (int i = random.integer(1, 8); i > 0; --i) {
      arm.sections.emplace_back().length = random.uniform(0.1, 4.0);
      archings.push_back(random.uniform(-1.0, 1.0) * (random.integer(0, 3) == 0 ? 1e-12 : 1.5 * pi));
    }
    ArmState state = ArmState::straight(archings.size());
    for (std::size_t i = 0; i < archings.size(); ++i) state.bends[i] = bend_from_arching(archings[i]);
    std::vector<Pose> frames(archings.size() + 1);
    section_frames(arm, state, frames);
    const std::vector<Eigen::Vector2d> points = base_points(lengths(arm), archings, {0.0, 0.0}, pi / 2);
    ASSERT_EQ(points.size(), frames.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(frames[i].position.x(), points[i].x(), 1e-13);
      EXPECT_NEAR(frames[i].position.y(), points[i].y(), 1e-13);
      EXPECT_EQ(frames[i].position.z(), 0.0);
    }
  });
}

TEST(Planar, BendsAndArchingsAreOneAnother) {
  EXPECT_EQ(bend_from_arching(0.3), Eigen::Vector2d(-0.6, 0.0));
  EXPECT_EQ(arching_from_bend(bend_from_arching(0.3)), 0.3);
  EXPECT_FALSE(std::signbit(bend_from_arching(0.0).x()));
  EXPECT_THROW((void)arching_from_bend({0.1, 1e-9}), std::invalid_argument);
}

TEST(Planar, RefusesLengthsAndArchingsThatDoNotMatch) {
  const std::vector<double> one = {1.0};
  const std::vector<double> two = {0.1, 0.2};
  EXPECT_THROW((void)base_points(one, two, {0.0, 0.0}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
