#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/servo/flow_features.h"
#include "tests/support/observation_keeper.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

double turned_by(double to, double from) { return std::remainder(to - from, 2 * std::numbers::pi); }

// Root mean square errors, rad, in the last observations with carried angles. Angles are compared with the
// truth; turns from picture to picture are by the flow and by the difference of two pictures' angles.
struct FlowErrors {
  double measured = 0, carried = 0, turned = 0, differed = 0;
  double most_measured = 0, most_carried = 0, most_turned = 0;  // Largest of all, rad.
  int unknown = 0;                                              // Turns that the flow did not give.
};

class FlowTrial {
 public:
  explicit FlowTrial(const std::string& sensor) : bench_(file(sensor)), keeper_(bench_) {
    const RigModel model = bench_.nominal();
    (void)servo_in_session(bench_.ports(), model, bench_.config(), keeper_);
    arm_ = bench_.experiment().arm.arm();
  }

  [[nodiscard]] std::size_t count() const { return keeper_.observations.size(); }

  [[nodiscard]] FlowErrors errors(double anchor) {
    constexpr int points = 6;
    FlowFeatures features(arm_, chord_features(arm_, points), anchor, {255, 255});
    std::array<std::vector<double>, 2> before;
    FlowErrors sums;
    double late = 0, all = 0, turns = 0;
    std::array<std::vector<double>, 2> measured_before;
    for (std::size_t n = 0; n < count(); ++n) {
      features.look(keeper_.observations[n]);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto& angles = features.angles()[i];
        const std::vector<double> truth = true_angles(n, i, points);
        for (std::size_t k = 0; k < truth.size(); ++k) {
          const double off = turned_by(angles.measured[k], truth[k]),
                       carried = turned_by(angles.carried[k], truth[k]);
          sums.measured += off * off, ++all;
          sums.most_measured = std::max(sums.most_measured, std::abs(off));
          sums.most_carried = std::max(sums.most_carried, std::abs(carried));
          if (2 * n >= count()) sums.carried += carried * carried, ++late;
          if (before[i].empty()) continue;
          if (!std::isfinite(angles.turns[k])) {
            ++sums.unknown;
            continue;
          }
          const double turn = turned_by(truth[k], before[i][k]),
                       turn_error = turned_by(angles.turns[k], turn);
          sums.turned += turn_error * turn_error, ++turns;
          sums.most_turned = std::max(sums.most_turned, std::abs(turn_error));
          sums.differed += std::pow(turned_by(turned_by(angles.measured[k], measured_before[i][k]), turn), 2);
        }
        before[i] = truth, measured_before[i] = angles.measured;
      }
    }
    const auto root = [](double sum, double number) { return std::sqrt(sum / std::max(number, 1.0)); };
    sums.measured = root(sums.measured, all), sums.carried = root(sums.carried, late);
    sums.turned = root(sums.turned, turns), sums.differed = root(sums.differed, turns);
    return sums;
  }

 private:
  static std::string file(const std::string& sensor) {
    ServoSetup rig;
    rig.sensor = sensor;
    // A slow motion, to have many pictures of a moving arm.
    return servo_file(
        "tolerance = 0.002\nsettle = 1\ncamera_prior = { rotation_std = 0, focal_std = 0 }\n"
        "target = [{ time = 0, bends = [[0.1, 0.0], [0.0, 0.1], [-0.1, 0.0]] },\n"
        "{ time = 3, bends = [[0.8, 0.3], [-0.7, 0.5], [0.6, -0.6]] }]\n",
        rig);
  }
  [[nodiscard]] std::vector<double> true_angles(std::size_t n, std::size_t camera, int points) {
    const View view = bench_.rig().camera(camera).view(keeper_.observations[n].time);
    const ArmState& state = keeper_.truth[n];
    const Backbone backbone(arm_, state);
    std::vector<double> angles;
    Eigen::Vector2d before = Eigen::Vector2d::Zero();
    for (int k = 0; k <= points; ++k) {
      const double s = arc_length_of(arm_, state, material_point(arm_, arm_.length() * k / points));
      const Eigen::Vector2d here = view.project(backbone.pose(s).position).value();
      if (k > 0) angles.push_back(std::atan2(here.y() - before.y(), here.x() - before.x()));
      before = here;
    }
    return angles;
  }

  ServoBench bench_;
  ObservationKeeper keeper_;
  Arm arm_;
};

TEST(FlowMeasure, DriftsWithoutAnAnchorAndStaysBoundedWithOne) {
  for (const char* sensor : {"delay = 0, exposure = 0", "read_noise = 3, delay = 0, exposure = 0",
                             "read_noise = 12, delay = 0, exposure = 0"}) {
    FlowTrial trial(sensor);
    ASSERT_GT(trial.count(), 90U);
    const FlowErrors never = trial.errors(1e9), anchored = trial.errors(0.1), at_once = trial.errors(1e-6);
    std::printf(
        "%s, %zu pictures: measured %.5f rad; carried %.5f without an anchor, %.5f with 0.1 s, %.5f at once; "
        "turns from picture to picture %.5f by flow, %.5f by difference\n",
        sensor, trial.count(), never.measured, never.carried, anchored.carried, at_once.carried, never.turned,
        never.differed);
    // Carried without anchor, errors add up; with an anchor they stay below the bound of (25).
    EXPECT_GT(never.carried, 2 * anchored.carried);
    EXPECT_EQ(anchored.unknown, 0);
    const double left = std::exp(-1 / (30 * 0.1));
    const double bound = left * anchored.most_turned / (1 - left) + anchored.most_measured;
    EXPECT_LT(anchored.most_carried, bound);
    EXPECT_LT(anchored.carried, 0.3 * bound);
    // With a zero anchor time they are the picture's.
    EXPECT_NEAR(at_once.most_carried, at_once.most_measured, 1e-9);
    // Two pictures' angles give a chord's turn better than the flow between them. Carried angles are better
    // in pictures with much more noise than cameras have.
    EXPECT_GT(never.turned, never.differed);
    EXPECT_EQ(anchored.carried < at_once.carried, std::string(sensor).starts_with("read_noise = 12"));
  }
}

// The laws with chords must reach their shape with carried angles as well.
TEST(FlowMeasure, BringsTheArmToAShape) {
  const ArmState desired = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};
  for (const char* law : {"chords", "potential"}) {
    for (const char* measure : {"picture", "flow"}) {
      ServoBench bench(servo_file(
          fmt::format("law = \"{}\"\nmeasure = \"{}\"\ntolerance = 0.005\nsettle = 1\n", law, measure) +
          servo_target));
      const ServoResult result = bench.servo();
      ASSERT_TRUE(result.is_done) << law << ", " << measure << ": " << result.reason;
      const ServoError left = bench.truth(desired);
      std::printf("%s, %s: settled in %.2f s, %.4f %% of the length left\n", law, measure,
                  result.settled.value_or(-1), 100 * left.rms);
      EXPECT_LT(left.rms, 0.006);
      EXPECT_LT(*result.settled, 3);
    }
  }
}

}  // namespace
}  // namespace flexura
