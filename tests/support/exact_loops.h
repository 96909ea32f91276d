#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flexura/control/limiter.h"
#include "flexura/model/backbone.h"
#include "flexura/servo/servo_law.h"
#include "tests/support/random_cases.h"
#include "tests/support/study_numbers.h"

// The loops of the servo's study without pictures: what a law makes of what it is told exactly.
namespace flexura {

/// Features without what they know of the whole way: derivatives are those where the arm stands.
class WithoutSecants : public ServoFeatures {
 public:
  explicit WithoutSecants(std::unique_ptr<ServoFeatures> features) : features_(std::move(features)) {}
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    return features_->measured(estimate, seen, values);
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return features_->predict(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    return features_->error(seen, desired, estimate, views, result);
  }

 private:
  std::unique_ptr<ServoFeatures> features_;
};

/// A law before an arm that does what it is sent, whose shape is known two frames of 1/30 s late.
struct ExactLoop {
  Arm arm;
  std::array<View, 2> views;
  bool has_secants = true;
  double noise = 0;  ///< Of the axis as measured, px across itself: one number a place for the whole run.

  struct End {
    bool is_done = false;
    double settled = 0;  ///< To 2 % of the length for good, s.
  };

  /// Done when it is 0.2 % of the length off for 1 s, given up after 9 s.
  [[nodiscard]] End go(ServoLawKind kind, const ArmState& start, const ArmState& target,
                       TestRandom& random) const {
    constexpr int steps = 270, late = 2;
    constexpr double near = 0.02, there = 0.002;
    ServoConfig config;
    config.law = kind;
    auto features = servo_features(kind, arm, config.points);
    if (!has_secants) features = std::make_unique<WithoutSecants>(std::move(features));
    ServoLaw law(ArmModel(arm), config, *features);
    CommandLimiter limiter(arm, {.step = config.step, .looks_ahead = false}, start);
    std::deque<ArmState> sent(late + 1, start);
    const TargetShape desired{target, {}};
    const std::vector<double> slips = noises(random);
    End end;
    int settled = -1, below = -1;
    for (int k = 0; k < steps && !end.is_done; ++k) {
      const ServoObservation observed = seen(sent.front(), slips);
      const double off = servo_error(arm, sent.front(), target).rms;
      if (off > near) settled = -1;
      if (off > there) below = -1;
      if (off <= near && settled < 0) settled = k;
      if (off <= there && below < 0) below = k;
      end.is_done = below >= 0 && (k - below) * config.step >= 1;
      const ServoLaw::Output output = law.step({.observed = observed,
                                                .is_fresh = true,
                                                .measured = sent.front(),
                                                .sent = limiter.sent(),
                                                .then = desired,
                                                .desired = desired,
                                                .next = target});
      sent.push_back(limiter.next(output.asked).state);
      sent.pop_front();
    }
    end.settled = settled * config.step;
    return end;
  }

 private:
  static constexpr int places = 120;  // Of an axis.

  [[nodiscard]] std::vector<double> noises(TestRandom& random) const {
    std::vector<double> slips(2 * (places + 1));
    for (double& slip : slips) slip = noise * normal_number(random);
    return slips;
  }
  [[nodiscard]] ServoObservation seen(const ArmState& state, const std::vector<double>& slips) const {
    ServoObservation observed;
    observed.estimate.is_found = true, observed.estimate.shape.state = state;
    const Backbone backbone(arm, state);
    for (std::size_t i = 0; i < 2; ++i) {
      observed.seen[i].view = views[i];
      for (int k = 0; noise > 0 && k <= places; ++k) {
        const double s = backbone.length() * k / places;
        const Pose X_WS = backbone.pose(s);
        const Eigen::Vector2d at = views[i].project(X_WS.position).value(),
                              next = views[i].project(X_WS.position + 1e-4 * X_WS.rotation.col(2)).value();
        const Eigen::Vector2d way = (next - at).normalized(), across(-way.y(), way.x());
        const auto number = i * (places + 1) + static_cast<std::size_t>(k);
        observed.seen[i].points.push_back({at + slips[number] * across, 0.1});
      }
    }
    return observed;
  }
};

/// A row: how many of the study's targets a law reaches, and how soon, with exact axes and with noisy ones.
inline std::string exact_row(ExactLoop loop, ServoLawKind kind, const std::string& name,
                             const std::vector<std::pair<ArmState, ArmState>>& ways, double noise) {
  std::string row = "| " + name + " |";
  for (const double sigma : {0.0, noise}) {
    loop.noise = sigma;
    std::vector<double> settled;
    TestRandom random(1);
    for (const auto& [start, target] : ways) {
      const ExactLoop::End end = loop.go(kind, start, target, random);
      if (end.is_done) settled.push_back(end.settled);
    }
    row += fmt::format(" {}/{} | {:.2f} / {:.2f} / {:.2f} |", settled.size(), ways.size(),
                       quantile(settled, 0.5), quantile(settled, 0.95), quantile(settled, 1));
  }
  return row;
}

}  // namespace flexura
