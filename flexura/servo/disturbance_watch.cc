#include "flexura/servo/disturbance_watch.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/model/arm_difference.h"
#include "flexura/safety/motion_check.h"
#include "flexura/servo/servo_error.h"

namespace flexura {
namespace {

// Returns points along the backbone of a shape, one column, m.
Eigen::VectorXd points_of(const Arm& arm, const ArmState& shape) {
  constexpr Eigen::Index count = 24;
  const Backbone backbone(arm, shape);
  Eigen::VectorXd points(3 * count);
  for (Eigen::Index k = 0; k < count; ++k)
    points.segment<3>(3 * k) = backbone.pose(backbone.length() * static_cast<double>(k + 1) / count).position;
  return points;
}

std::string as_if_released(std::size_t tendon) {
  return fmt::format("as if tendon {} were released: it is broken or slack, or its motor lost steps",
                     tendon + 1);
}

// Deviation since the start that an error of the model may cause, as a share of the motion.
constexpr double slow_error = 0.1;

}  // namespace

DisturbanceWatch::DisturbanceWatch(ArmModel model, const DisturbanceConfig& config)
    : model_(std::move(model)), config_(config) {
  if (!(config.limit > 0) || !(config.model_error >= 0) || !(config.window > 0) || config.patience < 1)
    throw std::invalid_argument(
        "a disturbance watch needs a limit, a window and a patience above 0, and a model error of at least "
        "0");
}

ArmState DisturbanceWatch::predicted(const Sample& from) const {
  return plus(from.rest, minus(last_.nominal, from.nominal));
}

void DisturbanceWatch::add(double time, const ArmState& rest, const ArmState& command, double sigma) {
  Sample newest{time, rest, command, model_.actuation().shape(command)};
  if (!is_possible(rest) || !is_possible(newest.nominal)) return;
  last_ = std::move(newest);
  // The newest sample that is at least a window old stays.
  while (samples_.size() > 1 && samples_[1].time <= time - config_.window) samples_.pop_front();
  if (first_.rest.bends.empty()) begun_ = time;
  if (time < begun_ + config_.grace || first_.rest.bends.empty()) first_ = last_;
  if (time < begun_ + config_.grace) {
    samples_.assign(1, last_);
    return;
  }
  if (samples_.empty()) samples_.push_back(last_);
  const ServoError motion = servo_error(model_.shaped(), last_.nominal, reference().nominal);
  deviation_ = servo_error(model_.shaped(), rest, predicted(reference())).rms;
  constexpr double certain = 5;  // Standard deviations.
  double allowed = config_.limit + config_.model_error * motion.rms + certain * sigma;
  constexpr double back = 0.5;  // A disturbance is over well below the limit at which it begins.
  if (is_disturbed_) allowed *= back;
  in_a_row_ = (deviation_ > allowed) != is_disturbed_ ? in_a_row_ + 1 : 0;
  if (in_a_row_ >= config_.patience) {
    if (!is_disturbed_) before_ = samples_.front(), since_ = time;
    is_disturbed_ = !is_disturbed_;
    in_a_row_ = 0;
    samples_.clear();
  }
  // A suspicious observation must not become a reference.
  if (!is_disturbed_ && in_a_row_ == 0) samples_.push_back(last_);
}

// Compares the deviation with those that the release of each tendon would cause.
std::optional<std::size_t> DisturbanceWatch::released_tendon(const ArmState& expected) const {
  const std::vector<ArmState> released = model_.actuation().released(last_.command);
  const Eigen::VectorXd nominal = points_of(model_.shaped(), last_.nominal),
                        moved = points_of(model_.shaped(), last_.rest) - points_of(model_.shaped(), expected);
  constexpr double least = 0.15, most = 1.7;  // Share of a release that counts as one.
  constexpr double explains = 0.5;            // Largest share of the deviation that is left.
  std::optional<std::size_t> best;
  double best_left = explains * moved.norm();
  for (std::size_t i = 0; i < released.size(); ++i) {
    if (!is_possible(released[i])) continue;  // The arm has no equilibrium without this tendon.
    const Eigen::VectorXd way = points_of(model_.shaped(), released[i]) - nominal;
    const double share = way.dot(moved) / way.squaredNorm();
    const bool is_release = share >= least && share <= most;  // False if it is not a number.
    if (!is_release) continue;
    const double left = (moved - share * way).norm();
    if (left < best_left) best = i, best_left = left;
  }
  return best;
}

std::string DisturbanceWatch::what() const {
  const bool is_known = is_disturbed_ || !samples_.empty();
  const std::optional<std::size_t> tendon = is_known ? released_tendon(predicted(reference())) : std::nullopt;
  return fmt::format("the arm's shape differs by {:.2g} % of its length from the prediction, {}",
                     100 * deviation_,
                     tendon ? as_if_released(*tendon) : "as if something pushed or held the arm");
}

std::string DisturbanceWatch::slow_cause() const {
  if (first_.rest.bends.empty()) return "";
  const ArmState expected = predicted(first_);
  const double motion = servo_error(model_.shaped(), last_.nominal, first_.nominal).rms;
  if (!(servo_error(model_.shaped(), last_.rest, expected).rms > config_.limit + slow_error * motion))
    return "";
  const std::optional<std::size_t> tendon = released_tendon(expected);
  return tendon ? as_if_released(*tendon) : "";
}

}  // namespace flexura
