#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A soft arm of 0.3 m.
Rod soft_arm(double youngs_modulus = 5e6, int bend = 4) {
  RodSection section{.length = 0.3,
                     .radius = {0.008, 0.008},
                     .youngs_modulus = youngs_modulus,
                     .shear_modulus = youngs_modulus / 3,
                     .density = 1100,
                     .damping_time = 0.01};
  section.modes = {.shear = 1, .stretch = 1, .bend = bend, .twist = 1};
  return {.sections = {section}, .tendons = {}};
}

[[maybe_unused]]
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
  const RodChain chain(rod, contact_places(rod, 0.05));
  const std::size_t count = chain.elements()[0].grid().t.size();
  int touched = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const RodContact contact(chain, {.law = {.stiffness = 1e4, .damping = 0.5, .slip_speed = 0.1},
                                     .radii = {{0.03, 0.02}},
                                     .itself_apart = 3});
    // Curled up.
    std::vector<NodeMotion> nodes(count);
    const double radius = random.uniform(0.03, 0.04), rise = random.uniform(0, 0.02);
    for (std::size_t k = 0; k < count; ++k) {
      const double s = 0.3 * chain.elements()[0].grid().t[k], angle = s / radius;
      nodes[k].pose.position = Eigen::Vector3d(radius * (1 - std::cos(angle)), rise * angle,
                                               radius * std::sin(angle)) +
                               random.vector<3>(-0.003, 0.003);
      nodes[k].twist << random.vector<3>(-0.3, 0.3), random.vector<3>(-2.0, 2.0);
    }
    const std::vector<double> run(count, 0.0);
    std::vector<NodePull> pulls(count), after(count), before(count);
    contact.pull(nodes, run, pulls);
    std::vector<NodeCoupling> couplings;
    contact.couple(nodes, run, couplings);
    touched += couplings.empty() ? 0 : 1;
    Vector6d sum = Vector6d::Zero();
    for (const NodePull& pull : pulls) sum += pull.wrench;
    EXPECT_LT(sum.norm(), 1e-12);  // To each its opposite.
    constexpr double h = 1e-7;
    for (std::size_t node = 0; node < count; ++node) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        for (const bool by_pose : {true, false}) {
          const double pose = by_pose ? h : 0, twist = by_pose ? 0 : h;
          contact.pull(moved(nodes, node, c, pose, twist), run, after);
          contact.pull(moved(nodes, node, c, -pose, -twist), run, before);
          for (std::size_t at = 0; at < count; ++at) {
            Matrix6d slopes = Matrix6d::Zero();
            if (at == node) slopes = by_pose ? pulls[at].by_pose : pulls[at].by_twist;
            for (const NodeCoupling& each : couplings)
              if (each.of == node && each.at == at) slopes += by_pose ? each.by_pose : each.by_twist;
            const Vector6d difference = (after[at].wrench - before[at].wrench) / (2 * h);
            EXPECT_LT((slopes.col(c) - difference).norm(), 1e-4 * (1 + difference.norm()))
                << node << " " << at << " " << c << " " << by_pose;
          }
        }
      }
    }
  });
  EXPECT_GT(touched, 40 / one_case_of);
}

}  // namespace
}  // namespace flexura
