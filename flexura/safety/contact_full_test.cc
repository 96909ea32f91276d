// A contact that takes long to check: half a minute with sanitizers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/safety/motion_check.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

using std::numbers::pi;

TEST(Contact, FindsThickSectionsThatMeetRoundAThinOneWithinHalfATurn) {
  Arm arm;
  arm.sections.resize(3);
  for (Section& section : arm.sections) section.radius = {0.1, 0.1};
  arm.sections[1].length = 0.1;
  arm.sections[1].radius = {0.02, 0.02};
  const auto folded_by = [&](double bend) {
    ArmState state = ArmState::straight(3);
    state.bends[1].x() = bend;
    return state;
  };
  const MotionPtr fold =
      point_to_point_motion(folded_by(0), folded_by(0.9 * pi), std::vector(3, Profile::linear(9)));
  const SafetyReport report = check_motions(arm, {}, folded_by(0), {{fold, 0}}, 0.02);
  EXPECT_TRUE(report.caveats.empty());
  ASSERT_FALSE(report.is_safe());
  const Violation& contact = report.violations.front();
  EXPECT_EQ(contact.hazard, Hazard::self_contact);
  EXPECT_EQ(contact.section, 0U);
  EXPECT_EQ(contact.other_section, 2U);
  // Neighbours are less than half a circle of 0.1 m apart along the arm. The first pairs that are not
  // neighbours are symmetric about the middle of the thin section. They are at the ends of straight parts and
  // half of the arc.
  double touching = pi / 2;
  for (double low = 0.3 * pi, high = 0.9 * pi; high - low > 1e-12;) {
    touching = (low + high) / 2;
    const double straight = (pi * 0.1 - 0.1) / 2;
    const double apart = 2 * (0.1 / touching * std::sin(touching / 2) + straight * std::cos(touching / 2));
    (apart > 0.2 ? low : high) = touching;
  }
  EXPECT_NEAR(contact.start, 9 * touching / (0.9 * pi), 1e-3);
  EXPECT_EQ(contact.end, 9);
}

}  // namespace
}  // namespace flexura
