#include "flexura/servo/shape_observer.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/model/arm_way.h"

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
EstimatorConfig patient_estimator(const ViewDoubt& doubt) {
  EstimatorConfig config;
  config.most_rms = doubt.is_any() ? 5 : 20;
  return config;
}

// With such offsets no measurement is rejected as another object's.
constexpr double believed_off = 2;  // px

void believe(Sighting& seen) {
  for (CurvePoint& point : seen.points) point.sigma = std::max(point.sigma, believed_off);
  for (SeenBorder& border : seen.borders) border.sigma = std::max(border.sigma, believed_off);
  for (auto& end : seen.ends)
    if (end) end->sigma = std::max(end->sigma, believed_off);
}

// Returns the mean noise of the pictures, px.
double noise_of(const std::array<Sighting, 2>& seen) {
  double sum = 0, count = 0;
  for (const Sighting& one : seen)
    for (const CurvePoint& point : one.points) sum += point.sigma, ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace

ShapeObserver::ShapeObserver(const RigReader& rig, const RigModel& believed, const ServoConfig& config)
    : rig_(rig),
      length_(believed.arm.length()),
      doubt_(config.camera_prior),
      prior_(prior_of(believed.arm, config.markers)),
      tracker_(prior_, patient_estimator(doubt_)) {}

bool ShapeObserver::observe(const std::shared_ptr<ServoSight>& sight, double now) {
  estimate(*sight, expected(rig_.believed(sight->time)));
  if (!first_) first_ = sight;
  if (!sight->estimate.is_found) return false;
  seen_since_ = now, last_ = sight;
  return true;
}

void ShapeObserver::estimate_alone(ServoSight& sight) {
  forget();
  estimate(sight, std::nullopt);
  forget();
}

void ShapeObserver::estimate(ServoSight& sight, const std::optional<ArmState>& expected) {
  if (!are_enough(sight.seen)) {
    sight.estimate.reason = "the arm is not seen in every image";
    return;
  }
  sight.estimate = shape_of(sight, expected);
  if (!sight.estimate.is_found) return;
  const std::vector<ViewError>& errors = sight.estimate.shape.views;
  for (std::size_t i = 0; i < errors.size(); ++i)
    sight.seen[i].view = corrected(sight.seen[i].view, errors[i]);
}

// Fallback for cameras without a prior that fit no shape within the pictures' noise: estimates the nearest
// shape. Stays in this mode until forget().
ShapeEstimate ShapeObserver::shape_of(const ServoSight& sight, const std::optional<ArmState>& expected) {
  ShapeEstimate found;
  if (!is_believing_) found = tracker_.look(sight.seen, sight.time, expected);
  if (found.is_found || doubt_.is_any()) return found;
  std::array<Sighting, 2> seen = sight.seen;
  for (Sighting& one : seen) believe(one);
  if (!is_believing_) tracker_.forget();
  ShapeEstimate nearest = tracker_.look(seen, sight.time, expected);
  if (!nearest.is_found && !is_believing_) {
    tracker_.forget();
    return found;
  }
  is_believing_ = true;
  for (double& sigma : nearest.sigma) sigma *= std::min(1.0, noise_of(sight.seen) / believed_off);
  return nearest;
}

ShapeEstimate ShapeObserver::as_believed(const ServoSight& sight, const std::array<View, 2>& views) const {
  std::array<Sighting, 2> seen = sight.seen;
  for (std::size_t i = 0; i < 2; ++i) seen[i].view = views[i], seen[i].doubt = {};
  return ShapeEstimator(prior_, patient_estimator({})).estimate(seen);
}

ArmState ShapeObserver::expected(ArmState driven) const {
  return last_ ? plus(std::move(driven), minus(last_->estimate.shape.state, rig_.believed(last_->time)))
               : driven;
}

double ShapeObserver::sigma() const { return relative_sigma(last_->estimate); }

double ShapeObserver::sigma_of_last() const {
  return relative_sigma(
      ShapeEstimator(prior_, patient_estimator(doubt_)).follow(last_->seen, last_->estimate.shape));
}

double ShapeObserver::relative_sigma(const ShapeEstimate& estimate) const {
  const double common = doubt_.is_any() ? 1 : estimate.scale;
  return estimate.rms_sigma() / (common * length_);
}

}  // namespace flexura
