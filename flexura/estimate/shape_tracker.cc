#include "flexura/estimate/shape_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace flexura {

ShapeTracker::ShapeTracker(ShapePrior prior, const EstimatorConfig& estimator, const TrackerConfig& config)
    : prior_(prior),
      arm_(prior.arm),
      config_(config),
      variables_(prior),
      estimator_(std::move(prior), estimator) {
  if (variables_.of_shape() != variables_.bends_a_section() * static_cast<Eigen::Index>(arm_.sections.size()))
    throw std::invalid_argument("a tracker needs an arm of known base and length");
}

void ShapeTracker::go_on(std::span<const Observation> observations, double time, const ArmState& expected,
                         const SwingPath& path) {
  if (!prediction_) return;
  ShapePrediction& prediction = *prediction_;
  const double since = std::isfinite(time - time_) ? std::max(0.0, time - time_) : 0.0;
  auto variances = prediction.covariance.diagonal();
  const double process_noise = path.modes.empty() ? config_.process_noise : config_.swinging_noise;
  const Eigen::Index bends = variables_.bends_a_section();
  for (std::size_t i = 0; i < expected.bends.size(); ++i) {
    const double went = (expected.bends[i] - prediction.mean.state.bends[i]).norm();
    const double motion_noise = config_.motion_noise * went;
    variances.segment(static_cast<Eigen::Index>(i) * bends, bends).array() +=
        process_noise * process_noise * since + motion_noise * motion_noise;
  }
  // Variables without a prior stay fixed.
  const ShapeVariables variables(prior_, observations);
  for (std::size_t i = 0; i < observations.size() && variables.count() == variances.size(); ++i) {
    const Eigen::Index at = variables.of_view(i);
    if (at < 0) continue;
    const double turn = observations[i].view_prior.rotation_std > 0 ? config_.turn_noise : 0,
                 focal = observations[i].view_prior.focal_std > 0 ? config_.focal_noise : 0;
    variances.segment<3>(at).array() += turn * turn * since;
    variances[at + 3] += focal * focal * since;
  }
  prediction.mean.state = expected;
  time_ = time;
  const Eigen::VectorXd change = swing_.predict(path, bends, prediction.covariance);
  for (std::size_t i = 0; i < expected.bends.size() && change.size() > 0; ++i)
    prediction.mean.state.bends[i].head(bends) += change.segment(3 * static_cast<Eigen::Index>(i), bends);
}

void ShapeTracker::update_swing(std::span<const Observation> observations, const ShapeEstimate& estimate) {
  if (!prediction_ || !swing_.is_tracked()) return;
  const ShapeVariables variables(prior_, observations);
  if (variables.count() != prediction_->covariance.rows() || !estimate.covariance.allFinite()) {
    swing_.forget();
    return;
  }
  swing_.update(variables.minus(estimate.shape, prediction_->mean), prediction_->covariance,
                estimate.covariance, is_updated_);
}

// View errors leave residuals that are similar in successive pictures.
bool ShapeTracker::is_as_usual(const ShapeEstimate& estimate) const {
  constexpr double few = 0.5, as_usual = 2;  // px, times
  return estimate.is_found && estimate.rms <= std::max(few, as_usual * usual_rms_);
}

ShapeEstimate ShapeTracker::followed(std::span<const Observation> observations, const ArmState& expected) {
  if (prediction_) {
    ShapeEstimate updated = estimator_.update(observations, *prediction_);
    is_innovation_large_ = updated.is_found && !(updated.innovation <= config_.max_innovation);
    is_updated_ = is_as_usual(updated) && !is_innovation_large_;
    if (is_updated_) return updated;
  }
  return estimator_.follow(
      observations, Shape{arm_, expected, prediction_ ? prediction_->mean.views : std::vector<ViewError>{}});
}

// A fit that begins beside the arm and treats the contradictions as outliers would persist.
bool ShapeTracker::is_to_be_checked(const ShapeEstimate& estimate) {
  if (estimate.outlier_share > config_.max_outlier_share)
    ++unreliable_;
  else
    unreliable_ = 0;
  return unreliable_ >= config_.patience;
}

ShapeEstimate ShapeTracker::from_nothing(std::span<const Observation> observations) {
  // The explanation of the last pictures, with cameras beyond their priors, probably explains these.
  const auto explains = [&](const ShapeEstimate& one) {
    return one.is_elsewhere && one.outlier_share < config_.max_outlier_share &&
           one.scale < ShapeFit::most_scale;
  };
  if (elsewhere_) {
    ShapeEstimate again = estimator_.follow(observations, *elsewhere_);
    if (explains(again)) return again;
  }
  ShapeEstimate anew = estimator_.estimate(observations);
  elsewhere_.reset();
  if (explains(anew)) elsewhere_ = anew.shape;
  return anew;
}

ShapeEstimate ShapeTracker::found(std::span<const Observation> observations,
                                  const std::optional<ArmState>& expected) {
  ShapeEstimate best;
  is_innovation_large_ = false;
  if (expected && !elsewhere_) {
    best = followed(observations, *expected);
    if (is_as_usual(best) && !is_innovation_large_) {
      if (!is_to_be_checked(best)) return best;
      unreliable_ = 0;
      ShapeEstimate anew = from_nothing(observations);
      const bool is_better = anew.is_found && anew.outlier_share < 0.5 * best.outlier_share;
      if (!elsewhere_ && !is_better) return best;
      is_updated_ = false;
      return anew;
    }
  }
  unreliable_ = 0;
  is_updated_ = false;
  ShapeEstimate anew = from_nothing(observations);
  // If none is found, the second one gives the reason, unless it could not be tried.
  const bool is_tried = !expected || std::ranges::all_of(observations, [](const Observation& seen) {
    return are_enough({&seen, 1});
  });
  if (!best.reason.empty() && !best.is_found && !anew.is_found && !is_tried) return best;
  return !best.is_found || ((anew.is_found || elsewhere_) && anew.rms < best.rms) ? anew : best;
}

ShapeEstimate ShapeTracker::look(std::span<const Observation> observations, double time,
                                 const std::optional<ArmState>& expected) {
  return look(observations, time, expected, {});
}

ShapeEstimate ShapeTracker::look(std::span<const Observation> observations, double time,
                                 const std::optional<ArmState>& expected, const SwingPath& path) {
  if (!are_enough(observations)) {
    ShapeEstimate none;
    none.reason = "the arm is not visible in every image";
    return none;
  }
  is_updated_ = false;
  const std::optional<ShapePrediction> before = prediction_;
  const SwingFilter swing_before = swing_;
  const double time_before = time_;
  std::optional<ArmState> predicted = expected;
  if (expected && prediction_) {
    go_on(observations, time, *expected, path);
    predicted = prediction_->mean.state;
  }
  ShapeEstimate estimate = found(observations, predicted);
  if (!estimate.is_found) {
    prediction_ = before, swing_ = swing_before, time_ = time_before;
    return estimate;
  }
  if (expected)
    update_swing(observations, estimate);
  else
    swing_.forget();
  prediction_ = ShapePrediction{estimate.shape, estimate.covariance};
  time_ = time, usual_rms_ = estimate.rms;
  return estimate;
}

}  // namespace flexura
