#include "flexura/servo/shape_observer.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/model/arm_difference.h"

namespace flexura {
namespace {

ShapePrior prior_of(const Arm& arm, const std::vector<double>& markers) {
  ShapePrior prior;
  prior.arm = arm;
  prior.markers = markers;
  return prior;
}

// A camera that is wrong by one degree shifts the arm's image by many pixels. If view errors are not
// estimated, the nearest shape is still the best one to use.
EstimatorConfig patient_estimator(const ViewPrior& view_prior) {
  EstimatorConfig config;
  config.most_rms = view_prior.is_any() ? 5 : 20;
  return config;
}

// With such offsets no measurement is rejected as another object's.
constexpr double nominal_view_error = 2;  // px

void tolerate_view_error(Observation& seen) {
  for (CurvePoint& point : seen.points) point.sigma = std::max(point.sigma, nominal_view_error);
  for (SeenBorder& border : seen.borders) border.sigma = std::max(border.sigma, nominal_view_error);
  for (auto& end : seen.ends)
    if (end) end->sigma = std::max(end->sigma, nominal_view_error);
}

// Returns the mean noise of the pictures, px.
double noise_of(const std::array<Observation, 2>& seen) {
  double sum = 0, count = 0;
  for (const Observation& one : seen)
    for (const CurvePoint& point : one.points) sum += point.sigma, ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace

ShapeObserver::ShapeObserver(const RigReader& rig, const RigModel& nominal, const ServoConfig& config)
    : rig_(rig),
      length_(nominal.arm.length()),
      view_prior_(config.camera_prior),
      prior_(prior_of(nominal.arm, config.markers)),
      tracker_(prior_, patient_estimator(view_prior_)) {}

bool ShapeObserver::observe(const std::shared_ptr<ServoObservation>& observed, double now) {
  estimate(*observed, expected(rig_.nominal(observed->time)));
  if (!first_) first_ = observed;
  if (!observed->estimate.is_found) return false;
  seen_since_ = now, last_ = observed;
  return true;
}

void ShapeObserver::estimate_alone(ServoObservation& observed) {
  forget();
  estimate(observed, std::nullopt);
  forget();
}

void ShapeObserver::estimate(ServoObservation& observed, const std::optional<ArmState>& expected) {
  if (!are_enough(observed.seen)) {
    observed.estimate.reason = "the arm is not seen in every image";
    return;
  }
  observed.estimate = shape_of(observed, expected);
  if (!observed.estimate.is_found) return;
  const std::vector<ViewError>& errors = observed.estimate.shape.views;
  for (std::size_t i = 0; i < errors.size(); ++i)
    observed.seen[i].view = corrected(observed.seen[i].view, errors[i]);
}

// Fallback for cameras without a prior that fit no shape within the pictures' noise: estimates the nearest
// shape. Stays in this mode until forget().
ShapeEstimate ShapeObserver::shape_of(const ServoObservation& observed,
                                      const std::optional<ArmState>& expected) {
  ShapeEstimate found;
  if (!uses_nominal_views_) found = tracker_.look(observed.seen, observed.time, expected);
  if (found.is_found || view_prior_.is_any()) return found;
  std::array<Observation, 2> seen = observed.seen;
  for (Observation& one : seen) tolerate_view_error(one);
  if (!uses_nominal_views_) tracker_.forget();
  ShapeEstimate nearest = tracker_.look(seen, observed.time, expected);
  if (!nearest.is_found && !uses_nominal_views_) {
    tracker_.forget();
    return found;
  }
  uses_nominal_views_ = true;
  for (double& sigma : nearest.sigma) sigma *= std::min(1.0, noise_of(observed.seen) / nominal_view_error);
  return nearest;
}

ShapeEstimate ShapeObserver::with_nominal_views(const ServoObservation& observed,
                                                const std::array<View, 2>& views) const {
  std::array<Observation, 2> seen = observed.seen;
  for (std::size_t i = 0; i < 2; ++i) seen[i].view = views[i], seen[i].view_prior = {};
  return ShapeEstimator(prior_, patient_estimator({})).estimate(seen);
}

ArmState ShapeObserver::expected(ArmState driven) const {
  return last_ ? plus(std::move(driven), minus(last_->estimate.shape.state, rig_.nominal(last_->time)))
               : driven;
}

double ShapeObserver::sigma() const {
  const ShapeEstimate& estimate = last_->estimate;
  const double common = view_prior_.is_any() ? 1 : estimate.scale;
  return estimate.rms_sigma() / (common * length_);
}

}  // namespace flexura
