#include "flexura/servo/shape_observer.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/estimate/tube_fit.h"
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

// Modes of the arm's swing that are estimated. Faster ones move less, and pictures at camera rates do not
// show them.
constexpr std::size_t swing_modes = 6;

// Returns (bend_x, bend_y, stretch) of each section.
Eigen::VectorXd numbers_of(const ArmState& state) {
  Eigen::VectorXd numbers(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i)
    numbers.segment<3>(3 * static_cast<Eigen::Index>(i)) << state.bends[i], state.stretches[i];
  return numbers;
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
      nominal_(nominal),
      length_(nominal.arm.length()),
      view_prior_(config.camera_prior),
      prior_(prior_of(nominal.arm, config.markers)),
      tracker_(prior_, patient_estimator(view_prior_)) {}

bool ShapeObserver::observe(const std::shared_ptr<ServoObservation>& observed, double now) {
  const SwingPath path =
      path_until(observed->time, last_ ? nominal_.actuation.swing(rig_.measured(observed->time), swing_modes)
                                       : std::vector<SwingMode>());
  estimate(*observed, predicted(observed->time), path);
  if (!first_) first_ = observed;
  if (!observed->estimate.is_found) return false;
  observed->rest = observed->estimate.shape.state;
  const Eigen::VectorXd swing = tracker_.swing().shape();
  for (std::size_t i = 0; i < observed->rest.bends.size() && swing.size() > 0; ++i)
    observed->rest.bends[i] -= swing.segment<2>(3 * static_cast<Eigen::Index>(i));
  seen_since_ = now, last_ = observed;
  if (path.last_rate.size() > 0) rate_ = path.last_rate;
  return true;
}

// A part is a time between two readings, with the mean rate of the drives.
SwingPath ShapeObserver::path_until(double time, const std::vector<SwingMode>& modes) const {
  SwingPath path;
  if (!last_ || !(time > last_->time) || modes.empty()) return path;
  path.modes = modes;
  std::vector<double> ends = rig_.readings_between(last_->time, time);
  ends.push_back(time);
  double from = last_->time;
  Eigen::VectorXd at = numbers_of(rig_.measured(from)), rate = rate_;
  if (rate.size() != at.size()) rate = Eigen::VectorXd::Zero(at.size());
  for (const double end : ends) {
    // Beyond the newest reading the drives go on as before.
    const bool is_read = end <= rig_.newest_reading();
    const Eigen::VectorXd next = numbers_of(rig_.measured(end)),
                          now = is_read ? Eigen::VectorXd((next - at) / (end - from)) : rate;
    SwingPath::Part part{.duration = end - from,
                         .kicks = Eigen::VectorXd(static_cast<Eigen::Index>(path.modes.size()))};
    for (std::size_t j = 0; j < path.modes.size(); ++j)
      part.kicks[static_cast<Eigen::Index>(j)] = path.modes[j].kick.dot(now - rate);
    path.parts.push_back(std::move(part));
    path.last_rate = rate = now;
    at = next, from = end;
  }
  return path;
}

void ShapeObserver::estimate_alone(ServoObservation& observed) {
  forget();
  estimate(observed, std::nullopt, {});
  forget();
}

void ShapeObserver::estimate(ServoObservation& observed, const std::optional<ArmState>& expected,
                             const SwingPath& path) {
  if (!are_enough(observed.seen)) {
    observed.estimate.reason = "the arm is not visible in every image";
    return;
  }
  observed.estimate = shape_of(observed, expected, path);
  if (!observed.estimate.is_found) return;
  const std::vector<ViewError>& errors = observed.estimate.shape.views;
  for (std::size_t i = 0; i < errors.size(); ++i)
    observed.seen[i].view = corrected(observed.seen[i].view, errors[i]);
}

// Fallback for cameras without a prior that fit no shape within the pictures' noise: estimates the nearest
// shape. Stays in this mode until forget().
ShapeEstimate ShapeObserver::shape_of(const ServoObservation& observed,
                                      const std::optional<ArmState>& expected, const SwingPath& path) {
  ShapeEstimate found;
  if (!uses_nominal_views_) found = tracker_.look(observed.seen, observed.time, expected, path);
  if (found.is_found || view_prior_.is_any()) return found;
  std::array<Observation, 2> seen = observed.seen;
  for (Observation& one : seen) tolerate_view_error(one);
  if (!uses_nominal_views_) tracker_.forget();
  ShapeEstimate nearest = tracker_.look(seen, observed.time, expected, path);
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
  return last_ ? plus(std::move(driven), minus(last_->rest, rig_.nominal(last_->time))) : driven;
}

ArmState ShapeObserver::predicted(double time) const {
  ArmState driven = rig_.nominal(time);
  if (!last_) return driven;
  return plus(std::move(driven), minus(last_->estimate.shape.state, rig_.nominal(last_->time)));
}

std::optional<Shape> ShapeObserver::predicted_shape(double time) const {
  if (!last_ || tracker_.swing().is_tracked()) return std::nullopt;
  return Shape{last_->estimate.shape.arm, predicted(time), last_->estimate.shape.views};
}

// Process noise and motion noise are those of the tracker, plus a little for what the model does not know.
ShapePrediction ShapeObserver::prediction(double time) const {
  constexpr double first_std = 0.1, least_std = 0.01, process_noise = 0.03, motion_noise = 0.1;
  const std::array<ViewPrior, 2> views = {view_prior_, view_prior_};
  ShapePrediction rough =
      rough_prediction(prior_, Shape{prior_.arm, predicted(time)}, last_ ? least_std : first_std, views);
  if (!last_) return rough;
  const ShapeEstimate& before = last_->estimate;
  if (before.covariance.rows() != rough.covariance.rows() || !before.covariance.allFinite()) return rough;
  rough.mean.views = before.shape.views;
  const ShapeVariables variables(prior_);
  const Eigen::Index bends = variables.bends_a_section();
  const double since = std::max(0.0, time - last_->time);
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(rough.covariance.rows());
  for (std::size_t i = 0; i < before.shape.state.bends.size(); ++i) {
    const double went = (rough.mean.state.bends[i] - before.shape.state.bends[i]).norm();
    noise.segment(static_cast<Eigen::Index>(i) * bends, bends)
        .setConstant(process_noise * process_noise * since + motion_noise * motion_noise * went * went +
                     least_std * least_std);
  }
  rough.covariance = before.covariance;
  rough.covariance.diagonal() += noise;
  return rough;
}

double ShapeObserver::sigma() const { return relative_sigma(last_->estimate); }

double ShapeObserver::sigma_of_last() const {
  return relative_sigma(
      ShapeEstimator(prior_, patient_estimator(view_prior_)).follow(last_->seen, last_->estimate.shape));
}

double ShapeObserver::relative_sigma(const ShapeEstimate& estimate) const {
  const double common = view_prior_.is_any() ? 1 : estimate.scale;
  return estimate.rms_sigma() / (common * length_);
}

}  // namespace flexura
