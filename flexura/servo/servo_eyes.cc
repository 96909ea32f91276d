#include "flexura/servo/servo_eyes.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "flexura/estimate/picture_sighting.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

ShapePrior prior_of(const Arm& arm, std::vector<double> markers) {
  ShapePrior prior;
  prior.arm = arm;
  prior.markers = std::move(markers);
  return prior;
}

// Cameras that are a degree wrong show the arm by many pixels elsewhere than it would be seen: where nothing
// of it is put down to them the nearest shape is still the one to go by.
EstimatorConfig patient_estimator(const ViewDoubt& doubt) {
  EstimatorConfig config;
  config.most_rms = doubt.is_any() ? 5 : 20;
  return config;
}

// Nothing of it is taken for something else's where it is so far off.
constexpr double believed_off = 2;  // px

void believe(Sighting& seen) {
  for (CurvePoint& point : seen.points) point.sigma = std::max(point.sigma, believed_off);
  for (SeenBorder& border : seen.borders) border.sigma = std::max(border.sigma, believed_off);
  for (auto& end : seen.ends)
    if (end) end->sigma = std::max(end->sigma, believed_off);
}

// What the pictures' noise is, px.
double noise_of(const std::array<Sighting, 2>& seen) {
  double sum = 0, count = 0;
  for (const Sighting& one : seen)
    for (const CurvePoint& point : one.points) sum += point.sigma, ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace

ServoEyes::ServoEyes(const RigModel& believed, const std::array<std::size_t, 2>& cameras,
                     std::vector<double> markers, const ViewDoubt& doubt)
    : arm_(believed.arm),
      has_markers_(!markers.empty()),
      doubt_(doubt),
      prior_(prior_of(believed.arm, std::move(markers))),
      tracker_(prior_, patient_estimator(doubt)) {
  for (std::size_t i = 0; i < 2; ++i) whites_[i] = believed.cameras.at(cameras[i]).sensor.white();
}

Sighting ServoEyes::sighting(std::size_t i, const Picture& picture, const View& view, std::string& reason) {
  constexpr double moved = 2;  // px; then the finder is told anew where the base is.
  const Eigen::Vector2d base =
      view.project(arm_.X_WB.position).value_or(Eigen::Vector2d(0.5 * view.width, view.height));
  if (!finders_[i] || (finders_[i]->base - base).norm() > moved) {
    ArmFinderConfig config;
    config.base = base;
    finders_[i].emplace(Finder{base, ArmFinder(config)});
  }
  const ArmSighting& found = finders_[i]->finder.find(picture, whites_[i]);
  reason = found.reason;
  const bool has_bands = has_markers_ && found.is_found();
  Sighting seen =
      has_bands ? sighting_of(found, view, eight_bits(picture, whites_[i])) : sighting_of(found, view);
  seen.doubt = doubt_;
  return seen;
}

ServoSight ServoEyes::look(const std::array<Frame, 2>& frames, const std::array<View, 2>& views,
                           const std::optional<ArmState>& guess) {
  ServoSight sight;
  sight.frames = frames;
  sight.time = 0.5 * (frames[0].time + frames[1].time);
  for (std::size_t i = 0; i < 2; ++i)
    sight.seen[i] = sighting(i, *frames[i].picture, views[i], sight.reasons[i]);
  if (!are_enough(sight.seen)) {
    for (std::size_t i = 0; i < 2; ++i)
      if (sight.reasons[i].empty() && !are_enough({&sight.seen[i], 1}))
        sight.reasons[i] = "too little of the arm is seen";
    sight.estimate.reason = "the arm is not seen in every image";
    return sight;
  }
  sight.estimate = shape_of(sight, guess);
  if (!sight.estimate.is_found) return sight;
  const std::vector<ViewError>& errors = sight.estimate.shape.views;
  for (std::size_t i = 0; i < errors.size(); ++i)
    sight.seen[i].view = corrected(sight.seen[i].view, errors[i]);
  return sight;
}

// Of cameras that nobody doubts and that fit no shape by far more than the pictures' noise, the shape that is
// nearest: from then on, until told to forget.
ShapeEstimate ServoEyes::shape_of(const ServoSight& sight, const std::optional<ArmState>& guess) {
  ShapeEstimate found;
  if (!is_believing_) found = tracker_.look(sight.seen, sight.time, guess);
  if (found.is_found || doubt_.is_any()) return found;
  std::array<Sighting, 2> seen = sight.seen;
  for (Sighting& one : seen) believe(one);
  if (!is_believing_) tracker_.forget();
  ShapeEstimate nearest = tracker_.look(seen, sight.time, guess);
  if (!nearest.is_found && !is_believing_) {
    tracker_.forget();
    return found;
  }
  is_believing_ = true;
  for (double& sigma : nearest.sigma) sigma *= std::min(1.0, noise_of(sight.seen) / believed_off);
  return nearest;
}

ShapeEstimate ServoEyes::as_believed(const ServoSight& sight, const std::array<View, 2>& views) const {
  std::array<Sighting, 2> seen = sight.seen;
  for (std::size_t i = 0; i < 2; ++i) seen[i].view = views[i], seen[i].doubt = {};
  return ShapeEstimator(prior_, patient_estimator({})).estimate(seen);
}

}  // namespace flexura
