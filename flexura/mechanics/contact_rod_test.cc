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

namespace flexura {
namespace {

PlaneConfig floor_at(double x) { return {.point = {x, 0, 0}, .normal = {1, 0, 0}}; }
const RodLoads weight{.gravity = {-9.81, 0, 0}};

std::vector<NodeMotion> moved(std::vector<NodeMotion> nodes, std::size_t node, Eigen::Index c, double by_pose,
                              double by_twist) {
  nodes[node].pose = se3_exp(by_pose * Vector6d::Unit(c)) * nodes[node].pose;
  nodes[node].twist[c] += by_twist;
  return nodes;
}

// Of all wrenches by the motion of all nodes.
TEST(ContactRod, ItsDerivativesAreThoseByDifferencesWhereItTouchesItself) {
  const Rod rod = soft_arm();
  const RodChain chain(rod);
  const std::vector<RodPlace> places = contact_places(rod, 0.02);
  const std::size_t count = places.size();
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  int touched = 0;
  for_random_cases(30, [&](TestRandom& random) {
    const RodContact contact(chain, {.law = {.stiffness = 1e4, .damping = 0.5, .slip_speed = 0.1},
                                     .radii = {{0.03, 0.02}},
                                     .itself_apart = 3,
                                     .places = places});
    // Curled up.
    std::vector<NodeMotion> nodes(count);
    const double radius = random.uniform(0.03, 0.04), rise = random.uniform(0, 0.02);
    for (std::size_t k = 0; k < count; ++k) {
      const double s = 0.3 * places[k].at, angle = s / radius;
      nodes[k].pose.position =
          Eigen::Vector3d(radius * (1 - std::cos(angle)), rise * angle, radius * std::sin(angle)) +
          random.vector<3>(-0.003, 0.003);
      nodes[k].twist << random.vector<3>(-0.3, 0.3), random.vector<3>(-2.0, 2.0);
    }
    std::vector<NodePull> pulls(count), after(count), before(count);
    contact.pull_points(all, nodes, pulls);
    std::vector<PointCoupling> couplings;
    contact.couple(all, nodes, couplings);
    touched += couplings.empty() ? 0 : 1;
    Vector6d sum = Vector6d::Zero();
    for (const NodePull& pull : pulls) sum += pull.wrench;
    EXPECT_LT(sum.norm(), 1e-12);  // To each its opposite.
    constexpr double h = 1e-7;
    for (std::size_t node = 0; node < count; ++node) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        for (const bool by_pose : {true, false}) {
          const double pose = by_pose ? h : 0, twist = by_pose ? 0 : h;
          contact.pull_points(all, moved(nodes, node, c, pose, twist), after);
          contact.pull_points(all, moved(nodes, node, c, -pose, -twist), before);
          for (std::size_t at = 0; at < count; ++at) {
            Matrix6d slopes = Matrix6d::Zero();
            for (const PointCoupling& each : couplings)
              if (each.of == node && each.at == at) slopes += by_pose ? each.by_pose : each.by_twist;
            const Vector6d difference = (after[at].wrench - before[at].wrench) / (2 * h);
            EXPECT_LT((slopes.col(c) - difference).norm(), 1e-4 * (1 + difference.norm()))
                << node << " " << at << " " << c << " " << by_pose;
          }
        }
      }
    }
  });
  EXPECT_GT(touched, 15 / one_case_of);
}

struct TouchingRod {
  Rod rod;
  RodDynamics dynamics;
  RodContact contact;

  TouchingRod(const Rod& given, RodContactConfig config, double spacing = 0.01)
      : rod(given), dynamics(rod), contact(dynamics.chain(), touching_at(rod, config, spacing)) {
    dynamics.set_surroundings(&contact);
  }
  static RodContactConfig touching_at(const Rod& rod, RodContactConfig config, double spacing) {
    config.places = contact_places(rod, spacing);
    return config;
  }
  // So many steps of a motion that converge; look(state) after each.
  template <typename Look>
  void go(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h, double until,
          Look&& look) {
    const long steps = std::lround((until - state.time) / h);
    for (long i = 0; i < steps; ++i) {
      const RodStep step = dynamics.step(state, tendons, loads, h);
      ASSERT_TRUE(step.converged()) << words(step.end) << " at " << state.time;
      look(state);
    }
  }
  void go(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h, double until) {
    go(state, tendons, loads, h, until, [](const RodState&) {});
  }
  std::vector<ContactForce> touching(const RodState& state) {
    return contact.find(dynamics.point_motions(state));
  }
};

Eigen::Vector3d sum_of(const std::vector<ContactForce>& contacts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ContactForce& contact : contacts) sum += contact.force;
  return sum;
}

// What the clamp does to the rod: its strain at the base times the stiffness.
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
      // What is stored in the springs of contacts is at most depth^2 / 2 times their stiffness.
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
      // The tip's node stands for half an interval.
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
  TouchingRod moving(rod, {.law = {.stiffness = 1e5}, .obstacles = {floor_at(-0.05)}}, 0.01);
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
  EXPECT_NEAR(momentum.x(), impulse.x(), 0.03 * touched.x());
  moving.go(state, {}, weight, 1e-3, 1.2);
  const Eigen::Vector3d floor = sum_of(moving.touching(state)),
                        clamp = clamp_force(rod, moving.dynamics.chain(), state.q,
                                            moving.dynamics.velocity(state));
  EXPECT_NEAR((floor + clamp + mass * weight.gravity).x(), 0, 0.005 * mass * 9.81);
  EXPECT_GT(floor.x(), 0.2 * mass * 9.81);
}

// On a floor that it lies on along its length, forces for each metre do not depend on the nodes.
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
  // Around it: seen from the post's axis they are on different sides.
  const auto side = [](const ContactForce& contact) {
    return Eigen::Vector2d(contact.point.x() - 0.055, contact.point.z() - 0.1).normalized();
  };
  double least = 1;
  for (const ContactForce& one : contacts)
    for (const ContactForce& other : contacts) least = std::min(least, side(one).dot(side(other)));
  EXPECT_LT(least, 0);
}

// Curled up by a tendon it meets itself, and stays outside.
TEST(ContactRod, ARodThatCurlsUpDoesNotPassThroughItself) {
  RodContactConfig touches{.law = {.stiffness = 1e5}}, ghost = touches;
  ghost.itself = false;
  double nearest[2] = {1, 1};
  for (const bool is_ghost : {false, true}) {
    TouchingRod moving(soft_arm_with_tendon(1e6), is_ghost ? ghost : touches);
    RodState state = moving.dynamics.rest();
    for (int i = 1; i <= 24; ++i) moving.go(state, {.tensions = {0.5 * i}}, {}, 2e-3, 0.04 * i);
    moving.go(state, {.tensions = {12}}, {}, 2e-3, 1.2);
    // From the base to what is further than ten radii along it.
    const std::vector<NodeMotion> points = moving.dynamics.point_motions(state);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector3d p = points[k].pose.position;
      if (0.3 * moving.contact.points()[k].at > 0.08)
        nearest[is_ghost ? 1 : 0] = std::min(nearest[is_ghost ? 1 : 0], p.norm());
    }
    if (!is_ghost)
      for (const ContactForce& contact : moving.touching(state)) {
        EXPECT_FALSE(contact.obstacle.has_value());
        EXPECT_FALSE(contact.is_deep);
      }
  }
  EXPECT_GT(nearest[0], 0.014);
  EXPECT_LT(nearest[1], 0.012);
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
  EXPECT_THROW((void)contact_places(soft_arm(), 0), std::invalid_argument);
  EXPECT_THROW((void)contact_places(soft_arm(), 1e-9), std::invalid_argument);
  const RodContact contact(chain, {});
  EXPECT_THROW((void)contact.find(std::vector<NodeMotion>(2)), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
