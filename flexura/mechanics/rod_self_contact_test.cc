#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/touching_rod.h"

namespace flexura {
namespace {

std::vector<NodeMotion> one_moved(std::vector<NodeMotion> nodes, std::size_t node, Eigen::Index c,
                                  double by_pose, double by_twist) {
  nodes[node].pose = se3_exp(by_pose * Vector6d::Unit(c)) * nodes[node].pose;
  nodes[node].twist[c] += by_twist;
  return nodes;
}

// Derivatives of all wrenches by the motion of all nodes.
TEST(RodSelfContact, ItsDerivativesAreThoseByDifferencesWhereItTouchesItself) {
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
    // Curled-up shape.
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
    EXPECT_LT(sum.norm(), 1e-12);  // Each wrench has its opposite.
    constexpr double h = 1e-7;
    for (std::size_t node = 0; node < count; ++node) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        for (const bool by_pose : {true, false}) {
          const double pose = by_pose ? h : 0, twist = by_pose ? 0 : h;
          contact.pull_points(all, one_moved(nodes, node, c, pose, twist), after);
          contact.pull_points(all, one_moved(nodes, node, c, -pose, -twist), before);
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
  EXPECT_GT(touched, 5 / one_case_of);
}

// Curled up by a tendon it touches itself without penetration.
TEST(RodSelfContact, ARodThatCurlsUpDoesNotPassThroughItself) {
  RodContactConfig touches{.law = {.stiffness = 1e5}}, ghost = touches;
  ghost.itself = false;
  double nearest[2] = {1, 1};
  for (const bool is_ghost : {false, true}) {
    TouchingRod moving(soft_arm_with_tendon(1e6), is_ghost ? ghost : touches);
    RodState state = moving.dynamics.rest();
    for (int i = 1; i <= 24; ++i) moving.go(state, {.tensions = {0.5 * i}}, {}, 2e-3, 0.04 * i);
    moving.go(state, {.tensions = {12}}, {}, 2e-3, 1.2);
    // From the base to places further than ten radii along it.
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

// A moment at its tip rolls it up into a plane coil that closes on itself. Every step converges without
// division, and the tip converges with the step. Internal forces sum to 0, and the depth follows the contact
// law.
TEST(RodSelfContact, ACoilThatClosesOnItselfConverges) {
  const Rod rod = soft_arm(1e6, 8);
  const double full = rod.sections[0].stiffness_at(0)[3] / 0.025;  // To a radius of three times its own.
  constexpr double stiffness = 1e6;
  std::vector<Eigen::Vector3d> tips;
  for (const double h : {4e-3, 2e-3, 1e-3}) {
    TouchingRod moving(rod, {.law = {.stiffness = stiffness}}, 0.01);
    RodState state = moving.dynamics.rest();
    const long steps = std::lround(0.6 / h);
    std::size_t most = 0;
    for (long i = 0; i < steps; ++i) {
      const double part = std::min(1.0, (static_cast<double>(i) + 0.5) * h / 0.5);
      const RodLoads loads{
          .ends = {{.section = 0, .force = {0, 0, 0}, .moment = {0, part * full, 0}, .following = false}}};
      const RodStep step = moving.dynamics.step(state, {}, loads, h);
      ASSERT_TRUE(step.converged()) << h << " " << state.time;
      EXPECT_FALSE(step.is_anew) << h << " " << state.time;
      if (i % 8 != 0) continue;
      const std::vector<NodeMotion> points = moving.dynamics.point_motions(state);
      std::vector<std::size_t> all(points.size());
      std::iota(all.begin(), all.end(), std::size_t{0});
      std::vector<NodePull> pulls(points.size());
      moving.contact.pull_points(all, points, pulls);
      Vector6d sum = Vector6d::Zero();
      double size = 0;
      for (const NodePull& pull : pulls) {
        sum += pull.wrench;
        size += pull.wrench.norm();
      }
      EXPECT_LE(sum.norm(), 1e-12 * size);
      const std::vector<ContactForce> contacts = moving.contact.find(points);
      most = std::max(most, contacts.size());
      for (const ContactForce& contact : contacts) {
        EXPECT_FALSE(contact.is_deep);
        EXPECT_LT(contact.depth, 1e-3);
        // Both sides report it, each with half of its length. Separating contacts push less and never pull.
        if (contact.index == 0 || contact.index + 1 == points.size()) continue;
        const ContactPress still = press(moving.contact.law(), contact.depth, 0);
        EXPECT_GE(contact.normal_force, 0);
        EXPECT_LT(contact.normal_force, 3 * 0.5 * 0.01 * still.force);
      }
    }
    EXPECT_GE(most, 8u);
    tips.push_back(moving.dynamics.tip(state).position);
  }
  EXPECT_LT((tips[2] - tips[1]).norm(), 0.6 * (tips[1] - tips[0]).norm());
  EXPECT_LT((tips[2] - tips[1]).norm(), 0.002);
}

}  // namespace
}  // namespace flexura
