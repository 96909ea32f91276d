#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "flexura/mechanics/inverse_statics.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

enum class TargetQuantity { tip, direction, pose, shape };

struct Tally {
  int robots = 0, reached = 0, least = 0, above = 0, evaluations = 0;
};

void ask(TestRandom& random, TargetQuantity quantity, bool is_loaded, Tally& tally) {
  Rod rod = random_rod(random);
  for (RodSection& section : rod.sections) section.modes = {.shear = 1, .stretch = 1, .bend = 4, .twist = 3};
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i)
    for (const double at : {0.3, 0.6, 1.0}) places.push_back({.section = i, .at = at});
  const std::vector<double> tensions = random_tensions(random, rod, 6);
  const RodLoads loads = is_loaded ? random_loads(random, rod) : RodLoads{};
  RodStatics statics(rod, quantity == TargetQuantity::shape ? places : std::vector<RodPlace>{});
  const Equilibrium made = statics.solve({.tensions = tensions}, loads);
  ASSERT_TRUE(made.converged());
  if (!made.stable) return;  // Nor is it reached.
  RodTarget target;
  if (quantity != TargetQuantity::shape) target.position = made.tip.position;
  if (quantity == TargetQuantity::direction) target.direction = made.tip.rotation.col(2);
  if (quantity == TargetQuantity::pose) target.rotation = made.tip.rotation;
  for (const RodPlace& place : places) {
    if (quantity != TargetQuantity::shape) break;
    const RodElement& element = statics.chain().elements()[place.section];
    target.places.push_back({place, element.poses()[element.grid().node_at(place.at)].position});
  }
  const InverseStaticsResult result =
      solve_inverse_statics(statics, target, loads, std::vector(tensions.size(), 8.0));
  EXPECT_TRUE(result.reached()) << result.problem;
  double effort = 0;
  for (const double tension : tensions) effort += tension * tension;
  ++tally.robots;
  tally.reached += result.reached() ? 1 : 0;
  tally.least += result.is_least ? 1 : 0;
  tally.above += result.effort > (1 + 1e-6) * effort + 1e-12 ? 1 : 0;
  tally.evaluations += result.evaluations;
}

TEST(InverseStaticsFull, ManyRobotsReachWhatTensionsMade) {
  for (const bool is_loaded : {false, true}) {
    for (const TargetQuantity quantity :
         {TargetQuantity::tip, TargetQuantity::direction, TargetQuantity::pose, TargetQuantity::shape}) {
      Tally tally;
      for_random_cases(300, [&](TestRandom& random) { ask(random, quantity, is_loaded, tally); });
      const double each = static_cast<double>(tally.evaluations) / tally.robots;
      std::printf(
          "%s %d: of %d robots %d reached, %d with least effort, %d above that which made the target; "
          "%.1f equilibria each\n",
          is_loaded ? "loaded" : "not loaded", static_cast<int>(quantity), tally.robots, tally.reached,
          tally.least, tally.above, each);
      EXPECT_EQ(tally.reached, tally.robots);
      EXPECT_GE(tally.least, 0.98 * tally.robots);
      EXPECT_LE(tally.above, 0.04 * tally.robots);
      EXPECT_LE(each, 16);
    }
  }
}

}  // namespace
}  // namespace flexura
