#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/touching_rod.h"

namespace flexura {
namespace {

PlaneConfig floor_at(double x) { return {.point = {x, 0, 0}, .normal = {1, 0, 0}}; }
const RodLoads weight{.gravity = {-9.81, 0, 0}};

Eigen::Vector3d sum_of(const std::vector<ContactForce>& contacts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ContactForce& contact : contacts) sum += contact.force;
  return sum;
}

// Force of the clamp on the rod: the strain at the base times the stiffness.
Eigen::Vector3d clamp_force(const Rod& rod, const RodChain& chain, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& v) {
  const RodGrid& grid = chain.elements()[0].grid();
  const Vector6d strain = grid.strain(Vector6d::Zero(), q, grid.at_node.col(0)),
                 rate = grid.strain(Vector6d::Zero(), v, grid.at_node.col(0));
  const Vector6d pull =
      rod.sections[0].stiffness_at(0).cwiseProduct(strain) + rod.sections[0].damping_at(0).cwiseProduct(rate);
  return -pull.head<3>();
}

// A level rod falls on a floor 5 cm below, and comes to rest on it.
TEST(ContactRod, ARodThatFallsOnAFloorComesToRest) {
  for (const double stiffness : {1e5, 1e6}) {
    TouchingRod moving(soft_arm(), {.law = {.stiffness = stiffness}, .obstacles = {floor_at(-0.05)}});
    RodState state = moving.dynamics.rest();
    double energy = 0, most_slip = 0;
    moving.go(state, {}, weight, 1e-3, 1.0, [&](const RodState& now) {
      // Contact springs store at most depth^2 / 2 times their stiffness.
      double stored = 0;
      for (const ContactForce& contact : moving.touching(now)) {
        stored += 0.5 * stiffness * 0.01 * contact.depth * contact.depth;
        const Eigen::Vector3d along = contact.force - contact.normal.dot(contact.force) * contact.normal;
        EXPECT_GE(contact.normal_force, 0);
        EXPECT_LE(along.norm(), 0.3 * contact.normal_force * (1 + 1e-9));
        EXPECT_FALSE(contact.is_deep);
      }
      const double now_energy = moving.dynamics.energy(now, weight).total();
      EXPECT_LE(now_energy, energy + stored + 1e-6);
      energy = std::min(energy, now_energy);
    });
    const std::vector<ContactForce> contacts = moving.touching(state);
    ASSERT_FALSE(contacts.empty());
    for (const ContactForce& contact : contacts) {
      most_slip = std::max(most_slip, contact.slip.norm());
      EXPECT_TRUE(contact.sticks);
      EXPECT_EQ(contact.obstacle, std::optional<std::size_t>(0));
      // The tip's node represents half an interval.
      EXPECT_NEAR(contact.normal_force, stiffness * 0.005 * (contact.depth - 0.5e-5),
                  1e-5 * contact.normal_force);
    }
    EXPECT_LT(most_slip, 1e-6);
    EXPECT_LT(moving.dynamics.energy(state, weight).kinetic, 1e-10);
    EXPECT_NEAR(moving.dynamics.tip(state).position.x(), -0.05 + 0.008 - contacts.back().depth, 1e-12);
  }
}

// Weight, floor and clamp are in balance at rest; in motion they change the momentum.
TEST(ContactRod, TheMomentumChangesByWeightFloorAndClamp) {
  Rod rod = soft_arm();
  rod.sections[0].modes = {.shear = 8, .stretch = 4, .bend = 9, .twist = 1};
  TouchingRod moving(rod, {.law = {.stiffness = 1e5, .friction = 0.3}, .obstacles = {floor_at(-0.05)}}, 0.01);
  RodState state = moving.dynamics.rest();
  const double mass = rod.sections[0].mass_per_length_at(0) * 0.3;
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), touched = impulse;
  constexpr double h = 2e-4;
  Eigen::Vector3d clamp_before = Eigen::Vector3d::Zero(), floor_before = clamp_before;
  moving.go(state, {}, weight, h, 0.12, [&](const RodState& now) {
    const Eigen::Vector3d clamp =
                              clamp_force(rod, moving.dynamics.chain(), now.q, moving.dynamics.velocity(now)),
                          floor = sum_of(moving.touching(now));
    impulse += h * (mass * weight.gravity + 0.5 * (clamp + clamp_before + floor + floor_before));
    touched += h * floor;
    clamp_before = clamp;
    floor_before = floor;
  });
  EXPECT_GT(touched.x(), 0.004);  // N s
  const Eigen::Vector3d momentum = moving.dynamics.momentum(state).head<3>();
  // The impulse is that of forces at the steps' ends, which change within steps when the rod hits the floor.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(momentum[axis], impulse[axis], 0.03 * touched.x()) << axis;
  EXPECT_GT(touched.tail<2>().norm(), 0.1 * touched.x()) << "friction";
  moving.go(state, {}, weight, 1e-3, 1.2);
  const Eigen::Vector3d floor = sum_of(moving.touching(state)),
                        clamp = clamp_force(rod, moving.dynamics.chain(), state.q,
                                            moving.dynamics.velocity(state));
  EXPECT_NEAR((floor + clamp + mass * weight.gravity).x(), 0, 0.005 * mass * 9.81);
  EXPECT_GT(floor.x(), 0.2 * mass * 9.81);
}

// Where the rod touches the floor along its length, forces per metre do not depend on the nodes.
TEST(ContactRod, ForcesConvergeWithTheNodes) {
  std::vector<double> forces;
  for (const double spacing : {0.02, 0.01, 0.005}) {
    TouchingRod moving(soft_arm(5e5, 6), {.law = {.stiffness = 1e4}, .obstacles = {floor_at(-0.03)}},
                       spacing);
    RodState state = moving.dynamics.rest();
    moving.go(state, {}, weight, 2e-3, 1.0);
    EXPECT_GT(moving.touching(state).size(), 4u);
    forces.push_back(sum_of(moving.touching(state)).x());
  }
  EXPECT_NEAR(forces[0], forces[2], 0.03 * forces[2]);
  EXPECT_NEAR(forces[1], forces[2], 0.01 * forces[2]);
}

RodContactConfig beside_a_post(double stiffness) {
  return {.law = {.stiffness = stiffness},
          .obstacles = {CapsuleConfig{.from = {0.055, -0.2, 0.1}, .to = {0.055, 0.2, 0.1}, .radius = 0.04}}};
}

TEST(ContactRod, ATentacleGraspsAPost) {
  TouchingRod moving(soft_arm_with_tendon(1e6), beside_a_post(1e5));
  RodState state = moving.dynamics.rest();
  double deepest = 0;
  for (int i = 1; i <= 20; ++i)
    moving.go(state, {.tensions = {0.75 * i}}, {}, 2e-3, 0.03 * i, [&](const RodState& now) {
      for (const ContactForce& contact : moving.touching(now)) deepest = std::max(deepest, contact.depth);
    });
  moving.go(state, {.tensions = {15}}, {}, 2e-3, 1.4);
  const std::vector<ContactForce> contacts = moving.touching(state);
  EXPECT_GE(contacts.size(), 5u);
  EXPECT_LT(deepest, 0.004);
  double force = 0;
  for (const ContactForce& contact : contacts) {
    EXPECT_FALSE(contact.is_deep);
    EXPECT_LT(contact.depth, 0.0025);
    force += contact.normal_force;
  }
  EXPECT_GT(force, 0.5);
  // It encloses the post: seen from its axis, contacts are on different sides.
  const auto side = [](const ContactForce& contact) {
    return Eigen::Vector2d(contact.point.x() - 0.055, contact.point.z() - 0.1).normalized();
  };
  double least = 1;
  for (const ContactForce& one : contacts)
    for (const ContactForce& other : contacts) least = std::min(least, side(one).dot(side(other)));
  EXPECT_LT(least, 0);
}

// Points between nodes move with the rod: a point is where it would be as a node.
TEST(ContactRod, PointsMoveAsTheRodDoes) {
  Rod rod = soft_arm(1e6, 4);
  rod.sections[0].rest_curvature = {{3, -2, 1}, {5, 1, 0}};
  rod.sections.push_back(rod.sections[0]);
  const std::vector<RodPlace> places = contact_places(rod, 0.05);
  RodDynamics between(rod), nodes(rod, {}, places);
  const RodContact contact(between.chain(), {.places = places});
  between.set_surroundings(&contact);
  for_random_cases(10, [&](TestRandom& random) {
    Eigen::VectorXd q(between.chain().size()), v = q;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      q[j] = random.uniform(-1, 1) / between.chain().scales()[j] * 0.2;
      v[j] = random.uniform(-1, 1) / between.chain().scales()[j];
    }
    const RodState state = between.start(q, v, {}, {}), same = nodes.start(q, v, {}, {});
    const std::vector<NodeMotion> points = between.point_motions(state);
    ASSERT_EQ(points.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const NodeMotion node = nodes.motion(same, places[i]);
      EXPECT_LT((points[i].pose.position - node.pose.position).norm(), 2e-7);
      EXPECT_LT((points[i].pose.rotation - node.pose.rotation).norm(), 2e-6);
      EXPECT_LT((points[i].twist - node.twist).norm(), 1e-5 * (1 + node.twist.norm()));
    }
  });
}

// Derivatives of forces at points, in both sections, by the modes and their rates.
TEST(ContactRod, ForcesOfTheModesHaveTheDerivativesByDifferences) {
  Rod rod = soft_arm(1e6, 3);
  rod.sections.push_back(rod.sections[0]);
  for (RodSection& section : rod.sections) section.length = 0.15;
  int touched = 0;
  for_random_cases(6, [&](TestRandom& random) {
    TouchingRod moving(rod,
                       {.law = {.stiffness = 1e4, .damping = 0.5, .slip_speed = 0.1, .transition = 1e-3},
                        .obstacles = {floor_at(-0.02)},
                        .radii = {{0.02, 0.02}, {0.02, 0.015}},
                        .itself_apart = 3},
                       0.02);
    Eigen::VectorXd q(moving.dynamics.chain().size()), v = q;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      q[j] = random.uniform(-0.1, 0.1) / moving.dynamics.chain().scales()[j];
      v[j] = random.uniform(-0.5, 0.5) / moving.dynamics.chain().scales()[j];
    }
    // Rolled-up shape.
    for (const RodElement& element : moving.dynamics.chain().elements())
      q[moving.dynamics.chain().first(
            static_cast<std::size_t>(&element - moving.dynamics.chain().elements().data())) +
        element.grid().first[4]] += random.uniform(25, 32);
    const RodState state = moving.dynamics.start(q, v, {}, weight);
    for (const ContactForce& contact : moving.touching(state)) touched += contact.obstacle ? 1 : 1000;
    const RodDynamicsSlopes slopes = moving.dynamics.slopes(state, {}, weight);
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double h = 1e-6 / moving.dynamics.chain().scales()[j];
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(q.size(), j);
      const auto change = [&](const Eigen::VectorXd& dq, const Eigen::VectorXd& dv) -> Eigen::VectorXd {
        return (moving.dynamics.start(q + dq, v + dv, {}, weight).force -
                moving.dynamics.start(q - dq, v - dv, {}, weight).force) /
               (2 * h);
      };
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(q.size()), by_q = change(step, none),
                            by_v = change(none, step);
      EXPECT_LT((slopes.force_by_q.col(j) - by_q).norm(), 1e-4 * (1 + by_q.norm())) << j;
      EXPECT_LT((slopes.force_by_v.col(j) - by_v).norm(), 1e-4 * (1 + by_v.norm())) << j;
    }
  });
  // Sanitized builds try too few cases for both.
  if (one_case_of > 1) return;
  EXPECT_GT(touched % 1000, 0) << "the floor";
  EXPECT_GT(touched, 1000) << "and itself";
}

TEST(ContactRod, TurnedWithItsFrameNothingChanges) {
  const RodContactConfig config = beside_a_post(1e5);
  Pose X_WB;
  Vector6d twist;
  twist << 0.3, -0.2, 0.1, 1, -0.5, 0.7;
  X_WB = se3_exp(twist);
  RodContactConfig turned = config;
  auto& post = std::get<CapsuleConfig>(turned.obstacles[0]);
  for (std::array<double, 3>* point : {&post.from, &post.to}) {
    const Eigen::Vector3d p = X_WB * Eigen::Vector3d((*point)[0], (*point)[1], (*point)[2]);
    *point = {p.x(), p.y(), p.z()};
  }
  turned.X_WB = X_WB;
  Eigen::Vector3d tips[2];
  for (const bool is_turned : {false, true}) {
    TouchingRod moving(soft_arm_with_tendon(1e6), is_turned ? turned : config);
    RodState state = moving.dynamics.rest();
    moving.go(state, {.tensions = {4}}, {}, 2e-3, 0.3);
    EXPECT_FALSE(moving.touching(state).empty());
    tips[is_turned ? 1 : 0] = moving.dynamics.tip(state).position;
  }
  EXPECT_LT((tips[0] - tips[1]).norm(), 1e-7);
}

TEST(ContactRod, AnObstacleInsideTheArmIsSaidToBeDeep) {
  TouchingRod moving(soft_arm(), {.obstacles = {SphereConfig{.center = {0.001, 0, 0.2}, .radius = 0.02}}});
  RodState state = moving.dynamics.rest();
  const std::vector<ContactForce> contacts = moving.touching(state);
  ASSERT_FALSE(contacts.empty());
  EXPECT_TRUE(std::ranges::any_of(contacts, [](const ContactForce& each) { return each.is_deep; }));
  for (const ContactForce& contact : contacts) EXPECT_TRUE(contact.force.allFinite());
  moving.go(state, {}, {}, 1e-3, 0.3);
  for (const ContactForce& contact : moving.touching(state)) EXPECT_FALSE(contact.is_deep);
}

TEST(ContactRod, RefusesWhatCannotBe) {
  const RodChain chain(soft_arm());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RodContact(chain, {.law = {.stiffness = -1}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.radii = {{0, 0.01}}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.radii = {{0.01, 0.01}, {0.01, 0.01}}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.itself_apart = infinity}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.obstacles = {SphereConfig{.radius = infinity}}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.places = {{0, 0.5}, {0, 0.5}}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.places = {{1, 0.5}}}), std::invalid_argument);
  EXPECT_THROW(RodContact(chain, {.places = {{0, 1.5}}}), std::invalid_argument);
  EXPECT_THROW((void)contact_places(soft_arm(), 0), std::invalid_argument);
  EXPECT_THROW((void)contact_places(soft_arm(), 1e-9), std::invalid_argument);
  const RodContact contact(chain, {});
  EXPECT_THROW((void)contact.find(std::vector<NodeMotion>(2)), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
