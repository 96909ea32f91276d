#include <gtest/gtest.h>

#include <Eigen/Core>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"

// Sanitizers replace the allocator.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "tests/support/malloc_count.h"

namespace flexura {
namespace {

TEST(DynamicsAllocation, HappensInNoStep) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 6000;
    section.damping_time = 1e-3;
  }
  const RodLoads weight{.gravity = {0, -9.81, 0}};
  for (const bool by_displacement : {false, true}) {
    RodDynamics dynamics(rod);
    RodState state = dynamics.rest();
    TendonInput tendons;
    const std::vector<double> input(rod.tendons.size(), by_displacement ? 1e-4 : 0.5);
    (by_displacement ? tendons.displacements : tendons.tensions) = input;
    ASSERT_TRUE(dynamics.step(state, tendons, weight, 0.005).converged());
    const long before = mallocs;
    for (int i = 0; i < 10; ++i) {
      const RodStep step = dynamics.step(state, tendons, weight, 0.005);
      EXPECT_TRUE(step.converged());
      EXPECT_EQ(step.pieces, 1);
    }
    EXPECT_EQ(mallocs - before, 0) << by_displacement;
  }
}

}  // namespace
}  // namespace flexura

#endif
