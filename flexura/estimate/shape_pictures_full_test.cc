// Random arms before two cameras, drawn, seen and estimated: a small docs/studies/seeing.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "tests/support/seen_shapes.h"

namespace flexura {
namespace {

TEST(ShapesInPictures, OfKnownArmsAreAsGoodAsTheirCovarianceSays) {
  constexpr int cases = 60;
  std::vector<double> errors, shares;
  for_random_cases(cases, [&](TestRandom& random) {
    const SeenShape one = random_seen_shape(random);
    std::vector<Sighting> seen;
    for (std::size_t i = 0; i < 2; ++i) {
      ArmFinder finder({.threshold = {}, .base = one.views[i].project(one.bent.arm.X_WB.position)});
      seen.push_back(sighting_of(finder.find(one.pictures[i]), one.views[i]));
    }
    const ShapeEstimate found = ShapeEstimator(ShapePrior{.arm = one.bent.arm}).estimate(seen);
    if (!found.is_found || !found.notes.empty()) return;
    errors.push_back(relative_shape_error(found.shape, one.bent.backbone()));
    shares.push_back(expected_share(found, one.bent.state));
  });
  EXPECT_GE(errors.size(), 0.75 * cases);
  double squares = 0;
  for (const double error : errors) squares += error * error / static_cast<double>(errors.size());
  EXPECT_LT(std::sqrt(squares), 2e-4);
  EXPECT_LT(std::ranges::max(errors), 5e-4);
  // Half of the errors lie in the region that holds half: neither much fewer, nor nearly all.
  const auto within = std::ranges::count_if(shares, [](double share) { return share < 0.5; });
  EXPECT_GT(static_cast<double>(within), 0.35 * static_cast<double>(shares.size()));
  EXPECT_LT(static_cast<double>(within), 0.75 * static_cast<double>(shares.size()));
}

// Of which nothing is known but two pictures that hardly fit each other: the fit shrinks it to a point.
TEST(ShapesInPictures, OfAnArmThatTheFitShrinksToNothingAreNone) {
  TestRandom random(3199);
  const SeenShape one = random_seen_shape(random);
  std::vector<Sighting> seen;
  for (std::size_t i = 0; i < 2; ++i) {
    ArmFinder finder({.threshold = {}, .base = one.views[i].project(one.bent.arm.X_WB.position)});
    seen.push_back(sighting_of(finder.find(one.pictures[i]), one.views[i]));
  }
  const ShapeEstimate none = ShapeEstimator(unknown_arm({}, {})).estimate(seen);
  EXPECT_FALSE(none.is_found);
  EXPECT_NE(none.reason, "");
}

}  // namespace
}  // namespace flexura
