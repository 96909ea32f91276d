#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/safety/motion_check.h"
#include "tests/support/arms.h"
#include "tests/support/sampled_clearance.h"

namespace flexura {
namespace {

using std::numbers::pi;

// Returns a planar arm of equal sections of 1 m.
Arm even_arm(std::size_t sections, double radius) {
  Arm arm;
  arm.sections.resize(sections);
  for (Section& section : arm.sections) section.radius = {radius, radius};
  return arm;
}

ArmState bent(std::size_t sections, double bend) {
  ArmState state = ArmState::straight(sections);
  for (auto& b : state.bends) b.x() = bend;
  return state;
}

TEST(Contact, ATubeThatBendsAsSharplyAsItCanIsFreeUntilItMeetsItself) {
  // With curvature times radius 0.999 the inner side almost folds. Neighbours touch, which does not count as
  // a contact.
  const Arm arm = even_arm(4, 0.999);
  const ContactWatch watch(arm);
  const Contact half_circle = watch.contact(bent(4, 0.999 * pi / 4));
  EXPECT_EQ(half_circle.clearance, no_distance);
  for (const double bend : {0.8, 0.9, 1.0}) {
    // Ends are 4 bend apart on a circle of radius 1 / bend.
    const double expected = 2 * std::sin(2 * bend) / bend - 2 * 0.999;
    EXPECT_NEAR(watch.contact(bent(4, bend)).clearance, std::min(expected, 2 / bend - 2 * 0.999), 1e-6)
        << bend;
  }
}

TEST(Contact, FindsWhenAnArmCurlsIntoItself) {
  // Four sections that close to a circle at 2 pi: the tip meets the base a tube's width before.
  const Arm arm = even_arm(4, 0.05);
  const MotionPtr curl =
      point_to_point_motion(bent(4, 0), bent(4, pi / 2), std::vector(4, Profile::linear(10)));
  const SafetyReport report = check_motions(arm, {}, curl->at(0), {{curl, 0}}, 0.02);
  ASSERT_EQ(report.violations.size(), 1u);
  const Violation& contact = report.violations[0];
  EXPECT_EQ(contact.hazard, Hazard::self_contact);
  EXPECT_EQ(contact.section, 0u);
  EXPECT_EQ(contact.other_section, 3u);
  EXPECT_EQ(contact.end, 10);
  EXPECT_NEAR(contact.value, 0.1, 1e-6);
  double touching = pi / 2;  // 2 sin(2 bend) / bend = 0.1 by bisection.
  for (double low = 1.2, high = pi / 2; high - low > 1e-14;) {
    touching = (low + high) / 2;
    (2 * std::sin(2 * touching) / touching > 0.1 ? low : high) = touching;
  }
  EXPECT_NEAR(contact.start, 10 * touching / (pi / 2), 2e-4);
  EXPECT_EQ(contact.text().substr(contact.text().find(": ") + 2),
            "sections 1 and 4: contact with each other, 100 mm deep");
}

TEST(Contact, NamesEverySectionThatTouchesWhileItDoes) {
  const Arm arm = even_arm(3, 0.05);
  // A wall along the arm. The last section leaves it at once; the other sections stay.
  const auto wall = obstacles({PlaneConfig{.name = "wall", .point = {0.049, 0, 0}, .normal = {-1, 0, 0}}});
  ArmState leaning = bent(3, 0);
  leaning.bends[1].x() = -0.1;
  const MotionPtr lean = point_to_point_motion(leaning, bent(3, 0), std::vector(3, Profile::linear(1)));
  const SafetyReport report = check_motions(arm, wall, leaning, {{lean, 0}}, 0.02);
  ASSERT_EQ(report.violations.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(report.violations[i].section, i);
    EXPECT_EQ(report.violations[i].end, 1);
    EXPECT_NEAR(report.violations[i].value, 1e-3, 1e-9);
  }
  EXPECT_EQ(report.violations[0].start, 0);
  EXPECT_EQ(report.violations[1].start, 0);
  // The third section's base leans away by (1 - cos b) / b, about b / 2.
  EXPECT_NEAR(report.violations[2].start, 1 - 2e-3 / 0.1, 2e-4);
}

// An arm that stands on the ground for five minutes and bends down to it for a moment.
class LongTask : public ::testing::Test {
 protected:
  static constexpr double peak = 101.5;

  static ArmState bow(double share) {
    ArmState state = bent(2, 0);
    state.bends[0].x() = share * 100 * degree;
    state.bends[1].x() = share * 60 * degree;
    return state;
  }
  // Returns true if a section touches the ground.
  [[nodiscard]] bool touches(std::size_t section, double time) const {
    return std::ranges::any_of(ContactWatch(arm_, ground_[0]).contacts(law_->at(time)),
                               [&](const Contact& contact) { return contact.section == section; });
  }
  void expect_both(const SafetyReport& report, double step) const {
    ASSERT_EQ(report.violations.size(), 2u);
    const Violation& standing = report.violations[0];
    EXPECT_EQ(standing.section, 0u);
    EXPECT_EQ(standing.start, 0);
    EXPECT_EQ(standing.end, 300);
    const Violation& bowing = report.violations[1];
    EXPECT_EQ(bowing.section, 1u);
    EXPECT_NEAR(bowing.worst_time, peak, step);
    EXPECT_NEAR(bowing.value, -ContactWatch(arm_, ground_[0]).contacts(bow(1)).back().clearance, 1e-5 + step);
    EXPECT_FALSE(touches(1, bowing.start - step));
    EXPECT_TRUE(touches(1, bowing.start + step));
    EXPECT_TRUE(touches(1, bowing.end - step));
    EXPECT_FALSE(touches(1, bowing.end + step));
  }

  Arm arm_ = even_arm(2, 0.05);
  std::vector<Obstacle> ground_ = obstacles({PlaneConfig{.name = "ground"}});
  MotionPtr law_ = keyframe_motion({0, 100.8, peak, 102.2, 300}, {bow(0), bow(0), bow(1), bow(0), bow(0)},
                                   Interpolation::linear);
};

TEST_F(LongTask, ASectionThatTouchesForAMomentIsFoundWithItsOwnTimeAndDepth) {
  expect_both(check_motions(arm_, ground_, bow(0), {{law_, 0}}, 0.02), 2e-4);
}

TEST_F(LongTask, SoItIsAtTheStepsOfAFormula) {
  constexpr double step = 0.01;
  const MotionPtr formula = function_motion(300, [this](double t) { return law_->at(t); });
  expect_both(check_motions(arm_, ground_, bow(0), {{formula, 0}}, step), step);
}

TEST_F(LongTask, SoIsAPairBesideOneThatAlwaysTouches) {
  // The first section is almost a circle and touches itself; the second one curls for a moment.
  arm_.sections[1].length = 0.4;
  const auto curl = [](double second) {
    ArmState state = bent(2, 350. * degree);
    state.bends[1].x() = second * degree;
    return state;
  };
  const MotionPtr law = keyframe_motion(
      {0, 10, 10.7, 11.4, 300}, {curl(0), curl(0), curl(340), curl(0), curl(0)}, Interpolation::linear);
  const SafetyReport report = check_motions(arm_, {}, curl(0), {{law, 0}}, 0.02);
  const auto pair = [&](std::size_t first, std::size_t second) {
    return std::ranges::find_if(report.violations, [&](const Violation& violation) {
      return violation.section == first && violation.other_section == second;
    });
  };
  ASSERT_NE(pair(0, 0), report.violations.end());
  EXPECT_EQ(pair(0, 0)->start, 0);
  EXPECT_EQ(pair(0, 0)->end, 300);
  const auto itself = pair(1, 1);
  ASSERT_NE(itself, report.violations.end());
  EXPECT_GT(itself->start, 10.5);
  EXPECT_LT(itself->end, 10.9);
  EXPECT_NEAR(itself->worst_time, 10.7, 1e-3);
  const Contact there = ContactWatch(arm_).contacts(curl(340)).back();
  EXPECT_EQ(there.section, 1u);
  EXPECT_NEAR(itself->value, -there.clearance, 2e-5);
}

TEST(Contact, OfThickAndThinSectionsIsThatOfSamples) {
  std::size_t contacts = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Arm arm = even_arm(static_cast<std::size_t>(random.integer(2, 4)), 0.1);
    arm.kind = ArmKind::spatial;
    const auto thick = static_cast<std::size_t>(random.integer(0, 1));
    ArmState state = bent(arm.sections.size(), 0);
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const bool is_thick = i % 2 == thick;
      arm.sections[i].length = is_thick ? random.uniform(0.2, 1) : random.uniform(0.05, 0.3);
      const double radius = is_thick ? random.uniform(0.05, 0.15) : 0.01;
      arm.sections[i].radius = {radius, radius * random.uniform(0.8, 1)};
      // Thin sections bend by less than half a turn, so that only the length along the arm defines
      // neighbours.
      const double way = random.uniform(-pi, pi);
      const double bend = is_thick ? random.uniform(0, 0.05) : random.uniform(1.5, 3);
      state.bends[i] = {bend * std::cos(way), bend * std::sin(way)};
    }
    const double found = ContactWatch(arm).contact(state).clearance;
    const double sampled = SampledArm(arm, state).clearance(1);
    if (found < -1e-6) {
      EXPECT_LT(sampled, found + 1e-2);  // The samples are coarse where neighbours begin.
    }
    if (sampled >= -2e-6) return;
    ++contacts;
    EXPECT_LE(found, sampled + 1e-6);
  });
  EXPECT_GT(contacts, 40U / one_case_of);
}

TEST(Contact, AStraightArmOfSectionsThickAndThinTouchesNothingOfItself) {
  Arm arm = even_arm(6, 0.1);
  for (std::size_t i = 0; i < 6; ++i) {
    arm.sections[i].length = i % 2 == 0 ? 0.05 : 0.02;
    arm.sections[i].radius = {i % 2 == 0 ? 0.1 : 0.01, i % 3 == 0 ? 0.2 : 0.02};
  }
  EXPECT_EQ(ContactWatch(arm).contact(ArmState::straight(6)).clearance, no_distance);
  EXPECT_GT(ContactWatch(arm).contact(bent(6, 0.1)).clearance, 0);
}

TEST(Contact, FindsATouchBetweenTwoSamplesOfTheClock) {
  const Arm arm = even_arm(1, 0.02);
  const Obstacle wall =
      obstacles({PlaneConfig{.name = "wall", .point = {0.4, 0, 0}, .normal = {-1, 0, 0}}}).front();
  // The tip swings out and back within half a second.
  const MotionPtr swing = sine_motion(bent(1, 0), {{1, 0}}, {0}, 1, 0.5);
  const SafetyReport report = check_motions(arm, {wall}, bent(1, 0), {{swing, 0}}, 0.5);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].hazard, Hazard::obstacle);
  EXPECT_EQ(report.violations[0].name, "wall");
  EXPECT_NEAR(report.violations[0].value, 1 - std::cos(1) + 0.02 - 0.4, 1e-4);
  EXPECT_GT(report.violations[0].start, 0.1);
  EXPECT_LT(report.violations[0].end, 0.4);
}

TEST(Contact, OfAnArmThatHardlyMovesIsDecidedSoon) {
  // 1e-9 rad in a day, so near to a ball that no time step is short enough to decide.
  const Arm arm = even_arm(1, 0.02);
  const MotionPtr creep = point_to_point_motion(bent(1, 0), bent(1, 1e-9), {Profile::linear(1e5)});
  for (const double gap : {1e-10, -1e-10, -3e-6}) {
    const auto ball = obstacles({SphereConfig{.center = {0.1, 0.9, 0}, .radius = 0.08 - gap}}).front();
    const SafetyReport report = check_motions(arm, {ball}, bent(1, 0), {{creep, 0}}, 1);
    EXPECT_EQ(report.is_safe(), gap > -1e-6) << gap;
  }
}

TEST(Contact, TheBaseMayStandOnTheGround) {
  PlaneConfig plane{.name = "ground"};
  const Arm arm = even_arm(2, 0.05);
  const auto clearance = [&] {
    return ContactWatch(arm, obstacles({plane}).front()).contact(ArmState::straight(2)).clearance;
  };
  EXPECT_NEAR(clearance(), -0.05, 1e-6);
  plane.ignore_base = 0.05;  // Touches, which is allowed.
  EXPECT_NEAR(clearance(), 0, 1e-6);
  plane.ignore_base = 1.5;
  EXPECT_NEAR(clearance(), 1.45, 1e-6);
  plane.ignore_base = 3;
  EXPECT_EQ(clearance(), no_distance);
}

}  // namespace
}  // namespace flexura
