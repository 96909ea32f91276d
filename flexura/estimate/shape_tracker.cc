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

ShapeBelief ShapeTracker::gone_on(std::span<const Sighting> sightings, double time,
                                  const ArmState& expected) const {
  ShapeBelief belief = *belief_;
  const double since = std::isfinite(time - time_) ? std::max(0.0, time - time_) : 0.0;
  auto variances = belief.covariance.diagonal();
  const Eigen::Index bends = variables_.bends_a_section();
  for (std::size_t i = 0; i < expected.bends.size(); ++i) {
    const double went = (expected.bends[i] - belief.mean.state.bends[i]).norm();
    const double astray = config_.astray * went;
    variances.segment(static_cast<Eigen::Index>(i) * bends, bends).array() +=
        config_.drift * config_.drift * since + astray * astray;
  }
  // Variables without a prior stay fixed.
  const ShapeVariables variables(prior_, sightings);
  for (std::size_t i = 0; i < sightings.size() && variables.count() == variances.size(); ++i) {
    const Eigen::Index at = variables.of_view(i);
    if (at < 0) continue;
    const double turn = sightings[i].doubt.rotation_std > 0 ? config_.turn_drift : 0,
                 focal = sightings[i].doubt.focal_std > 0 ? config_.focal_drift : 0;
    variances.segment<3>(at).array() += turn * turn * since;
    variances[at + 3] += focal * focal * since;
  }
  belief.mean.state = expected;
  return belief;
}

// View errors leave residuals that are similar in successive pictures.
bool ShapeTracker::is_as_usual(const ShapeEstimate& estimate) const {
  constexpr double few = 0.5, as_usual = 2;  // px, times
  return estimate.is_found && estimate.rms <= std::max(few, as_usual * usual_rms_);
}

ShapeEstimate ShapeTracker::followed(std::span<const Sighting> sightings, double time,
                                     const ArmState& expected) {
  if (belief_) {
    ShapeEstimate updated = estimator_.update(sightings, gone_on(sightings, time, expected));
    is_surprising_ = updated.is_found && !(updated.surprise <= config_.most_surprise);
    if (is_as_usual(updated) && !is_surprising_) return updated;
  }
  return estimator_.follow(sightings,
                           Shape{arm_, expected, belief_ ? belief_->mean.views : std::vector<ViewError>{}});
}

// A fit that begins beside the arm and treats the contradictions as outliers would persist.
bool ShapeTracker::is_to_be_checked(const ShapeEstimate& estimate) {
  if (estimate.doubted > config_.most_doubted)
    ++doubtful_;
  else
    doubtful_ = 0;
  return doubtful_ >= config_.patience;
}

ShapeEstimate ShapeTracker::from_nothing(std::span<const Sighting> sightings) {
  // The explanation of the last pictures, with cameras beyond their priors, probably explains these.
  const auto explains = [&](const ShapeEstimate& one) {
    return one.is_elsewhere && one.doubted < config_.most_doubted && one.scale < ShapeFit::most_scale;
  };
  if (elsewhere_) {
    ShapeEstimate again = estimator_.follow(sightings, *elsewhere_);
    if (explains(again)) return again;
  }
  ShapeEstimate anew = estimator_.estimate(sightings);
  elsewhere_.reset();
  if (explains(anew)) elsewhere_ = anew.shape;
  return anew;
}

ShapeEstimate ShapeTracker::found(std::span<const Sighting> sightings, double time,
                                  const std::optional<ArmState>& expected) {
  ShapeEstimate best;
  is_surprising_ = false;
  if (expected && !elsewhere_) {
    best = followed(sightings, time, *expected);
    if (is_as_usual(best) && !is_surprising_) {
      if (!is_to_be_checked(best)) return best;
      doubtful_ = 0;
      ShapeEstimate anew = from_nothing(sightings);
      const bool is_better = anew.is_found && anew.doubted < 0.5 * best.doubted;
      return elsewhere_ || is_better ? anew : best;
    }
  }
  doubtful_ = 0;
  ShapeEstimate anew = from_nothing(sightings);
  // If none is found, the second one gives the reason, unless it could not be tried.
  const bool is_tried = !expected || std::ranges::all_of(sightings, [](const Sighting& seen) {
    return are_enough({&seen, 1});
  });
  if (!best.reason.empty() && !best.is_found && !anew.is_found && !is_tried) return best;
  return !best.is_found || ((anew.is_found || elsewhere_) && anew.rms < best.rms) ? anew : best;
}

ShapeEstimate ShapeTracker::look(std::span<const Sighting> sightings, double time,
                                 const std::optional<ArmState>& expected) {
  if (!are_enough(sightings)) {
    ShapeEstimate none;
    none.reason = "the arm is not seen in every image";
    return none;
  }
  ShapeEstimate estimate = found(sightings, time, expected);
  if (!estimate.is_found) return estimate;
  belief_ = ShapeBelief{estimate.shape, estimate.covariance};
  time_ = time, usual_rms_ = estimate.rms;
  return estimate;
}

}  // namespace flexura
