#include "flexura/equipment/grbl_path.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace flexura {
namespace {

using Steps = std::vector<std::int64_t>;

constexpr double tolerance = 2;  // Steps.

GrblPath path_at_zero() {
  return GrblPath({.per_mm = {100, 100}, .rates = {50, 50}, .accelerations = {1e4, 1e4}});
}

// There and back over the same line, at 10 mm/s: 1000 steps take 1 s.
TEST(GrblPath, KnowsTheWayBackFromTheWayThere) {
  GrblPath path = path_at_zero();
  path.add({800, 600}, 600, 0);
  path.add({0, 0}, 600, 0);
  EXPECT_TRUE(path.can_be_at(Steps{400, 300}, tolerance, 0.5));
  path.report(Steps{400, 300}, 0.5);
  EXPECT_TRUE(path.can_be_at(Steps{760, 570}, tolerance, 0.95));
  path.report(Steps{760, 570}, 0.95);
  // 50 steps to the turn and 100 back.
  EXPECT_TRUE(path.can_be_at(Steps{720, 540}, tolerance, 1.1));
  EXPECT_FALSE(path.can_be_at(Steps{720, 540}, tolerance, 1.0)) << "too early";
  EXPECT_FALSE(path.can_be_at(Steps{720, 560}, tolerance, 1.1)) << "beside the line";
  path.report(Steps{720, 540}, 1.1);
  EXPECT_FALSE(path.can_be_at(Steps{760, 570}, tolerance, 1.2)) << "behind";
  EXPECT_TRUE(path.can_be_at(Steps{400, 300}, tolerance, 1.5));
  EXPECT_NEAR(path.lag(1.1), 0.9, 0.02);
}

// A report of the turn itself, before the controller goes back.
TEST(GrblPath, KnowsTheWayBackAfterAReportOfTheTurn) {
  GrblPath path = path_at_zero();
  path.add({800, 600}, 600, 0);
  path.add({0, 0}, 600, 0);
  path.report(Steps{800, 600}, 1);
  EXPECT_TRUE(path.can_be_at(Steps{640, 480}, tolerance, 1.2));
  path.report(Steps{640, 480}, 1.2);
  EXPECT_NEAR(path.lag(1.2), 0.8, 0.02);
}

}  // namespace
}  // namespace flexura
