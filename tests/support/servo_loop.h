#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <variant>

#include "flexura/control/image_law.h"
#include "flexura/control/jacobian_estimate.h"
#include "flexura/control/limiter.h"
#include "flexura/control/shape_features.h"
#include "flexura/model/backbone.h"
#include "tests/support/servo_views.h"

namespace flexura {

/// s
inline constexpr double servo_step = 1.0 / 30;

/// The largest distance between two shapes' points, share of the length.
inline double shape_error(const Arm& arm, const ArmState& a, const ArmState& b) {
  const Backbone one(arm, a), other(arm, b);
  double most = 0;
  for (int i = 0; i <= 30; ++i)
    most = std::max(
        most,
        (one.pose(one.length() * i / 30).position - other.pose(other.length() * i / 30).position).norm());
  return most / arm.length();
}

/// A loop without pictures: features of the true arm by the true cameras, the law's Jacobian by the cameras
/// as they are believed to be; the limiter in between.
struct ServoLoop {
  Arm arm = servo_arm();
  std::array<View, 2> truth = servo_views(), model = servo_views();
  FeatureSet set;
  /// What the arm makes of the bends that it is sent to.
  std::function<ArmState(const ArmState&)> mechanism = [](const ArmState& sent) { return sent; };
  double rate = 4;
  double most_step = 0.3;
};
/// How a run ended.
struct ServoEnd {
  double error = 1;    // share of the length
  double settled = 0;  // s, when the error fell below 2 % for good
  bool is_lost = false;
};

/// None, or what learns the Jacobian.
using JacobianEstimate = std::variant<std::monostate, BroydenEstimate, RecursiveEstimate>;

inline Eigen::MatrixXd learned(JacobianEstimate& estimate, const Eigen::VectorXd& dx,
                               const Eigen::VectorXd& df) {
  if (auto* broyden = std::get_if<BroydenEstimate>(&estimate)) {
    broyden->learn(dx, df);
    return broyden->jacobian();
  }
  auto& recursive = std::get<RecursiveEstimate>(estimate);
  recursive.learn(dx, df);
  return recursive.jacobian();
}

/// From `start` towards `target` for so many seconds.
inline ServoEnd servo(const ServoLoop& loop, const ArmState& start, const ArmState& target, double seconds,
                      JacobianEstimate estimate = {}) {
  ServoEnd ended;
  const ImageLaw law(loop.arm, {.rate = loop.rate, .damping = 0.002, .most_step = loop.most_step});
  CommandLimiter limiter(loop.arm, {.step = servo_step, .looks_ahead = false}, start);
  const ArmState wanted = loop.mechanism(target);
  const auto desired = shape_features(loop.arm, wanted, loop.truth, loop.set);
  if (!desired) return ended.is_lost = true, ended;
  std::optional<Eigen::VectorXd> x_before, f_before;
  // What is learned starts with a nudge of each variable.
  const int nudges =
      std::holds_alternative<std::monostate>(estimate) ? 0 : static_cast<int>(law.variables().size());
  for (int k = 0; k < static_cast<int>(seconds / servo_step); ++k) {
    const ArmState now = loop.mechanism(limiter.sent());
    const double off = shape_error(loop.arm, now, wanted);
    if (off > 0.02) ended.settled = k * servo_step;
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
    ArmState asked = law.step(limiter.sent(), error, J, servo_step).asked;
    if (k < nudges) asked = law.variables().state(x + 0.03 * Eigen::VectorXd::Unit(x.size(), k));
    (void)limiter.next(asked);
  }
  ended.error = shape_error(loop.arm, loop.mechanism(limiter.sent()), wanted);
  return ended;
}

/// How many runs of a kind came to their targets.
struct ServoShare {
  double enough = 1e-5;  // share of the length
  int converged = 0, all = 0;
  double worst = 0, latest = 0;
  void add(const ServoEnd& ended) {
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

}  // namespace flexura
