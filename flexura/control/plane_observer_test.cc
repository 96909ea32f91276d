#include "flexura/control/plane_observer.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "flexura/base/degree.h"
#include "flexura/control/plane_errors.h"
#include "flexura/control/potential_run.h"
#include "flexura/math/hash.h"
#include "tests/support/distributed_arms.h"

namespace flexura {
namespace {

double no_noise(std::uint64_t) { return 0; }

DistributedArm set_to(DistributedArm arm, const Eigen::VectorXd& x) {
  arm.set(x, Eigen::VectorXd::Zero(arm.size()));
  return arm;
}

// Returns the largest difference between the angles' errors and those in a potential, at the arm's points.
double off(const PlaneObserver& observer, const DistributedArm& arm, const DistributedArm& target) {
  return std::max((observer.e_theta() - (arm.theta() - target.theta())).cwiseAbs().maxCoeff(),
                  (observer.e_q() - (arm.q() - target.q())).cwiseAbs().maxCoeff());
}

TEST(PlaneObserver, ReadsTheArmAndErrsInTheSecondOrderOnly) {
  double largest_ratio = 0;
  for_random_cases(50, [&](TestRandom& random) {
    const DistributedArm arm(random_distributed_arm(random));
    const Eigen::VectorXd x = random_coordinates(random, arm), way = random_coordinates(random, arm, 0.1);
    double before = 0;
    for (const double share : {1.0, 0.5}) {
      const DistributedArm here = set_to(arm, x), there = set_to(arm, x + share * way);
      PlaneObserver observer(arm, x + share * way, {0, 0});
      observer.look(here, x, no_noise);
      EXPECT_LE((observer.coordinates() - x).cwiseAbs().maxCoeff(), 1e-8);
      if (share == 1) {
        before = off(observer, here, there);
      } else if (before > 1e-9) {
        largest_ratio = std::max(largest_ratio, off(observer, here, there) / before);
      }
      EXPECT_LE(off(observer, here, there), 0.05 * share * share);
    }
  });
  EXPECT_LT(largest_ratio, 0.3);  // A quarter, plus terms of third order.
}

TEST(PlaneObserver, HasTheNoiseOfItsPlanes) {
  const double theta = 40 * degree, q = 30 * degree, sigma = 1e-3;
  const DistributedArm arm({.lengths = {1}, .clamp = {{theta, q}}, .nodes = 2, .points = 4});
  const Eigen::VectorXd straight = arm.coordinates([&](double) { return Eigen::Vector2d(theta, q); });
  PlaneObserver observer(arm, straight, {sigma, 2 * sigma});
  const DistributedArm still = set_to(arm, straight);
  double of_theta = 0, of_q = 0;
  constexpr int looks = 4000;
  for (std::uint64_t k = 0; k < looks; ++k) {
    // Uniform, of variance 1.
    observer.look(still, straight, [&](std::uint64_t i) {
      return std::numbers::sqrt3 * (2 * static_cast<double>(hash(k, i) >> 11) * 0x1p-53 - 1);
    });
    of_theta += observer.e_theta().squaredNorm() / (4.0 * looks);
    of_q += observer.e_q().squaredNorm() / (4.0 * looks);
  }
  EXPECT_NEAR(std::sqrt(of_theta) / sigma, 1, 0.03);
  const PlaneView view = plane_view(theta, q);
  const double by_2 = std::cos(theta) * std::pow(std::cos(q) / std::cos(view.alpha_2), 2);
  const double by_1 = -std::sin(q) * std::cos(q) * std::tan(theta);
  EXPECT_NEAR(std::sqrt(of_q) / sigma, std::hypot(by_1, 2 * by_2), 0.03);
  EXPECT_EQ(observer.triangulated(), 0);
}

TEST(PlaneObserver, TriangulatesWhereThePlanesDoNotTell) {
  const DistributedArm arm({.lengths = {1}, .nodes = 4, .points = 20});
  const auto bent = [&](double theta, double q) {
    return arm.coordinates([=](double s) { return Eigen::Vector2d(theta * s, q * s); });
  };
  // Triangulated points: no points; those between 80 and 100 degrees; all that cross a quarter turn.
  for (const auto& [theta, theta_d] :
       {std::array{70.0, 75.0}, {160.0, 160.0}, {60.0, 140.0}, {120.0, 120.0}}) {
    const Eigen::VectorXd x = bent(theta * degree, 0.3), x_d = bent(theta_d * degree, -0.2);
    PlaneObserver observer(arm, x_d, {0, 0});
    const DistributedArm here = set_to(arm, x);
    observer.look(here, x, no_noise);
    EXPECT_LE((observer.coordinates() - x).cwiseAbs().maxCoeff(), 1e-9);
    const DistributedArm there = set_to(arm, x_d);
    EXPECT_LT(off(observer, here, there), 0.5);
    int hidden = 0;
    for (Eigen::Index j = 0; j < here.q().size(); ++j) {
      const Eigen::Vector2d seen(here.theta()[j], here.q()[j]), desired(there.theta()[j], there.q()[j]);
      const auto is_between = [&](double a, double b) {
        return (a < 80 * degree) != (b < 80 * degree) || (a > 80 * degree && a < 100 * degree) ||
               (b > 80 * degree && b < 100 * degree);
      };
      if (!is_between(seen[0], desired[0])) continue;
      ++hidden;
      EXPECT_NEAR(observer.e_q()[j], seen[1] - desired[1], 1e-12);
    }
    EXPECT_EQ(hidden > 0, theta_d > 80) << theta << " to " << theta_d;
    EXPECT_EQ(observer.triangulated(), hidden / static_cast<double>(here.q().size()))
        << theta << " to " << theta_d;
  }
}

// Noise that moves alpha_2 across a quarter turn would reverse q.
TEST(PlaneObserver, TriangulatesWhereThePlanesContradictEachOther) {
  const DistributedArm arm({.lengths = {1}, .nodes = 4, .points = 20});
  const Eigen::VectorXd x =
      arm.coordinates([](double s) { return Eigen::Vector2d(74.5 * degree * s, 57.3 * degree * s); });
  PlaneObserver observer(arm, x, {0, 1});
  const DistributedArm here = set_to(arm, x);
  const Eigen::Index points = here.q().size();
  constexpr double off = 14 * degree;
  observer.look(here, x, [&](std::uint64_t i) { return i < static_cast<std::uint64_t>(points) ? 0 : off; });
  int across = 0;
  for (Eigen::Index j = 0; j < points; ++j) {
    const PlaneView view = plane_view(here.theta()[j], here.q()[j]);
    if (std::cos(view.alpha_2 + off) > 0) continue;
    EXPECT_NEAR(observer.e_q()[j], off, 1e-9);
    ++across;
  }
  EXPECT_GT(across, 0);
  EXPECT_GE(observer.triangulated(), across / static_cast<double>(points));
}

TEST(PlaneObserver, LeadsTheArmWithGravityAndDamping) {
  for_random_cases(2, [](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.nodes = random.integer(2, 4);
    const DistributedArm arm(model);
    const PotentialLaw law(arm, random_coordinates(random, arm), {});
    const Eigen::VectorXd start = random_coordinates(random, arm);
    AngleMeasurement measurement{.step = 0.02, .reading = AngleReading::planes};
    PotentialRun by_planes(arm, law, start, measurement);
    ASSERT_TRUE(by_planes.advance(4)) << by_planes.stopped();
    EXPECT_LE((by_planes.motion().x() - law.target()).cwiseAbs().maxCoeff(), 0.02);
    // With delay and noise it must come near, reproducibly.
    measurement.delay = 0.06, measurement.noise = {0.01, 0.01};
    PotentialRun noisy(arm, law, start, measurement), again(arm, law, start, measurement);
    ASSERT_TRUE(noisy.advance(0.5) && again.advance(0.5)) << noisy.stopped();
    EXPECT_EQ(noisy.motion().x(), again.motion().x());
    ASSERT_TRUE(noisy.advance(4)) << noisy.stopped();
    EXPECT_LE((noisy.motion().x() - law.target()).cwiseAbs().maxCoeff(), 0.1);
    EXPECT_NE(noisy.motion().x(), by_planes.motion().x());
  });
}

// From -70 degrees to 290 there are two quarter turns, beyond which the cosine is equal.
TEST(PlaneObserver, TriangulatesWholeTurns) {
  EXPECT_TRUE(planes_determine({-1.2, 0.3}, {0.8, -0.2}));
  EXPECT_FALSE(planes_determine({-1.2, 0.3}, {-1.2 + 2 * std::numbers::pi, 0.3}));
  EXPECT_FALSE(planes_determine({0, 0.3}, {2 * std::numbers::pi, 0.3}));
  EXPECT_FALSE(planes_determine({0, 1.45}, {0, 1.2}));
  const DistributedArm arm({.lengths = {1}, .nodes = 3, .points = 8});
  const auto bent = [&](double theta) {
    return arm.coordinates([=](double s) { return Eigen::Vector2d(theta * s, 0.4 * s); });
  };
  const PotentialLaw law(arm, bent(5.1), {});
  PotentialRun run(arm, law, bent(-1.2), {{.step = 0.02, .reading = AngleReading::planes}});
  ASSERT_TRUE(run.advance(4)) << run.stopped();
  EXPECT_LE((run.motion().x() - law.target()).cwiseAbs().maxCoeff(), 0.05);
}

// In the plane XOY the first view has the angle itself.
TEST(PlaneObserver, IsTheLawsOwnInOnePlane) {
  const DistributedArm arm({.lengths = {0.5, 0.5}, .bending_stiffness = 0.2, .basis = AngleBasis::sections});
  const auto bent = [&](double theta) {
    return arm.coordinates([=](double s) { return Eigen::Vector2d(theta * s, 0); });
  };
  const PotentialLaw law(arm, bent(2.5), {});
  PotentialRun by_angles(arm, law, bent(0), {{.step = 0.02}});
  PotentialRun by_planes(arm, law, bent(0), {{.step = 0.02, .reading = AngleReading::planes}});
  ASSERT_TRUE(by_angles.advance(1));
  ASSERT_TRUE(by_planes.advance(1));
  EXPECT_LE((by_angles.motion().x() - by_planes.motion().x()).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace flexura
