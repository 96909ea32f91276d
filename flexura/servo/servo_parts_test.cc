#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/servo/drive_response.h"
#include "flexura/servo/measured_places.h"
#include "flexura/servo/motion_history.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_judge.h"
#include "flexura/servo/view_keeper.h"
#include "flexura/vision/curve_flow.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

TEST(MotionHistory, IsStraightBetweenReadings) {
  const auto blend = [](double a, double b, double share) { return a + share * (b - a); };
  MotionHistory<double, decltype(blend)> history(1.0, blend);
  EXPECT_FALSE(history.at(0));
  history.add(0, 1);
  EXPECT_EQ(history.at(-5), 1);
  EXPECT_EQ(history.at(5), 1);
  history.add(0.5, 2);
  history.add(0.5, 100);  // Not newer: skipped.
  EXPECT_DOUBLE_EQ(*history.at(0.25), 1.5);
  EXPECT_EQ(history.at(7), 2);
  for (int i = 1; i <= 100; ++i) history.add(0.5 + i, 2 + i);
  EXPECT_DOUBLE_EQ(*history.at(100), 101.5);
  EXPECT_GE(*history.at(0), 99);  // Dropped, except one.
}

// Near a target, the law's derivatives must equal those of the measured features.
TEST(ServoFeatures, AreWhatTheirDerivativesSay) {
  for (const ServoLawKind law : {ServoLawKind::shape, ServoLawKind::points, ServoLawKind::chords,
                                 ServoLawKind::moments, ServoLawKind::potential, ServoLawKind::silhouettes}) {
    for_random_cases(20, [&](TestRandom& random) {
      const Arm arm = servo_arm();
      const std::array<View, 2> views = servo_views();
      const auto features = servo_features(law, arm, 8);
      const ArmState state = random_servo_state(random, arm, 0.6);
      Eigen::VectorXd desired, seen;
      FeatureError at, off;
      ASSERT_TRUE(features->predict(state, views, desired));
      ASSERT_TRUE(features->error(desired, desired, state, views, at));
      EXPECT_NEAR(at.error.norm(), 0, 1e-12);
      for (std::size_t i = 0; i < state.bends.size(); ++i) {
        for (Eigen::Index axis = 0; axis < 2; ++axis) {
          constexpr double step = 1e-4;
          ArmState moved = state;
          moved.bends[i][axis] += step;
          ASSERT_TRUE(features->predict(moved, views, seen));
          ASSERT_TRUE(features->error(seen, desired, state, views, off));
          const Eigen::VectorXd by = off.error / step;
          const Eigen::VectorXd column = at.by_state.col(3 * static_cast<Eigen::Index>(i) + axis);
          // The plane angles are a parallel reading: derivatives are close, and never of the opposite sign.
          const bool is_parallel = law == ServoLawKind::potential;
          EXPECT_LT((by - column).norm(), (is_parallel ? 0.35 : 2e-3) * column.norm() + 1e-6);
          EXPECT_GT(by.dot(column), 0.8 * by.norm() * column.norm());
        }
      }
    });
  }
}

// Every point must be where the line across the arm meets the nearest of all pieces of the centerline.
TEST(MeasuredPixels, MissNoPieceOfTheAxis) {
  int met = 0;
  for_random_cases(100, [&](TestRandom& random) {
    const Arm arm = servo_arm();
    const View view = servo_views()[1];
    const ArmState state = random_servo_state(random, arm, 1.5);
    const Backbone backbone(arm, state);
    Observation seen{.view = view, .points = {}, .ends = {}, .markers = {}};
    const int count = random.integer(2, 300);
    const Eigen::Vector2d aside = random.vector<2>(-12, 12);
    for (int k = 0; k <= count; ++k)
      seen.points.push_back(
          {*view.project(backbone.pose(backbone.length() * k / count).position) + aside, 0.1});
    const std::vector<double> shares = {0.3, 0.5, 0.77};
    const Eigen::Matrix2Xd moved = measured_pixels(arm, state, seen, shares).value(),
                           own = measured_pixels(arm, state, {view, {}, {}, {}}, shares).value();
    for (Eigen::Index i = 0; i < moved.cols(); ++i) {
      const double s = shares[static_cast<std::size_t>(i)] * backbone.length();
      const Pose X_WS = backbone.pose(s);
      // Without a measured centerline, points must be on the shape's own image.
      EXPECT_LT((own.col(i) - *view.project(X_WS.position)).norm(), 1e-9);
      const Eigen::Vector2d ahead =
          *view.project(X_WS.position + 1e-4 * backbone.length() * X_WS.rotation.col(2)) - own.col(i);
      const Eigen::Vector2d across = Eigen::Vector2d(-ahead.y(), ahead.x()).normalized();
      double nearest = 20;
      for (std::size_t k = 1; k < seen.points.size(); ++k) {
        const Eigen::Vector2d a = seen.points[k - 1].pixel - own.col(i),
                              b = seen.points[k].pixel - own.col(i);
        const double from = a.dot(ahead), to = b.dot(ahead);
        if ((from < 0) == (to < 0) || (b - a).norm() > 20) continue;
        const double offset = across.dot(a + from / (from - to) * (b - a));
        if (std::abs(offset) < std::abs(nearest)) nearest = offset;
      }
      if (nearest == 20) continue;
      ++met;
      EXPECT_LE((moved.col(i) - own.col(i) - nearest * across).norm(), 1e-6);
    }
  });
  EXPECT_GT(met, 100 / one_case_of);
}

// Errors of angles that are carried by rates and pulled towards measured ones must have the variance of (25).
// If rates are much more precise than angles, carried angles are better than measured ones, otherwise worse.
TEST(CarriedAngles, HaveTheErrorsOfTheirRatesAndOfTheirAnchor) {
  for (const double rate_sigma : {1e-4, 3e-3}) {
    constexpr double angle_sigma = 1e-3, left = 0.8;
    constexpr int chords = 50, steps = 400;
    double squares = 0, count = 0;
    for_random_cases(10, [&](TestRandom& random) {
      AngleIntegrator integrator(std::vector<double>(chords, 0.0));
      std::vector<double> turns(chords), measured(chords);
      double truth = 0;
      for (int k = 0; k < steps; ++k) {
        const double turn = random.uniform(-0.2, 0.2);
        truth += turn;
        for (double& one : turns) one = turn + rate_sigma * normal_number(random);
        for (double& one : measured) one = truth + angle_sigma * normal_number(random);
        integrator.add(turns);
        (void)integrator.anchor(measured, 1 - left);
        if (k < steps / 4) continue;
        for (const double angle : integrator.angles())
          squares += std::pow(std::remainder(angle - truth, 2 * std::numbers::pi), 2), ++count;
      }
    });
    const double expected = std::sqrt(
        (left * left * rate_sigma * rate_sigma + (1 - left) * (1 - left) * angle_sigma * angle_sigma) /
        (1 - left * left));
    EXPECT_NEAR(std::sqrt(squares / count), expected, 0.03 * expected);
    EXPECT_EQ(expected < angle_sigma, rate_sigma < angle_sigma);
  }
}

// Random ways of an arm that does not follow its model, observed with a picture's noise.
TEST(DriveResponse, LearnsWhatTheArmMakesOfItsDrives) {
  for (const ServoJacobian how : {ServoJacobian::broyden, ServoJacobian::recursive}) {
    for_random_cases(20, [&](TestRandom& random) {
      constexpr Eigen::Index n = 6;
      Eigen::MatrixXd truth = Eigen::MatrixXd::Identity(n, n);
      for (double& entry : truth.reshaped()) entry += random.uniform(-0.5, 0.5);
      DriveResponse response(how, n);
      EXPECT_EQ(response.matrix(), Eigen::MatrixXd::Identity(n, n));
      Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
      const auto seen = [&] {
        Eigen::VectorXd y = truth * x;
        for (double& value : y) value += random.uniform(-1, 1) * 1e-3;
        return y;
      };
      for (int k = 0; k < 150; ++k) {
        for (double& value : x) value += random.uniform(-0.05, 0.05);
        response.learn(x, seen());
      }
      EXPECT_LT((response.matrix() - truth).norm(), 0.1 * truth.norm());
      // An arm at rest and values that are not finite teach nothing.
      const Eigen::MatrixXd before = response.matrix();
      for (int k = 0; k < 200; ++k) response.learn(x, seen());
      response.learn(Eigen::VectorXd::Constant(n, std::nan("")), x);
      EXPECT_EQ(response.matrix(), before);
      // A false shape must change little: no more than one rad per rad of the way.
      response.learn(x + Eigen::VectorXd::Constant(n, 0.02), x + Eigen::VectorXd::Constant(n, 3));
      EXPECT_LE((response.matrix() - before).norm(), 1.0);
    });
  }
}

// A motion that follows the target is commanded to the drives by the inverse of their response.
TEST(DriveResponse, TellsTheDrivesPartOfAWay) {
  DriveResponse response(ServoJacobian::recursive, 2), model(ServoJacobian::model, 2);
  Eigen::Matrix2d truth;
  truth << 0.3, -1.2, 1.1, 0.2;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector2d x(std::cos(0.5 * k), std::sin(0.7 * k));
    response.learn(x, truth * x);
    model.learn(x, truth * x);
  }
  const Eigen::Vector2d way(0.1, 0.2);
  EXPECT_LT((truth * response.drives_for(way) - way).norm(), 1e-3);
  EXPECT_EQ(model.drives_for(way), way);
  EXPECT_EQ(model.matrix(), Eigen::Matrix2d::Identity());
}

ServoStep step_at(double time, double rms) {
  ServoStep step;
  step.time = time, step.seen_at = time, step.is_fresh = true;
  step.error = ServoError{rms, rms, rms};
  return step;
}

TEST(ServoJudge, KnowsTheEnd) {
  ServoConfig config;
  config.tolerance = 0.01, config.settle = 0.5, config.timeout = 3;
  {
    // An imprecise observation, or one with commands pending to another shape, does not count as arrival.
    ServoJudge uncertain(config, 0, 0), leaving(config, 0, 0);
    for (int k = 0; k < 60; ++k) {
      ServoStep step = step_at(k / 30.0, 0.001);
      step.sigma = 0.05;
      uncertain.add(step);
      step.sigma = 0, step.ahead = ServoError{0.1, 0.1, 0.1};
      leaving.add(step);
    }
    EXPECT_FALSE(uncertain.is_done());
    EXPECT_FALSE(leaving.is_done());
  }
  {
    ServoJudge judge(config, 10, 1);
    int k = 0;
    for (; k < 90 && !judge.is_done(); ++k) judge.add(step_at(10 + k / 30.0, 0.001));
    // Errors before the target's time do not count.
    EXPECT_NEAR(k / 30.0, 1.5, 0.07);
  }
  {
    ServoJudge judge(config, 0, 0);
    int k = 0;
    for (; k < 300 && !judge.failure(); ++k) judge.add(step_at(k / 30.0, 0.02));
    ASSERT_TRUE(judge.failure());
    EXPECT_TRUE(judge.failure()->starts_with("not settled")) << *judge.failure();
    EXPECT_NEAR(k / 30.0, 3, 0.1);
  }
  {
    ServoJudge judge(config, 0, 0);
    for (int k = 0; k < 300 && !judge.failure(); ++k) judge.add(step_at(k / 30.0, 0.02 + 0.1 * k / 30.0));
    ASSERT_TRUE(judge.failure());
    EXPECT_TRUE(judge.failure()->starts_with("diverging")) << *judge.failure();
    EXPECT_EQ(judge.failure()->find("limited by"), std::string::npos) << *judge.failure();
  }
  {
    ServoJudge judge(config, 0, 0);
    for (int k = 0; k < 300 && !judge.failure(); ++k) {
      ServoStep step = step_at(k / 30.0, 0.02 + 0.1 * k / 30.0);
      step.limited = "motor A: acceleration";
      judge.add(step);
    }
    ASSERT_TRUE(judge.failure());
    EXPECT_TRUE(judge.failure()->starts_with("diverging")) << *judge.failure();
    EXPECT_TRUE(judge.failure()->ends_with("; limited by motor A: acceleration")) << *judge.failure();
  }
  {
    ServoJudge judge(config, 0, 0);
    ServoStep step;
    for (int k = 0; k < 300 && !judge.failure(); ++k) {
      step = step_at(k / 30.0, 0.02), step.is_singular = true;
      judge.add(step);
    }
    EXPECT_TRUE(judge.failure()->starts_with("singular")) << *judge.failure();
  }
}

}  // namespace
}  // namespace flexura
