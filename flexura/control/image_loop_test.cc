// Loops without pictures: features of the true arm by the true cameras, the law's Jacobian by the nominal
// cameras, with the limiter.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include "flexura/base/degree.h"
#include "flexura/control/contour_images.h"
#include "flexura/control/feature_images.h"
#include "flexura/control/image_law.h"
#include "flexura/control/jacobian_estimate.h"
#include "flexura/control/limiter.h"
#include "flexura/model/backbone.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

constexpr double servo_step = 1.0 / 30;  // In s.

// Returns the largest distance between two shapes' points, share of the length.
double shape_error(const Arm& arm, const ArmState& a, const ArmState& b) {
  const Backbone one(arm, a), other(arm, b);
  double most = 0;
  for (int i = 0; i <= 30; ++i)
    most = std::max(
        most,
        (one.pose(one.length() * i / 30).position - other.pose(other.length() * i / 30).position).norm());
  return most / arm.length();
}

struct ServoLoop {
  Arm arm = servo_arm();
  std::array<View, 2> truth = servo_views(), model = servo_views();
  FeatureSet set = FeatureSet::of_points(6);
  // True shape for commanded bends.
  std::function<ArmState(const ArmState&)> mechanism = [](const ArmState& sent) { return sent; };
  double rate = 4;
  double most_step = 0.3;

  [[nodiscard]] ImageLaw law() const {
    return {arm, {.rate = rate, .damping = 0.002, .most_step = most_step}};
  }
};
// Result of a run.
struct ServoEnd {
  double error = 1;    // Share of the length.
  double settled = 0;  // Time from which the error stays below 2 %, s.
  bool is_lost = false;
};

// Runs from `start` towards `target` for this number of seconds. asked(k, state, sent) returns the law's
// command in step k; std::nullopt if a lens does not show a point.
template <class Asked>
ServoEnd run_loop(const ServoLoop& loop, const ArmState& start, const ArmState& target, double seconds,
                  const Asked& asked) {
  ServoEnd ended;
  CommandLimiter limiter(loop.arm, {.step = servo_step, .looks_ahead = false}, start);
  const ArmState desired = loop.mechanism(target);
  for (int k = 0; k < static_cast<int>(seconds / servo_step); ++k) {
    const ArmState now = loop.mechanism(limiter.sent());
    if (shape_error(loop.arm, now, desired) > 0.02) ended.settled = k * servo_step;
    const std::optional<ArmState> requested = asked(k, now, limiter.sent());
    if (!requested) return ended.is_lost = true, ended;
    (void)limiter.next(*requested);
  }
  ended.error = shape_error(loop.arm, loop.mechanism(limiter.sent()), desired);
  return ended;
}

// Estimate of the Jacobian, if any.
using JacobianEstimate = std::variant<std::monostate, BroydenEstimate, RecursiveEstimate>;

Eigen::MatrixXd learned(JacobianEstimate& estimate, const Eigen::VectorXd& dx, const Eigen::VectorXd& df) {
  if (auto* broyden = std::get_if<BroydenEstimate>(&estimate)) {
    broyden->learn(dx, df);
    return broyden->jacobian();
  }
  auto& recursive = std::get<RecursiveEstimate>(estimate);
  recursive.learn(dx, df);
  return recursive.jacobian();
}

ServoEnd servo(const ServoLoop& loop, const ArmState& start, const ArmState& target, double seconds,
               JacobianEstimate estimate = {}) {
  const ImageLaw law = loop.law();
  FeatureImages images(loop.arm, loop.set);
  Eigen::VectorXd desired, seen, nominal;
  if (!images.values(loop.mechanism(target), loop.truth, desired)) return {.is_lost = true};
  std::optional<Eigen::VectorXd> x_before, f_before;
  const bool learns = !std::holds_alternative<std::monostate>(estimate);
  return run_loop(loop, start, target, seconds,
                  [&](int k, const ArmState& now, const ArmState& sent) -> std::optional<ArmState> {
                    if (!images.values(now, loop.truth, seen)) return std::nullopt;
                    Eigen::MatrixXd J, by_state;
                    const Eigen::VectorXd x = law.variables().pack(sent);
                    if (learns) {
                      J = learned(estimate, x - x_before.value_or(x),
                                  feature_error(loop.set, seen, f_before.value_or(seen)));
                    } else {
                      if (!images.derive(sent, loop.model, nominal, by_state)) return std::nullopt;
                      J = law.by_variables(by_state);
                    }
                    x_before = x, f_before = seen;
                    // Learning starts with a small motion of each variable.
                    if (learns && k < x.size())
                      return law.variables().state(x + 0.03 * Eigen::VectorXd::Unit(x.size(), k));
                    return law.step(sent, feature_error(loop.set, seen, desired), J, servo_step).asked;
                  });
}

// Uses the edges of both images, six places along the arm; derivatives and normals are those of the nominal
// cameras.
ServoEnd servo_by_edges(const ServoLoop& loop, const ArmState& start, const ArmState& target,
                        double seconds) {
  const ImageLaw law = loop.law();
  ContourImages contours(loop.arm, {1.0 / 6, 2.0 / 6, 3.0 / 6, 4.0 / 6, 5.0 / 6, 1});
  ContourImage at;
  std::array<Eigen::Matrix2Xd, 2> desired, seen, normals;
  const auto look = [&](const ArmState& state, std::array<Eigen::Matrix2Xd, 2>& pixels) {
    contours.set(state);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!contours.see(loop.truth[i], at)) return false;
      pixels[i] = at.pixels;
      if (&pixels == &desired) normals[i] = at.normals;
    }
    return true;
  };
  if (!look(loop.mechanism(target), desired)) return {.is_lost = true};
  const Eigen::Index rows = contours.count();
  Eigen::VectorXd error(2 * rows);
  Eigen::MatrixXd by_state(2 * rows, contours.columns());
  return run_loop(loop, start, target, seconds,
                  [&](int, const ArmState& now, const ArmState& sent) -> std::optional<ArmState> {
                    if (!look(now, seen)) return std::nullopt;
                    contours.set(sent);
                    for (std::size_t i = 0; i < 2; ++i) {
                      const Eigen::Index first = static_cast<Eigen::Index>(i) * rows;
                      if (!contours.see(loop.model[i], at)) return std::nullopt;
                      contour_error(at, seen[i], desired[i], normals[i], error.segment(first, rows));
                      contours.derive(loop.model[i], at, by_state.middleRows(first, rows));
                    }
                    return law.step(sent, error, law.by_variables(by_state), servo_step).asked;
                  });
}

// Number of runs of a kind that reached their targets.
struct ServoShare {
  double enough = 1e-5;  // Share of the length.
  int converged = 0, all = 0;
  double worst = 0, latest = 0;
  void add(const ServoEnd& ended) {
    ++all;
    if (ended.is_lost || ended.error > enough) return;
    ++converged;
    worst = std::max(worst, ended.error), latest = std::max(latest, ended.settled);
  }
  void print(const char* what) const {
    std::printf("%s: %d of %d converged, settled within %.2f s, worst of them off by %.1e of the length\n",
                what, converged, all, latest, worst);
  }
};

TEST(ImageLoop, BringsTheArmToRandomTargets) {
  FeatureSet both = FeatureSet::of_points(6);
  both.chords = FeatureSet::of_chords(6).chords;
  for (const auto& [name, set] : {std::pair{"points", FeatureSet::of_points(6)},
                                  std::pair{"chords", FeatureSet::of_chords(9)}, std::pair{"both", both}}) {
    ServoShare share;
    for_random_cases(20, [&](TestRandom& random) {
      ServoLoop loop;
      loop.set = set;
      share.add(servo(loop, random_servo_state(random, loop.arm, 0.3),
                      random_servo_state(random, loop.arm, 1.5), 8));
    });
    share.print(name);
    EXPECT_EQ(share.converged, share.all) << name;
  }
}

// Edges alone must bring the arm wherever points do.
TEST(ImageLoop, OfSilhouettesReachesWhatPointsReach) {
  ServoShare edges, points;
  for_random_cases(20, [&](TestRandom& random) {
    const ServoLoop loop;
    const ArmState start = random_servo_state(random, loop.arm, 0.3),
                   target = random_servo_state(random, loop.arm, 1.5);
    points.add(servo(loop, start, target, 8));
    edges.add(servo_by_edges(loop, start, target, 8));
  });
  points.print("points");
  edges.print("silhouettes");
  EXPECT_GE(edges.converged, points.converged);
}

TEST(ImageLoop, BringsTheArmToTargetsNearByWithMomentsAlone) {
  ServoShare share;
  for_random_cases(10, [&](TestRandom& random) {
    ServoLoop loop;
    loop.set = FeatureSet::of_moments();
    const ArmState target = random_servo_state(random, loop.arm, 1.2);
    ArmState start = target;
    for (Eigen::Vector2d& bend : start.bends) bend += random.vector<2>(-0.15, 0.15);
    share.add(servo(loop, start, target, 5));
  });
  share.print("moments");
  EXPECT_GE(share.converged, 0.8 * share.all);
}

// For targets recorded by the same cameras.
TEST(ImageLoop, ReachesItsTargetsHoweverWrongTheCamerasAreBelievedToBe) {
  ServoShare share;
  for_random_cases(20, [&](TestRandom& random) {
    ServoLoop loop;
    loop.model = wrong_views(random, loop.truth, 0.5 * degree, 0.01);
    share.add(
        servo(loop, random_servo_state(random, loop.arm, 0.3), random_servo_state(random, loop.arm, 1.5), 8));
  });
  share.print("cameras 0.5 degrees and 1 % wrong");
  EXPECT_EQ(share.converged, share.all);
}

// Returns the shape of an arm whose tendons are mounted turned by 100 degrees, with sections that bend by 1.3
// of the command.
ArmState turned_state(const ArmState& sent) {
  ArmState state = sent;
  const double c = std::cos(1.75), s = std::sin(1.75);
  for (Eigen::Vector2d& bend : state.bends)
    bend = 1.3 * Eigen::Vector2d(c * bend.x() - s * bend.y(), s * bend.x() + c * bend.y());
  return state;
}

TEST(ImageLoop, LearnsAnArmOfWhichItIsTaughtWrong) {
  ServoShare model{1e-3}, broyden{1e-3}, recursive{1e-3};
  for_random_cases(8, [&](TestRandom& random) {
    ServoLoop loop;
    loop.mechanism = turned_state;
    loop.rate = 3, loop.most_step = 0.1;
    const ArmState start = random_servo_state(random, loop.arm, 0.2),
                   target = random_servo_state(random, loop.arm, 0.8);
    Eigen::VectorXd values;
    Eigen::MatrixXd by_state;
    ASSERT_TRUE(FeatureImages(loop.arm, loop.set).derive(start, loop.model, values, by_state));
    const Eigen::MatrixXd J = loop.law().by_variables(by_state);
    model.add(servo(loop, start, target, 20));
    broyden.add(servo(loop, start, target, 20, BroydenEstimate(J)));
    recursive.add(servo(loop, start, target, 20, RecursiveEstimate(J, 0.97)));
  });
  model.print("the model's Jacobian");
  broyden.print("Broyden");
  recursive.print("recursive least squares");
  EXPECT_EQ(model.converged, 0);
  EXPECT_EQ(broyden.converged, broyden.all);
  EXPECT_GE(recursive.converged, 0.95 * recursive.all);
}

}  // namespace
}  // namespace flexura
