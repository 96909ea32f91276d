#include "flexura/control/image_law.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/control/jacobian_estimate.h"
#include "flexura/control/limiter.h"
#include "flexura/control/shape_features.h"
#include "flexura/model/backbone.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

constexpr double dt = 1.0 / 30;

// The largest distance between two shapes' points, share of the length.
double shape_error(const Arm& arm, const ArmState& a, const ArmState& b) {
  const Backbone one(arm, a), other(arm, b);
  double most = 0;
  for (int i = 0; i <= 30; ++i)
    most = std::max(
        most,
        (one.pose(one.length() * i / 30).position - other.pose(other.length() * i / 30).position).norm());
  return most / arm.length();
}

// A loop without pictures: features of the true arm by the true cameras, the law's Jacobian by the cameras as
// they are believed to be; the limiter in between.
struct Loop {
  Arm arm = servo_arm();
  std::array<View, 2> truth = servo_views(), model = servo_views();
  FeatureSet set;
  /// What the arm makes of the bends that it is sent to.
  std::function<ArmState(const ArmState&)> mechanism = [](const ArmState& sent) { return sent; };
  double rate = 4;
  double most_step = 0.3;
};
struct Ended {
  double error = 1;    // share of the length
  double settled = 0;  // s, when the error fell below 2 % for good
  bool is_lost = false;
};

using Estimate = std::variant<std::monostate, BroydenEstimate, RecursiveEstimate>;

Eigen::MatrixXd learned(Estimate& estimate, const Eigen::VectorXd& dx, const Eigen::VectorXd& df) {
  if (auto* broyden = std::get_if<BroydenEstimate>(&estimate)) {
    broyden->learn(dx, df);
    return broyden->J();
  }
  auto& recursive = std::get<RecursiveEstimate>(estimate);
  recursive.learn(dx, df);
  return recursive.J();
}

Ended run(const Loop& loop, const ArmState& start, const ArmState& target, double seconds,
          Estimate estimate = {}) {
  Ended ended;
  const ImageLaw law(loop.arm, {.rate = loop.rate, .damping = 0.002, .most_step = loop.most_step});
  CommandLimiter limiter(loop.arm, {.step = dt, .looks_ahead = false}, start);
  const ArmState wanted = loop.mechanism(target);
  const auto desired = shape_features(loop.arm, wanted, loop.truth, loop.set);
  if (!desired) return ended.is_lost = true, ended;
  std::optional<Eigen::VectorXd> x_before, f_before;
  // What is learned starts with a nudge of each variable.
  const int nudges =
      std::holds_alternative<std::monostate>(estimate) ? 0 : static_cast<int>(law.variables().size());
  for (int k = 0; k < static_cast<int>(seconds / dt); ++k) {
    const ArmState now = loop.mechanism(limiter.sent());
    const double off = shape_error(loop.arm, now, wanted);
    if (off > 0.02) ended.settled = k * dt;
    const auto seen = shape_features(loop.arm, now, loop.truth, loop.set);
    if (!seen) return ended.is_lost = true, ended;
    Eigen::MatrixXd J;
    const Eigen::VectorXd x = law.variables().pack(limiter.sent());
    if (std::holds_alternative<std::monostate>(estimate)) {
      const auto believed = shape_features(loop.arm, limiter.sent(), loop.model, loop.set);
      if (!believed) return ended.is_lost = true, ended;
      J = law.by_variables(believed->by_state);
    } else {
      const Eigen::VectorXd dx = x_before ? Eigen::VectorXd(x - *x_before) : Eigen::VectorXd::Zero(x.size()),
                            df = f_before ? feature_error(loop.set, seen->values, *f_before)
                                          : Eigen::VectorXd::Zero(seen->values.size());
      J = learned(estimate, dx, df);
    }
    x_before = x, f_before = seen->values;
    const Eigen::VectorXd error = feature_error(loop.set, seen->values, desired->values);
    ArmState asked = law.step(limiter.sent(), error, J, dt).asked;
    if (k < nudges) asked = law.variables().state(x + 0.03 * Eigen::VectorXd::Unit(x.size(), k));
    (void)limiter.next(asked);
  }
  ended.error = shape_error(loop.arm, loop.mechanism(limiter.sent()), wanted);
  return ended;
}

struct Share {
  double enough = 1e-5;  // share of the length
  int converged = 0, all = 0;
  double worst = 0, latest = 0;
  void add(const Ended& ended) {
    ++all;
    if (ended.is_lost || ended.error > enough) {
      if (ended.is_lost || enough < 1e-4)
        std::printf("case %d: %s, off by %.1e\n", all, ended.is_lost ? "out of view" : "not there",
                    ended.error);
      return;
    }
    ++converged;
    worst = std::max(worst, ended.error), latest = std::max(latest, ended.settled);
  }
  void print(const char* what) const {
    std::printf("%s: %d of %d converged, settled within %.2f s, worst of them off by %.1e of the length\n",
                what, converged, all, latest, worst);
  }
};

TEST(ImageLaw, BringsTheArmToRandomTargets) {
  FeatureSet both = FeatureSet::of_points(6);
  both.chords = FeatureSet::of_chords(6).chords;
  for (const auto& [name, set] : {std::pair{"points", FeatureSet::of_points(6)},
                                  std::pair{"chords", FeatureSet::of_chords(9)}, std::pair{"both", both}}) {
    Share share;
    for_random_cases(200, [&](TestRandom& random) {
      Loop loop;
      loop.set = set;
      share.add(
          run(loop, random_servo_state(random, loop.arm, 0.3), random_servo_state(random, loop.arm, 1.5), 8));
    });
    share.print(name);
    EXPECT_EQ(share.converged, share.all) << name;
  }
}

TEST(ImageLaw, BringsTheArmToTargetsNearByWithMomentsAlone) {
  Share share;
  for_random_cases(100, [&](TestRandom& random) {
    Loop loop;
    loop.set = FeatureSet::of_moments();
    const ArmState target = random_servo_state(random, loop.arm, 1.2);
    ArmState start = target;
    for (Eigen::Vector2d& bend : start.bends) bend += random.vector<2>(-0.15, 0.15);
    share.add(run(loop, start, target, 5));
  });
  share.print("moments");
  EXPECT_GE(share.converged, 0.95 * share.all);
}

TEST(ImageLaw, ReachesWhatTheSameCamerasRecordedHoweverWrongTheyAreBelievedToBe) {
  Share share;
  for_random_cases(200, [&](TestRandom& random) {
    Loop loop;
    loop.set = FeatureSet::of_points(6);
    loop.model = wrong_views(random, loop.truth, 0.5 * std::numbers::pi / 180, 0.01);
    share.add(
        run(loop, random_servo_state(random, loop.arm, 0.3), random_servo_state(random, loop.arm, 1.5), 8));
  });
  share.print("cameras 0.5 degrees and 1 % wrong");
  EXPECT_EQ(share.converged, share.all);
}

// An arm whose tendons are mounted turned by 100 degrees, and whose sections bend by 1.3 of what they are
// told.
ArmState turned(const ArmState& sent) {
  ArmState state = sent;
  const double c = std::cos(1.75), s = std::sin(1.75);
  for (Eigen::Vector2d& bend : state.bends)
    bend = 1.3 * Eigen::Vector2d(c * bend.x() - s * bend.y(), s * bend.x() + c * bend.y());
  return state;
}

TEST(ImageLaw, LearnsAnArmOfWhichItIsTaughtWrong) {
  Share model{1e-3}, broyden{1e-3}, recursive{1e-3};
  for_random_cases(40, [&](TestRandom& random) {
    Loop loop;
    loop.set = FeatureSet::of_points(6);
    loop.mechanism = turned;
    loop.rate = 3, loop.most_step = 0.1;
    const ArmState start = random_servo_state(random, loop.arm, 0.2),
                   target = random_servo_state(random, loop.arm, 0.8);
    const ImageLaw law(loop.arm, {});
    const Eigen::MatrixXd J =
        law.by_variables(shape_features(loop.arm, start, loop.model, loop.set).value().by_state);
    model.add(run(loop, start, target, 20));
    broyden.add(run(loop, start, target, 20, BroydenEstimate(J)));
    recursive.add(run(loop, start, target, 20, RecursiveEstimate(J, 0.97)));
  });
  model.print("the model's Jacobian");
  broyden.print("Broyden");
  recursive.print("recursive least squares");
  EXPECT_EQ(model.converged, 0);
  EXPECT_EQ(broyden.converged, broyden.all);
  EXPECT_EQ(recursive.converged, recursive.all);
}

TEST(ImageLaw, FallsExponentiallyWhereTheModelIsRight) {
  Loop loop;
  loop.set = FeatureSet::of_points(6);
  const ImageLaw law(loop.arm, {.rate = 3, .damping = 0});
  ArmState state = {{{0.3, 0.2}, {0.1, -0.2}, {0.2, 0.4}}, {1, 1, 1}};
  const ArmState target = {{{0.31, 0.21}, {0.09, -0.19}, {0.2, 0.41}}, {1, 1, 1}};
  const Eigen::VectorXd desired = shape_features(loop.arm, target, loop.model, loop.set).value().values;
  double before = 0;
  for (int k = 0; k < 10; ++k) {
    const auto seen = shape_features(loop.arm, state, loop.model, loop.set).value();
    const Eigen::VectorXd error = feature_error(loop.set, seen.values, desired);
    if (k > 0) {
      EXPECT_NEAR(error.norm() / before, std::exp(-3 * dt), 2e-3);
    }
    before = error.norm();
    const ImageStep step = law.step(state, error, law.by_variables(seen.by_state), dt);
    EXPECT_FALSE(step.is_singular);
    state = step.asked;
  }
}

TEST(ImageLaw, TellsWhatItCannotSee) {
  // One camera that sees a straight arm end on: nothing of its stretch.
  Arm arm = servo_arm();
  for (Section& section : arm.sections) section.stretch_limits = {0.9, 1.1};
  const ImageLaw law(arm, {});
  EXPECT_EQ(law.variables().size(), 9);
  View above = servo_views()[0];
  above.X_WC.position = {0, 3, 0};
  above.X_WC.rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const ArmState straight = ArmState::straight(3);
  const auto seen = shape_features(arm, straight, std::array{above}, FeatureSet::of_points(6)).value();
  const ImageStep step = law.step(straight, Eigen::VectorXd::Ones(12), law.by_variables(seen.by_state), dt);
  EXPECT_TRUE(step.is_singular);
  EXPECT_TRUE(step.asked.bends[0].allFinite());
  // What is no number goes on to the limiter as it is.
  const ImageStep lost =
      law.step(straight, Eigen::VectorXd::Constant(12, std::nan("")), law.by_variables(seen.by_state), dt);
  EXPECT_FALSE(lost.asked.bends[0].allFinite());
  CommandLimiter limiter(arm, {.looks_ahead = false}, straight);
  EXPECT_TRUE(limiter.next(lost.asked).is_at_rest);
  EXPECT_TRUE(limiter.fault().has_value());
  EXPECT_THROW((void)law.step(straight, Eigen::VectorXd::Ones(11), law.by_variables(seen.by_state), dt),
               std::invalid_argument);
  EXPECT_THROW(ImageLaw(arm, {.rate = 0}), std::invalid_argument);
}

TEST(ShapeLaw, MakesUpForWhatTheArmDoesWrong) {
  // The arm bends by 0.8 to 1.2 of what it is told and by a little more; it is seen as it is.
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = servo_arm();
    const Eigen::Vector3d gain = random.vector<3>(0.8, 1.2);
    const Eigen::Vector2d droop = random.vector<2>(-0.1, 0.1);
    const auto mechanism = [&](ArmState state) {
      for (std::size_t i = 0; i < 3; ++i)
        state.bends[i] = gain[static_cast<Eigen::Index>(i)] * state.bends[i] + droop;
      return state;
    };
    const ArmState desired = random_servo_state(random, arm, 1.2);
    CommandLimiter limiter(arm, {.step = dt, .looks_ahead = false}, ArmState::straight(3));
    for (int k = 0; k < 150; ++k)
      (void)limiter.next(shape_step(limiter.sent(), mechanism(limiter.sent()), desired, 4, dt));
    EXPECT_LE(shape_error(arm, mechanism(limiter.sent()), desired), 1e-6);
  });
  EXPECT_THROW((void)shape_step(ArmState::straight(3), ArmState::straight(2), ArmState::straight(3), 1, dt),
               std::invalid_argument);
}

TEST(JacobianEstimates, FindALinearMapAfterAsManyMotionsAsItHasColumns) {
  for_random_cases(40, [](TestRandom& random) {
    const Eigen::Index n = random.integer(2, 6), m = random.integer(2, 12);
    const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
      Eigen::MatrixXd A(rows, columns);
      for (double& entry : A.reshaped()) entry = random.uniform(-1, 1);
      return A;
    };
    const Eigen::MatrixXd truth = any(m, n);
    BroydenEstimate broyden(any(m, n));
    RecursiveEstimate recursive(any(m, n), 1, 1e8);
    for (Eigen::Index k = 0; k < n; ++k) {
      // Broyden's forgets nothing of motions at right angles to the newest.
      const Eigen::VectorXd dx = 0.3 * Eigen::VectorXd::Unit(n, k), other = any(n, 1);
      EXPECT_TRUE(broyden.learn(dx, truth * dx));
      EXPECT_LE((broyden.J() * dx - truth * dx).norm(), 1e-12);
      EXPECT_TRUE(recursive.learn(other, truth * other));
    }
    EXPECT_LE((broyden.J() - truth).norm(), 1e-12);
    for (int k = 0; k < 20; ++k) {
      const Eigen::VectorXd other = any(n, 1);
      recursive.learn(other, truth * other);
    }
    EXPECT_LE((recursive.J() - truth).norm(), 1e-5);
    const Eigen::MatrixXd before = broyden.J();
    EXPECT_FALSE(broyden.learn(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Ones(m)));
    EXPECT_FALSE(recursive.learn(Eigen::VectorXd::Ones(n), Eigen::VectorXd::Constant(m, std::nan(""))));
    EXPECT_EQ(broyden.J(), before);
    EXPECT_THROW(broyden.learn(Eigen::VectorXd::Ones(n + 1), Eigen::VectorXd::Ones(m)),
                 std::invalid_argument);
  });
  EXPECT_THROW(BroydenEstimate(Eigen::MatrixXd::Identity(2, 2), 0), std::invalid_argument);
  EXPECT_THROW(RecursiveEstimate(Eigen::MatrixXd::Identity(2, 2), 1.1), std::invalid_argument);
}

TEST(JacobianEstimates, FollowAMapThatChanges) {
  TestRandom random(3);
  RecursiveEstimate recursive(Eigen::MatrixXd::Zero(2, 2), 0.8);
  Eigen::Matrix2d truth = Eigen::Matrix2d::Identity();
  for (int k = 0; k < 400; ++k) {
    if (k == 200) truth << 0, 2, -1, 0;
    // It stands for a while: what it knows must not blow up.
    if (k > 50 && k < 150) recursive.learn(Eigen::Vector2d(1e-5, 0), truth * Eigen::Vector2d(1e-5, 0));
    const Eigen::Vector2d dx = random.vector<2>(-0.1, 0.1);
    recursive.learn(dx, truth * dx);
    if (k == 199 || k == 399) {
      EXPECT_LE((recursive.J() - truth).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace flexura
