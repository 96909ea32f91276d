#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/control/image_law.h"
#include "flexura/control/jacobian_estimate.h"
#include "flexura/control/shape_features.h"
#include "tests/support/edge_loop.h"
#include "tests/support/servo_loop.h"
#include "tests/support/servo_views.h"

// Loops of features and law, of as many random cases as a test's size allows.
namespace flexura {

inline void expect_random_targets(int cases) {
  FeatureSet both = FeatureSet::of_points(6);
  both.chords = FeatureSet::of_chords(6).chords;
  for (const auto& [name, set] : {std::pair{"points", FeatureSet::of_points(6)},
                                  std::pair{"chords", FeatureSet::of_chords(9)}, std::pair{"both", both}}) {
    ServoShare share;
    for_random_cases(cases, [&](TestRandom& random) {
      ServoLoop loop;
      loop.set = set;
      share.add(servo(loop, random_servo_state(random, loop.arm, 0.3),
                      random_servo_state(random, loop.arm, 1.5), 8));
    });
    share.print(name);
    EXPECT_EQ(share.converged, share.all) << name;
  }
}

/// Edges of the images alone bring the arm wherever points bring it.
inline void expect_silhouettes_reach_what_points_reach(int cases) {
  ServoShare edges, points;
  for_random_cases(cases, [&](TestRandom& random) {
    ServoLoop loop;
    loop.set = FeatureSet::of_points(6);
    const ArmState start = random_servo_state(random, loop.arm, 0.3),
                   target = random_servo_state(random, loop.arm, 1.5);
    points.add(servo(loop, start, target, 8));
    edges.add(servo_by_edges(loop, start, target, 8));
  });
  points.print("points");
  edges.print("silhouettes");
  EXPECT_GE(edges.converged, points.converged);
}

/// Targets near by, of which `least` of all are reached.
inline void expect_moments_alone(int cases, double least) {
  ServoShare share;
  for_random_cases(cases, [&](TestRandom& random) {
    ServoLoop loop;
    loop.set = FeatureSet::of_moments();
    const ArmState target = random_servo_state(random, loop.arm, 1.2);
    ArmState start = target;
    for (Eigen::Vector2d& bend : start.bends) bend += random.vector<2>(-0.15, 0.15);
    share.add(servo(loop, start, target, 5));
  });
  share.print("moments");
  EXPECT_GE(share.converged, least * share.all);
}

/// Targets that the same cameras recorded, which are believed to stand elsewhere.
inline void expect_targets_of_wrong_cameras(int cases) {
  ServoShare share;
  for_random_cases(cases, [&](TestRandom& random) {
    ServoLoop loop;
    loop.set = FeatureSet::of_points(6);
    loop.model = wrong_views(random, loop.truth, 0.5 * degree, 0.01);
    share.add(
        servo(loop, random_servo_state(random, loop.arm, 0.3), random_servo_state(random, loop.arm, 1.5), 8));
  });
  share.print("cameras 0.5 degrees and 1 % wrong");
  EXPECT_EQ(share.converged, share.all);
}

/// An arm whose tendons are mounted turned by 100 degrees, and whose sections bend by 1.3 of what they are
/// told.
inline ArmState turned_state(const ArmState& sent) {
  ArmState state = sent;
  const double c = std::cos(1.75), s = std::sin(1.75);
  for (Eigen::Vector2d& bend : state.bends)
    bend = 1.3 * Eigen::Vector2d(c * bend.x() - s * bend.y(), s * bend.x() + c * bend.y());
  return state;
}

/// Learned Jacobians of it; `least` of the recursive ones arrive, all of Broyden's, and none by the model's.
inline void expect_turned_arm_is_learned(int cases, double least) {
  ServoShare model{1e-3}, broyden{1e-3}, recursive{1e-3};
  for_random_cases(cases, [&](TestRandom& random) {
    ServoLoop loop;
    loop.set = FeatureSet::of_points(6);
    loop.mechanism = turned_state;
    loop.rate = 3, loop.most_step = 0.1;
    const ArmState start = random_servo_state(random, loop.arm, 0.2),
                   target = random_servo_state(random, loop.arm, 0.8);
    const ImageLaw law(loop.arm, {});
    const Eigen::MatrixXd J =
        law.by_variables(shape_features(loop.arm, start, loop.model, loop.set).value().by_state);
    model.add(servo(loop, start, target, 20));
    broyden.add(servo(loop, start, target, 20, BroydenEstimate(J)));
    recursive.add(servo(loop, start, target, 20, RecursiveEstimate(J, 0.97)));
  });
  model.print("the model's Jacobian");
  broyden.print("Broyden");
  recursive.print("recursive least squares");
  EXPECT_EQ(model.converged, 0);
  EXPECT_EQ(broyden.converged, broyden.all);
  EXPECT_GE(recursive.converged, least * recursive.all);
}

}  // namespace flexura
