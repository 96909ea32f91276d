#include "flexura/mechanics/contact_law.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/contact_shape.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Pose random_pose(TestRandom& random, double far) {
  Vector6d twist;
  twist << random.vector<3>(-far, far), random.vector<3>(-2.0, 2.0);
  return se3_exp(twist);
}

ObstacleConfig random_obstacle(TestRandom& random) {
  const auto place = [&] {
    return std::array{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)};
  };
  switch (random.integer(0, 3)) {
    case 0:
      return PlaneConfig{.point = place(), .normal = place()};
    case 1:
      return SphereConfig{.center = place(), .radius = random.uniform(0.02, 0.1)};
    case 2:
      return CapsuleConfig{.from = place(), .to = place(), .radius = random.uniform(0.02, 0.1)};
    default: {
      const Eigen::Vector4d q = quaternion_wxyz(random_pose(random, 0.1).rotation);
      return BoxConfig{
          .center = place(),
          .half_sizes = {random.uniform(0.02, 0.1), random.uniform(0.02, 0.1), random.uniform(0.02, 0.1)},
          .rotation = {q[0], q[1], q[2], q[3]}};
    }
  }
}

TEST(ContactShape, DistancesAreThoseOfTheFilesObstacles) {
  for_random_cases(400, [](TestRandom& random) {
    const ObstacleConfig config = random_obstacle(random);
    const Obstacle obstacle = obstacles({config}).front();
    const Pose X_WB = random_pose(random, 0.2);
    const ContactShape shape(config, X_WB.inverse());
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d p = random.vector<3>(-0.4, 0.4);
      const NearestPoint nearest = shape.nearest(p);
      EXPECT_NEAR(nearest.distance, obstacle.distance(X_WB * p), 1e-13);
      EXPECT_NEAR(shape.distance(p), nearest.distance, 1e-14);
      // The nearest point is on the surface.
      EXPECT_NEAR(nearest.normal.norm(), 1, 1e-12);
      EXPECT_NEAR(shape.distance(p - nearest.distance * nearest.normal), 0, 1e-12);
    }
  });
}

TEST(ContactShape, NormalsAndCurvaturesAreTheDerivativesOfTheDistance) {
  for_random_cases(400, [](TestRandom& random) {
    const ContactShape shape(random_obstacle(random), random_pose(random, 0.2));
    const Eigen::Vector3d p = random.vector<3>(-0.4, 0.4), along = random.vector<3>(-1.0, 1.0);
    constexpr double h = 1e-6;
    const NearestPoint at = shape.nearest(p), after = shape.nearest(p + h * along),
                       before = shape.nearest(p - h * along);
    // Skips edges, where a derivative jumps.
    if ((after.curvature - before.curvature).norm() > 1e-3 * (1 + at.curvature.norm())) return;
    if ((after.normal - before.normal).norm() > 0.1) return;
    EXPECT_NEAR((after.distance - before.distance) / (2 * h), at.normal.dot(along), 1e-7);
    EXPECT_LT(((after.normal - before.normal) / (2 * h) - at.curvature * along).norm(),
              1e-5 * (1 + at.curvature.norm()));
  });
}

TEST(ContactShape, IsFiniteWhereNoPointIsNearest) {
  const Pose none;
  const ContactShape ball(SphereConfig{.center = {0, 0, 0}, .radius = 0.1}, none);
  const ContactShape capsule(CapsuleConfig{.from = {0, 0, 0}, .to = {0, 0, 1}, .radius = 0.1}, none);
  const ContactShape point(CapsuleConfig{.from = {0, 0, 0}, .to = {0, 0, 0}, .radius = 0.1}, none);
  const ContactShape box(BoxConfig{.center = {0, 0, 0}, .half_sizes = {0.1, 0.1, 0.1}}, none);
  for (const ContactShape* shape : {&ball, &capsule, &point, &box}) {
    const NearestPoint at = shape->nearest(Eigen::Vector3d::Zero());
    EXPECT_DOUBLE_EQ(at.distance, -0.1);
    EXPECT_NEAR(at.normal.norm(), 1, 1e-15);
    EXPECT_TRUE(at.curvature.allFinite());
  }
}

TEST(ContactShape, RefusesWhatCannotBe) {
  const Pose none;
  EXPECT_THROW(ContactShape(SphereConfig{.radius = 0}, none), std::invalid_argument);
  EXPECT_THROW(ContactShape(SphereConfig{.center = {NAN, 0, 0}, .radius = 1}, none), std::invalid_argument);
  EXPECT_THROW(ContactShape(PlaneConfig{.normal = {0, 0, 0}}, none), std::invalid_argument);
  EXPECT_THROW(ContactShape(CapsuleConfig{.radius = infinity}, none), std::invalid_argument);
  EXPECT_THROW(ContactShape(BoxConfig{.half_sizes = {1, 1, 0}}, none), std::invalid_argument);
  EXPECT_THROW(ContactShape(BoxConfig{.half_sizes = {1, 1, 1}, .rotation = {0, 0, 0, 0}}, none),
               std::invalid_argument);
}

Touch touch_of(const ContactShape& shape, const NodeMotion& node, double radius) {
  return {.center = node.pose.position,
          .radius = radius,
          .nearest = shape.nearest(node.pose.position),
          .twist = node.twist,
          .run = 0.02};
}

NodeMotion moved(const NodeMotion& node, const Vector6d& twist, double h) {
  return {.pose = se3_exp(h * twist) * node.pose, .twist = node.twist};
}

TEST(ContactLaw, ItsDerivativesAreThoseByDifferences) {
  int touched = 0;
  for_random_cases(600, [&](TestRandom& random) {
    const ContactShape shape(random_obstacle(random), random_pose(random, 0.2));
    NodeMotion node{.pose = random_pose(random, 0.3)};
    node.twist << random.vector<3>(-0.3, 0.3), random.vector<3>(-2.0, 2.0);
    const ContactLaw law{.stiffness = 1e4,
                         .damping = random.uniform(0, 4),
                         .friction = random.uniform(0, 1),
                         .slip_speed = random.uniform(0.01, 0.3),
                         .transition = 1e-3};
    // Moves the node close to the surface.
    const NearestPoint nearest = shape.nearest(node.pose.position);
    const double radius = random.uniform(0.005, 0.02);
    node.pose.position -= (nearest.distance - radius * random.uniform(0.2, 0.95)) * nearest.normal;
    NodePull pull;
    const TouchForce at = touch_force(law, touch_of(shape, node, radius), pull);
    if (!(at.depth > 0)) return;
    constexpr double h = 1e-6;
    const auto wrench = [&](const NodeMotion& there) {
      return touch_force(law, touch_of(shape, there, radius)).wrench();
    };
    // Skips edges, where the curvature jumps.
    const auto curvature = [&](const NodeMotion& there) {
      return shape.nearest(there.pose.position).curvature;
    };
    Matrix6d by_pose, by_twist;
    for (Eigen::Index i = 0; i < 6; ++i) {
      const Vector6d unit = Vector6d::Unit(i);
      const NodeMotion after = moved(node, unit, h), before = moved(node, unit, -h);
      if ((curvature(after) - curvature(before)).norm() > 1e-2 * (1 + curvature(node).norm())) return;
      by_pose.col(i) = (wrench(after) - wrench(before)) / (2 * h);
      NodeMotion faster = node, slower = node;
      faster.twist += h * unit;
      slower.twist -= h * unit;
      by_twist.col(i) = (wrench(faster) - wrench(slower)) / (2 * h);
    }
    ++touched;
    EXPECT_LT((pull.by_pose - by_pose).norm(), 1e-5 * (1 + by_pose.norm()));
    EXPECT_LT((pull.by_twist - by_twist).norm(), 1e-5 * (1 + by_twist.norm()));
    // The semidefinite parts have no negative eigenvalue.
    const Eigen::SelfAdjointEigenSolver<Matrix6d> spring(pull.stiffness), damper(pull.damping);
    EXPECT_GT(spring.eigenvalues().minCoeff(), -1e-9 * (1 + pull.stiffness.norm()));
    EXPECT_GT(damper.eigenvalues().minCoeff(), -1e-9 * (1 + pull.damping.norm()));
  });
  EXPECT_GT(touched, 300 / one_case_of);
}

TEST(ContactLaw, NeverPullsAndIsInsideTheFrictionCone) {
  for_random_cases(1000, [](TestRandom& random) {
    const ContactLaw law{.friction = random.uniform(0, 1), .slip_speed = 1e-3};
    const ContactShape plane(PlaneConfig{}, Pose{});
    const double depth = random.uniform(-0.001, 0.004);
    NodeMotion node{.pose = {.position = {0, 0.005 - depth, 0}}};
    node.twist << random.vector<3>(-3.0, 3.0), random.vector<3>(-30.0, 30.0);
    const TouchForce at = touch_force(law, touch_of(plane, node, 0.005));
    EXPECT_GE(at.normal_force, 0);
    if (depth <= 0) {
      EXPECT_EQ(at.force.norm(), 0);
      return;
    }
    const Eigen::Vector3d along = at.force - at.force.y() * Eigen::Vector3d::UnitY();
    EXPECT_LE(along.norm(), law.friction * at.normal_force * (1 + 1e-12));
    EXPECT_LE(along.dot(at.slip), 0);
    // The damper's force works against the motion.
    const double still = press(law, depth, 0).force, rate = -node.twist.head<3>().y();
    EXPECT_GE((press(law, depth, rate).force - still) * rate, -1e-12);
  });
}

TEST(ContactLaw, ABallThatRollsDoesNotRub) {
  const ContactLaw law;
  const ContactShape plane(PlaneConfig{}, Pose{});
  NodeMotion node{.pose = {.position = {0.1, 0.0049, 0}}};
  // Speed along x, and turn about -z by the radius.
  const Eigen::Vector3d w(0, 0, -2 / 0.005), v(2, 0, 0);
  node.twist << v - w.cross(node.pose.position), w;
  Touch touch{.center = node.pose.position,
              .radius = 0.005,
              .nearest = plane.nearest(node.pose.position),
              .twist = node.twist,
              .run = 1};
  EXPECT_LT(touch_force(law, touch).slip.norm(), 1e-12);
  touch.twist << v, Eigen::Vector3d::Zero();
  EXPECT_NEAR(touch_force(law, touch).slip.norm(), 2, 1e-12);
}

TEST(ContactLaw, RefusesWhatCannotBe) {
  EXPECT_EQ(law_problem({}), "");
  for (const double bad : {0.0, -1.0, double{NAN}, infinity}) {
    EXPECT_NE(law_problem({.stiffness = bad}), "");
    EXPECT_NE(law_problem({.slip_speed = bad}), "");
    EXPECT_NE(law_problem({.transition = bad}), "");
    if (bad == 0) continue;
    EXPECT_NE(law_problem({.damping = bad}), "");
    EXPECT_NE(law_problem({.friction = bad}), "");
  }
}

Rod plain_rod() {
  return {.sections = {RodSection{.length = 0.2,
                                  .radius = {0.005, 0.004},
                                  .youngs_modulus = 1e6,
                                  .shear_modulus = 4e5,
                                  .density = 1000}},
          .tendons = {}};
}

TEST(RodDrag, ItsDerivativesAreThoseByDifferences) {
  const RodChain chain(plain_rod());
  const std::size_t count = chain.elements()[0].grid().t.size();
  for_random_cases(200, [&](TestRandom& random) {
    const RodDrag drag(chain, {.density = 1000,
                               .across_coefficient = random.uniform(0, 2),
                               .along_coefficient = random.uniform(0, 0.1),
                               .linear_across = random.uniform(0, 1),
                               .linear_along = random.uniform(0, 1),
                               .flow = random.vector<3>(-0.5, 0.5)});
    std::vector<NodeMotion> nodes(count);
    for (NodeMotion& node : nodes) {
      node.pose = random_pose(random, 0.3);
      node.twist << random.vector<3>(-0.3, 0.3), random.vector<3>(-2.0, 2.0);
    }
    const std::vector<double> run(count, 0.04);
    std::vector<NodePull> pulls(count), after(count), before(count);
    drag.pull(nodes, run, pulls);
    constexpr double h = 1e-6;
    for (Eigen::Index i = 0; i < 6; ++i) {
      std::vector<NodeMotion> there = nodes, back = nodes;
      for (std::size_t k = 0; k < count; ++k) {
        there[k] = moved(nodes[k], Vector6d::Unit(i), h);
        back[k] = moved(nodes[k], Vector6d::Unit(i), -h);
      }
      drag.pull(there, run, after);
      drag.pull(back, run, before);
      for (std::size_t k = 0; k < count; ++k)
        EXPECT_LT(((after[k].wrench - before[k].wrench) / (2 * h) - pulls[k].by_pose.col(i)).norm(),
                  1e-6 * (1 + pulls[k].by_pose.norm()));
      there = back = nodes;
      for (std::size_t k = 0; k < count; ++k) {
        there[k].twist[i] += h;
        back[k].twist[i] -= h;
      }
      drag.pull(there, run, after);
      drag.pull(back, run, before);
      for (std::size_t k = 0; k < count; ++k)
        EXPECT_LT(((after[k].wrench - before[k].wrench) / (2 * h) - pulls[k].by_twist.col(i)).norm(),
                  1e-6 * (1 + pulls[k].by_twist.norm()));
    }
  });
}

TEST(RodDrag, IsTheFormulaOfACylinderAcrossAndAlongAFlow) {
  const RodChain chain(plain_rod());
  const std::size_t count = chain.elements()[0].grid().t.size();
  const std::vector<NodeMotion> still(count);
  const std::vector<double> run(count, 1.0);
  std::vector<NodePull> pulls(count);
  RodDragConfig config{.density = 1000, .across_coefficient = 1.2, .along_coefficient = 0.02};
  config.flow = {0.5, 0, 0};
  RodDrag(chain, config).pull(still, run, pulls);
  EXPECT_NEAR(pulls[0].wrench[0], 0.5 * 1000 * 1.2 * 0.01 * 0.25, 1e-12);
  config.flow = {0, 0, 0.5};
  RodDrag(chain, config).pull(still, run, pulls);
  EXPECT_NEAR(pulls[0].wrench[2], 0.5 * 1000 * 0.02 * std::numbers::pi * 0.01 * 0.25, 1e-12);
}

TEST(Surroundings, AddUp) {
  const RodChain chain(plain_rod());
  const std::size_t count = chain.elements()[0].grid().t.size();
  const RodDrag drag(chain, {}), water(chain, {.density = 1000});
  const RodContact contact(chain, {.obstacles = {PlaneConfig{.point = {0, 0.002, 0}}}});
  const Surroundings both({&drag, &water, &contact}), none({});
  std::vector<NodeMotion> nodes(count);
  for (std::size_t k = 0; k < count; ++k) {
    nodes[k].pose.position.z() = 0.2 * chain.elements()[0].grid().t[k];
    nodes[k].twist << 0.1, 0.02, 0.3, 1, 2, 3;
  }
  const std::vector<double> run(count, 0.04), lengths(count - 1, 0.1);
  std::vector<NodePull> all(count), one(count), other(count);
  both.pull(nodes, run, all);
  drag.pull(nodes, run, one);
  water.pull(nodes, run, other);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_GT(other[k].wrench.norm(), 0);
    EXPECT_EQ(all[k].wrench, one[k].wrench + other[k].wrench);
    EXPECT_EQ(all[k].by_pose, one[k].by_pose + other[k].by_pose);
    EXPECT_EQ(all[k].by_twist, one[k].by_twist + other[k].by_twist);
    EXPECT_EQ(all[k].stiffness, one[k].stiffness + other[k].stiffness);
  }
  // The points are those of the one part that has some.
  ASSERT_EQ(both.points().size(), count);
  std::vector<std::size_t> chosen;
  both.choose(nodes, lengths, chosen);
  ASSERT_EQ(chosen.size(), count);
  both.pull_points(chosen, nodes, all);
  contact.pull_points(chosen, nodes, one);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_GT(one[k].wrench.norm(), 0);
    EXPECT_EQ(all[k].wrench, one[k].wrench);
  }
  none.pull(nodes, run, all);
  for (const NodePull& pull : all) EXPECT_EQ(pull.wrench.norm() + pull.by_pose.norm(), 0);
  EXPECT_TRUE(none.points().empty());
  EXPECT_THROW(Surroundings({nullptr}), std::invalid_argument);
  EXPECT_THROW(Surroundings({&contact, &contact}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
