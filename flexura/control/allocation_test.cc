#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdlib>

#include "flexura/control/distributed_arm.h"
#include "flexura/control/potential_law.h"
#include "tests/support/random_cases.h"

// Sanitizers have an allocator of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<long> mallocs{0};
}  // namespace

extern "C" {
// glibc's own. NOLINTNEXTLINE(readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++mallocs;
  return __libc_malloc(size);
}
}

namespace flexura {
namespace {

TEST(Allocation, HappensInNoStepOfTheArmOrItsLaw) {
  DistributedArm arm({.lengths = {0.5, 0.5},
                      .has_variable_lengths = true,
                      .bending_stiffness = 0.3,
                      .axial_stiffness = 50,
                      .damping = 0.1});
  const PotentialLaw law(arm, arm.coordinates([](double s) { return Eigen::Vector2d(s, 0.5 * s); }), {});
  Eigen::VectorXd x = Eigen::VectorXd::Constant(arm.size(), 0.01), v = x, Q = x, a = x;
  const auto step = [&] {
    arm.set(x, v);
    law.force(arm, x, v, Q);
    return arm.accelerate(Q, a);
  };
  ASSERT_TRUE(step());
  const long before = mallocs;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(step());
  EXPECT_EQ(mallocs - before, 0);
  // The count counts.
  const Eigen::VectorXd other = 2 * x;
  EXPECT_GT(mallocs - before, 0);
  EXPECT_EQ(other[0], 0.02);
}

}  // namespace
}  // namespace flexura

#endif
