#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "flexura/control/distributed_arm.h"
#include "flexura/mechanics/dynamics.h"
#include "tests/support/random_cases.h"

// The paper's distributed arm and the rods of mechanics/ are the same continuum in other numbers
// (docs/control.md, "Why the distributed arm is a separate model").
namespace flexura {
namespace {

using Eigen::Index, Eigen::VectorXd, Eigen::Vector3d;

// The rod's base has x along X and z along Y of the distributed arm's world.
Vector3d world_of(const Vector3d& v) { return {v.x(), v.z(), -v.y()}; }
Vector3d base_of(const Vector3d& v) { return {v.x(), -v.z(), v.y()}; }

// The same arm twice, without variable lengths.
Rod rod_like(const DistributedArmModel& model, int bends, bool is_planar, int nodes) {
  Rod rod;
  for (const double length : model.lengths) {
    RodSection section{.length = length,
                       .stiffness = Vector6d::Constant(model.bending_stiffness),
                       .mass_per_length = model.density};
    section.modes = {.shear = 0, .stretch = 0, .bend = bends, .twist = 0, .planar = is_planar};
    section.nodes = nodes;
    rod.sections.push_back(section);
  }
  return rod;
}

// Where the distributed arm's numbers are its angles.
std::vector<RodPlace> places_of(const DistributedArm& arm) {
  std::vector<RodPlace> places;
  for (double s : arm.shapes().nodes) {
    std::size_t section = 0;
    while (section + 1 < arm.model().lengths.size() && s > arm.model().lengths[section] * (1 + 1e-12))
      s -= arm.model().lengths[section++];
    places.push_back({section, std::min(1.0, s / arm.model().lengths[section])});
  }
  return places;
}

struct Angles {
  VectorXd x, v;
};
// The distributed arm's numbers where the rod's directions are those at these places.
Angles angles_of(RodDynamics& rod, const RodState& state, const std::vector<RodPlace>& places) {
  const auto n = static_cast<Index>(places.size());
  Angles angles{.x = VectorXd(2 * n), .v = VectorXd(2 * n)};
  for (Index i = 0; i < n; ++i) {
    const NodeMotion motion = rod.motion(state, places[static_cast<std::size_t>(i)]);
    const Vector3d turning = motion.twist.tail<3>(), along = motion.pose.rotation.col(2);
    const Vector3d e = world_of(along), e_t = world_of(turning.cross(along));
    angles.x[i] = std::atan2(e.x(), e.y());
    angles.x[n + i] = std::asin(e.z());
    angles.v[i] = (e_t.x() * e.y() - e.x() * e_t.y()) / (e.x() * e.x() + e.y() * e.y());
    angles.v[n + i] = e_t.z() / std::sqrt(1 - e.z() * e.z());
  }
  return angles;
}

constexpr RodDynamicsConfig exact{.spectral_radius = 1, .tolerance = 1e-11, .rotary_inertia = false};

// In a plane a polynomial curvature is a polynomial angle, and a constant one a linear angle. Both models
// have the same shapes, so they agree up to the rod's quadrature.
TEST(DistributedArmAndRod, AgreeInAPlaneInEnergiesAndAccelerations) {
  double most = 0;
  for_random_cases(24, [&most](TestRandom& random) {
    const bool is_polynomial = random.integer(0, 1) == 0;
    const int numbers = is_polynomial ? random.integer(1, 4) : 1;
    DistributedArmModel model{.lengths = {random.uniform(0.3, 0.8)},
                              .density = random.uniform(0.2, 2),
                              .gravity = {random.uniform(-10, 10), random.uniform(-10, 10), 0},
                              .bending_stiffness = random.uniform(0, 0.5),
                              .basis = is_polynomial ? AngleBasis::polynomial : AngleBasis::sections,
                              .nodes = numbers,
                              .points = 16};
    model.bending_stiffness += 1e-3;
    for (int more = is_polynomial ? 0 : random.integer(0, 2); more > 0; --more)
      model.lengths.push_back(random.uniform(0.3, 0.8));
    DistributedArm arm(model);
    const std::vector<RodPlace> places = places_of(arm);
    RodDynamics rod(rod_like(model, numbers, true, 20), exact, places);
    const RodLoads loads{.gravity = base_of(model.gravity)};
    const Index n = rod.chain().size();
    ASSERT_EQ(n, arm.nodes());
    VectorXd q(n), v(n);
    for (Index i = 0; i < n; ++i) {
      q[i] = random.uniform(-0.7, 0.7) / rod.chain().scales()[i];
      v[i] = random.uniform(-3, 3) / rod.chain().scales()[i];
    }
    const RodState state = rod.start(q, v, {}, loads);
    const Angles angles = angles_of(rod, state, places);
    arm.set(angles.x, angles.v);
    const RodEnergy energy = rod.energy(state, loads);
    const auto compare = [&](double of_rod, double of_arm, double scale) {
      EXPECT_NEAR(of_rod, of_arm, 1e-7 * scale);
      most = std::max(most, std::abs(of_rod - of_arm) / scale);
    };
    const double scale = 1 + arm.kinetic_energy();
    compare(energy.kinetic, arm.kinetic_energy(), scale);
    compare(energy.strain, arm.elastic_energy(), 1 + arm.elastic_energy());
    compare(energy.gravity, arm.gravity_energy(), scale + std::abs(arm.gravity_energy()));
    // The angles are linear in the rod's modes, so accelerations are, too.
    VectorXd of_arm(arm.size());
    ASSERT_TRUE(arm.accelerate(VectorXd::Zero(arm.size()), of_arm));
    const VectorXd a = rod.acceleration(q, v, {}, loads);
    const double size = 1 / (1 + a.cwiseProduct(rod.chain().scales()).cwiseAbs().maxCoeff());
    const Angles by_rod = angles_of(rod, rod.start(size * a, VectorXd::Zero(n), {}, loads), places);
    for (Index i = 0; i < n; ++i) compare(by_rod.x[i] / size, of_arm[i], 1 + of_arm.cwiseAbs().maxCoeff());
  });
  std::printf("largest difference %.1e\n", most);
}

// How far the tips of both are from each other after a swing out of a plane, m, of 0.5 m.
double apart_after_a_swing(int numbers) {
  const DistributedArmModel model{.lengths = {0.5},
                                  .density = 0.3,
                                  .gravity = {4, -7, 3},
                                  .bending_stiffness = 0.15,
                                  .basis = AngleBasis::polynomial,
                                  .nodes = numbers,
                                  .points = numbers + 8};
  const DistributedArm arm(model);
  const std::vector<RodPlace> places = places_of(arm);
  RodDynamics rod(rod_like(model, numbers, false, numbers + 8), exact, places);
  const RodLoads loads{.gravity = base_of(model.gravity)};
  // Curvatures (1 - t)^2 and (1 - t)^3, which end evenly at the tip.
  VectorXd q = VectorXd::Zero(2 * numbers);
  q.segment(0, 4) = 4 * Eigen::Vector4d(0.25, -0.45, 0.25, -0.05);
  q.segment(numbers, 3) = 5 * Vector3d(1.0 / 3, -0.5, 1.0 / 6);
  RodState state = rod.start(q, VectorXd::Zero(2 * numbers), {}, loads);
  DistributedMotion motion(arm,
                           [](double, const DistributedArm&, const VectorXd&, const VectorXd&, VectorXd& Q) {
                             Q.setZero();
                             return 0.0;
                           },
                           {.relative = 1e-9, .absolute = 1e-11, .first_step = 1e-5});
  motion.start(angles_of(rod, state, places).x);
  constexpr int steps = 1000;
  constexpr double time = 0.15;
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(rod.step(state, {}, loads, time / steps).converged());
  EXPECT_TRUE(motion.advance(time));
  return (world_of(rod.tip(state).position) - motion.arm().tip()).norm();
}

// Out of a plane polynomials of angles are no polynomials of curvatures: what the models have in common is
// what both come to with many numbers.
TEST(DistributedArmAndRod, OutOfAPlaneComeNearerWithEachNumberMore) {
  const double coarse = apart_after_a_swing(4), finer = apart_after_a_swing(6),
               finest = apart_after_a_swing(8);
  std::printf("apart by %.1e, %.1e, %.1e m\n", coarse, finer, finest);
  EXPECT_GT(coarse, 1e-5);  // They are not the same.
  EXPECT_LT(finer, coarse / 8);
  EXPECT_LT(finest, coarse / 20);
}

}  // namespace
}  // namespace flexura
