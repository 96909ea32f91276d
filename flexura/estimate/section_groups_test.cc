#include "flexura/estimate/section_groups.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <string>

#include "flexura/estimate/shape_estimator.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// An arm of `count` equal sections, 1 m long.
Arm arm_of(std::size_t count) {
  Arm arm = three_section_arm();
  const Section section{.length = 1.0 / static_cast<double>(count), .radius = arm.sections[0].radius};
  arm.sections.assign(count, section);
  return arm;
}

TEST(SectionGroups, KeepTheCurve) {
  for_random_cases(30, [](TestRandom& random) {
    const std::size_t count = static_cast<std::size_t>(random.integer(1, 90)),
                      most = static_cast<std::size_t>(random.integer(1, 40));
    ShapePrior prior = described_arm(arm_of(count));
    for (Section& section : prior.arm.sections) section.length *= random.uniform(0.5, 2);
    const ShapePrior grouped = with_grouped_sections(prior, most);
    EXPECT_EQ(grouped.arm.sections.size(), std::min(count, most));
    EXPECT_NEAR(grouped.arm.length(), prior.arm.length(), 1e-12);
    const Shape coarse{grouped.arm, random_bends(random, grouped.arm, 0.5)};
    const Shape fine = without_groups(prior, coarse, most);
    const Backbone one(coarse.arm, coarse.state), other(fine.arm, fine.state);
    for (const double share : {0.2, 0.5, 1.0}) {
      const double s = share * prior.arm.length();
      EXPECT_LT(
          (one.pose(std::min(s, one.length())).position - other.pose(std::min(s, other.length())).position)
              .norm(),
          1e-12);
    }
  });
}

// The true arm has three sections, which the others contain.
TEST(SectionGroups, ArmsOfManySectionsAreFound) {
  for (const std::size_t count : {3, 12, 15, 30, 60, 99}) {
    for_random_cases(4, [&](TestRandom& random) {
      const Arm three = arm_of(3);
      const Backbone truth(three, random_bends(random, three, 1.4));
      ShapeEstimator estimator(described_arm(arm_of(count)));
      const ShapeEstimate found = estimator.estimate(observations_of(truth, random, 0.05));
      ASSERT_TRUE(found.is_found) << count << " sections: " << found.reason;
      EXPECT_LT(shape_error(found.shape, truth), 1e-3) << count << " sections";
      EXPECT_EQ(found.shape.state.bends.size(), count);
      EXPECT_GT(found.rms_sigma(), 0);
      EXPECT_LT(found.rms_sigma(), 1e-3) << count << " sections";
    });
  }
}

}  // namespace
}  // namespace flexura
