// Tests features with the derivatives of the whole way, from the observed shape to the target.
#include "flexura/servo/servo_features.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <numbers>

#include "flexura/control/plane_errors.h"
#include "flexura/model/arm_difference.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

// A way of an arm, `size` long in each bend, and its features for a law.
struct ShownDifference {
  ArmState seen, desired, halfway;
  Eigen::VectorXd way, seen_values, desired_values;

  ShownDifference(ServoFeatures& features, const std::array<View, 2>& views, const ArmState& from,
                  const ArmState& unit_difference, double size)
      : seen(from), desired(from) {
    for (std::size_t i = 0; i < from.bends.size(); ++i) desired.bends[i] += size * unit_difference.bends[i];
    halfway = interpolate(seen, desired, 0.5);
    way.setZero(3 * static_cast<Eigen::Index>(from.bends.size()));
    for (std::size_t i = 0; i < from.bends.size(); ++i)
      way.segment<2>(3 * static_cast<Eigen::Index>(i)) = -size * unit_difference.bends[i];
    EXPECT_TRUE(features.predict(seen, views, seen_values));
    EXPECT_TRUE(features.predict(desired, views, desired_values));
  }
  [[nodiscard]] FeatureError secant(ServoFeatures& features, const std::array<View, 2>& views) const {
    FeatureError result;
    EXPECT_TRUE(features.secant(seen_values, desired_values, {seen, desired, halfway}, views, result));
    return result;
  }
  [[nodiscard]] FeatureError tangent(ServoFeatures& features, const std::array<View, 2>& views) const {
    FeatureError result;
    EXPECT_TRUE(features.error(seen_values, desired_values, seen, views, result));
    return result;
  }
  // Returns the norm of the error that the derivatives do not explain.
  [[nodiscard]] double rest(const FeatureError& error) const {
    return (error.error - error.by_state * way).norm();
  }
};

// Derivatives half-way leave a residual of third order in the way's length, those at the current shape one of
// second order. On a zero way both are equal.
TEST(ServoFeatures, TellTheWholeWayByTheArmHalfWay) {
  for (const ServoLawKind law : {ServoLawKind::points, ServoLawKind::chords, ServoLawKind::moments}) {
    double worst_order = 1e9, rests = 0, tangents = 0;
    for_random_cases(20, [&](TestRandom& random) {
      const Arm arm = servo_arm();
      const std::array<View, 2> views = servo_views();
      const auto features = servo_features(law, arm, 8);
      const ArmState from = random_servo_state(random, arm, 0.6),
                     unit_difference = random_servo_state(random, arm, 1);
      const ShownDifference there(*features, views, from, unit_difference, 0.2),
          nearer(*features, views, from, unit_difference, 0.1),
          none(*features, views, from, unit_difference, 0);
      const double rest = there.rest(there.secant(*features, views));
      rests += rest, tangents += there.rest(there.tangent(*features, views));
      worst_order = std::min(worst_order, rest / nearer.rest(nearer.secant(*features, views)));
      // Chords are also weighted by the length of their images.
      const Eigen::MatrixXd at_rest = none.secant(*features, views).by_state,
                            slopes = none.tangent(*features, views).by_state;
      EXPECT_EQ(none.secant(*features, views).error.norm(), 0);
      EXPECT_LT((at_rest.rowwise().normalized() - slopes.rowwise().normalized()).norm(), 1e-9);
      if (law == ServoLawKind::chords) return;
      EXPECT_EQ(there.secant(*features, views).error, there.tangent(*features, views).error);
      EXPECT_EQ(at_rest, slopes);
    });
    std::printf(
        "law %d: half the way leaves 1/%.1f or less, the derivatives where it stands %.0f times as much\n",
        static_cast<int>(law), worst_order, tangents / rests);
    EXPECT_GT(worst_order, 6);
    EXPECT_GT(tangents, 5 * rests);
  }
}

// Slip of edges along themselves remains, which no derivative covers. Half-way derivatives must leave a tenth
// of what those at the current shape leave, on a way of half a rad per bend.
TEST(ServoFeatures, OfSilhouettesTellTheWholeWayButForSlips) {
  double rests = 0, tangents = 0;
  for_random_cases(20, [&](TestRandom& random) {
    const Arm arm = servo_arm();
    const std::array<View, 2> views = servo_views();
    const auto features = servo_features(ServoLawKind::silhouettes, arm, 8);
    const ArmState from = random_servo_state(random, arm, 0.6), way = random_servo_state(random, arm, 1);
    const ShownDifference there(*features, views, from, way, 0.5), none(*features, views, from, way, 0);
    rests += there.rest(there.secant(*features, views));
    tangents += there.rest(there.tangent(*features, views));
    const Eigen::MatrixXd slopes = none.tangent(*features, views).by_state;
    EXPECT_LT((none.secant(*features, views).by_state - slopes).norm(), 1e-9 * slopes.norm());
  });
  std::printf("the way by edges: %.3f of what is left by the derivatives where the arm stands\n",
              rests / tangents);
  EXPECT_LT(rests, 0.3 * tangents);
}

// The whole arm turned over: results must be finite and not excessively large.
TEST(ServoFeatures, OfWaysThatHaveNoMiddleAreNumbersAllTheSame) {
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  const ArmState from = {{{2, 0}, {2, 0}, {2, 0}}, {1, 1, 1}},
                 over = {{{-4, 0}, {-4, 0}, {-4, 0}}, {1, 1, 1}};
  for (const ServoLawKind law : {ServoLawKind::points, ServoLawKind::chords, ServoLawKind::silhouettes}) {
    const auto features = servo_features(law, arm, 8);
    const ShownDifference opposite(*features, views, from, over, 1);
    EXPECT_EQ(opposite.desired.bends[2], Eigen::Vector2d(-2, 0));
    const FeatureError error = opposite.secant(*features, views);
    EXPECT_TRUE(error.error.allFinite());
    EXPECT_TRUE(error.by_state.allFinite());
    EXPECT_LT(error.by_state.norm(), 1e4);
  }
}

// An azimuth of 170 degrees is 20 degrees from one of -170: the planes must handle this way like any other.
TEST(ServoFeatures, OfPlanesTellAcrossHalfATurn) {
  const Arm arm = servo_arm();
  const ArmState state = ArmState::straight(arm.sections.size());
  const auto features = plane_features(arm, 1);
  // For one chord: values from the planes, which are `off` different from those of the shape.
  const auto values = [](double theta, double q, double off) {
    const PlaneView view = plane_view(theta + off, q);
    return Eigen::Vector4d(std::remainder(view.alpha_1, 2 * std::numbers::pi), view.alpha_2, theta, q);
  };
  constexpr double degree = std::numbers::pi / 180, off = 0.01;
  for (const double side : {1.0, -1.0}) {
    FeatureError found;
    ASSERT_TRUE(features->error(values(side * 170 * degree, 0.3, off), values(-side * 170 * degree, 0.2, 0),
                                state, servo_views(), found));
    EXPECT_NEAR(found.error[0], std::cos(0.3) * (-side * 20 * degree + off), 1e-3);
    EXPECT_NEAR(found.error[1], 0.1, 0.02);
  }
}

// A measurement that is not a number must stay so, for the limiter to stop. Missing edges must be ignored.
TEST(ServoFeatures, OfWhatIsNoNumberTellNone) {
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  const ArmState from = {{{0.4, 0.1}, {-0.2, 0.5}, {0.1, 0.3}}, {1, 1, 1}},
                 way = {{{0.1, 0}, {0, -0.4}, {0.2, 0}}, {1, 1, 1}};
  for (const ServoLawKind law : {ServoLawKind::shape, ServoLawKind::points, ServoLawKind::chords,
                                 ServoLawKind::potential, ServoLawKind::silhouettes}) {
    const auto features = servo_features(law, arm, 8);
    ShownDifference there(*features, views, from, way, 1);
    there.seen_values[0] = std::nan("");
    const FeatureError error = there.secant(*features, views);
    EXPECT_EQ(error.error.allFinite(), law == ServoLawKind::silhouettes) << static_cast<int>(law);
  }
}

}  // namespace
}  // namespace flexura
