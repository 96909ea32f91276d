#include "flexura/servo/feature_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/control/interaction.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

constexpr int marked_points = 7;

// Returns an error-free observation in which only the shape was measured.
ServoObservation servo_observation(const ArmState& seen, const ArmState& desired) {
  ServoObservation observed;
  observed.desired = desired;
  observed.estimate.is_found = true, observed.estimate.shape.state = seen;
  for (std::size_t i = 0; i < 2; ++i) observed.seen[i].view = servo_views()[i];
  return observed;
}

Eigen::Vector2d place_in(const View& view, const ArmState& state, double share) {
  const Backbone backbone(servo_arm(), state);
  return view.project(backbone.pose(share * backbone.length()).position).value();
}

// Checks the marks of one picture for random pairs of shapes.
template <class Check>
void for_marks(ServoLawKind law, const Check& check) {
  for_random_cases(20, [&](TestRandom& random) {
    const ArmState seen = random_servo_state(random, servo_arm(), 0.8),
                   desired = random_servo_state(random, servo_arm(), 0.8);
    FeatureMarker marker(law, servo_arm(), marked_points);
    const auto marks = marker.of(servo_observation(seen, desired));
    for (std::size_t i = 0; i < 2; ++i) check(marks[i], servo_views()[i], seen, desired);
  });
}

double share_of(std::size_t k) { return static_cast<double>(k) / marked_points; }

TEST(FeatureMarks, OfPointsAreWhereTheArmIsAndShallBe) {
  for_marks(ServoLawKind::points,
            [](const auto& marks, const View& view, const auto& seen, const auto& desired) {
              ASSERT_EQ(marks.size(), marked_points);
              for (std::size_t k = 0; k < marks.size(); ++k) {
                ASSERT_EQ(marks[k].seen.size(), 1);
                EXPECT_LT((marks[k].seen[0] - place_in(view, seen, share_of(k + 1))).norm(), 1e-9);
                EXPECT_LT((marks[k].desired.at(0) - place_in(view, desired, share_of(k + 1))).norm(), 1e-9);
              }
            });
}

TEST(FeatureMarks, OfChordsHaveTheWantedDirectionAboutTheMeasuredMiddle) {
  for (const ServoLawKind law : {ServoLawKind::chords, ServoLawKind::potential}) {
    for_marks(law, [](const auto& marks, const View& view, const auto& seen, const auto& desired) {
      ASSERT_EQ(marks.size(), marked_points);
      for (std::size_t k = 0; k < marks.size(); ++k) {
        const auto &is = marks[k].seen, &shall = marks[k].desired;
        EXPECT_LT((is[0] - place_in(view, seen, share_of(k))).norm(), 1e-9);
        EXPECT_LT((is[1] - place_in(view, seen, share_of(k + 1))).norm(), 1e-9);
        EXPECT_LT((is[0] + is[1] - shall[0] - shall[1]).norm(), 1e-9);
        EXPECT_NEAR((is[1] - is[0]).norm(), (shall[1] - shall[0]).norm(), 1e-9);
        const double angle =
            chord_angle(place_in(view, desired, share_of(k)), place_in(view, desired, share_of(k + 1))).value;
        EXPECT_NEAR(std::remainder(chord_angle(shall[0], shall[1]).value - angle, 2 * M_PI), 0, 1e-9);
      }
    });
  }
}

TEST(FeatureMarks, OfSilhouettesAreOnBothEdges) {
  int compared = 0;
  for_marks(ServoLawKind::silhouettes,
            [&](const auto& marks, const View& view, const auto& seen, const auto& desired) {
              EXPECT_LE(marks.size(), 2 * marked_points);
              for (const FeatureMark& mark : marks) {
                double is = 1e9, shall = 1e9;
                for (std::size_t k = 1; k <= marked_points; ++k) {
                  is = std::min(is, (mark.seen.at(0) - place_in(view, seen, share_of(k))).norm());
                  shall = std::min(shall, (mark.desired.at(0) - place_in(view, desired, share_of(k))).norm());
                }
                // Half the image width of an arm of 2 cm, 2 m from cameras with f = 900 px.
                const double half = servo_arm().sections[0].radius.at(0) * 900 / 2;
                EXPECT_LT(is, 3 * half);
                EXPECT_LT(shall, 3 * half);
                ++compared;
              }
            });
  EXPECT_GT(compared, 300 / one_case_of);
}

TEST(FeatureMarks, OfMomentsHaveTheirMiddleAndTheirMoments) {
  for_marks(ServoLawKind::moments, [](const auto& marks, const View& view, const auto& seen, const auto&) {
    ASSERT_EQ(marks.size(), 2);
    Eigen::Matrix2Xd polygon(2, 33);
    for (Eigen::Index k = 0; k < 33; ++k) polygon.col(k) = place_in(view, seen, static_cast<double>(k) / 32);
    const auto moments = curve_moments(polygon).values;
    const Eigen::Vector2d middle = moments.segment<2>(1);
    EXPECT_LT((marks[0].seen.at(0) - middle).norm(), 1e-9);
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    const std::size_t corners = marks[1].seen.size() - 1;
    for (std::size_t k = 0; k < corners; ++k)
      second += (marks[1].seen[k] - middle) * (marks[1].seen[k] - middle).transpose();
    second *= 2.0 / static_cast<double>(corners);
    EXPECT_NEAR(second(0, 0), moments[3], 1e-7 * second.norm());
    EXPECT_NEAR(second(0, 1), moments[4], 1e-7 * second.norm());
    EXPECT_NEAR(second(1, 1), moments[5], 1e-7 * second.norm());
  });
}

TEST(FeatureMarks, HaveRecordedPicturesWhereTheyTrulyShowTheArm) {
  const ArmState state = {{{0.3, 0.1}, {-0.2, 0.4}, {0.1, -0.5}}, {1, 1, 1}};
  for (const ServoLawKind law : {ServoLawKind::points, ServoLawKind::silhouettes}) {
    ServoObservation observed = servo_observation(state, state);
    const Eigen::Index size = law == ServoLawKind::points ? 4 * marked_points : 16 * marked_points;
    observed.desired_offset = Eigen::VectorXd::Constant(size, 2);
    FeatureMarker marker(law, servo_arm(), marked_points);
    for (const auto& picture : marker.of(observed)) {
      EXPECT_FALSE(picture.empty());
      for (const FeatureMark& mark : picture)
        EXPECT_LT((mark.desired[0] - mark.seen[0] - Eigen::Vector2d(2, 2)).norm(), 1e-9);
    }
  }
}

TEST(FeatureMarks, AreNoneOfAShapeAndOfWhatIsNotSeen) {
  const ArmState state = ArmState::straight(3);
  FeatureMarker of_shape(ServoLawKind::shape, servo_arm(), marked_points),
      of_points(ServoLawKind::points, servo_arm(), marked_points);
  ServoObservation observed = servo_observation(state, state);
  EXPECT_TRUE(of_shape.of(observed)[0].empty());
  EXPECT_FALSE(of_points.of(observed)[0].empty());
  observed.estimate.is_found = false;
  EXPECT_TRUE(of_points.of(observed)[0].empty());
}

}  // namespace
}  // namespace flexura
