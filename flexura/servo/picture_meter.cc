#include "flexura/servo/picture_meter.h"

#include <algorithm>
#include <cstdint>

#include "flexura/estimate/backbone_pixels.h"
#include "flexura/estimate/picture_observation.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

// Number of pictures without arm after which all thresholding methods are tried.
constexpr int pictures_a_trial = 10;

// An uncertain shape is no reason to distrust a fit: the tracker weighs it by its covariance.
EstimatorConfig fit_estimator() {
  EstimatorConfig config = TubeFitter::default_estimator();
  config.uncertain = 0.02;
  return config;
}

}  // namespace

PictureMeter::PictureMeter(const RigModel& nominal, const ServoConfig& config)
    : base_(nominal.arm.X_WB.position),
      has_markers_(!config.markers.empty()),
      scenes_(config.scenes),
      view_prior_(config.camera_prior) {
  if (config.track == ServoTracking::model)
    fitter_.emplace(ShapePrior{.arm = nominal.arm}, fit_estimator(), TubeFitConfig{.trusted_visible = 0.35});
  for (std::size_t i = 0; i < 2; ++i) whites_[i] = nominal.cameras.at(config.cameras[i]).sensor.white();
}

Observation PictureMeter::observation(std::size_t i, const Picture& picture, const View& view,
                                      const std::optional<Shape>& expected, std::string& reason) {
  constexpr double moved = 2;  // Distance of the base in px beyond which the finder is created again.
  const Eigen::Vector2d base = view.project(base_).value_or(Eigen::Vector2d(0.5 * view.width, view.height));
  if (!finders_[i] || (finders_[i]->base - base).norm() > moved) {
    ArmFinderConfig config;
    config.base = base;
    config.scene = scenes_[i];
    finders_[i].emplace(Finder{base, ArmFinder(config)});
  }
  // The method of the last pictures is right for this one, too. Only if it fails for long, the light has
  // changed. To try all methods in every picture without arm would take three times as long.
  Finder& own = *finders_[i];
  const bool tries_all = !own.method || own.blind % pictures_a_trial == pictures_a_trial - 1;
  own.finder.set_methods(tries_all ? ThresholdMethod::otsu : *own.method, tries_all);
  if (expected) {
    constexpr int points = 48;
    const View seen_from = i < expected->views.size() ? corrected(view, expected->views[i]) : view;
    own.finder.expect(backbone_pixels(expected->arm, expected->state, seen_from, points));
  }
  const ArmObservation& found = own.finder.find(picture, whites_[i]);
  own.blind = found.is_found() ? 0 : own.blind + 1;
  if (found.is_found()) own.method = found.threshold.method;
  reason = found.reason;
  const bool has_bands = has_markers_ && found.is_found();
  Observation seen =
      has_bands ? observation_of(found, view, eight_bits(picture, whites_[i])) : observation_of(found, view);
  seen.view_prior = view_prior_;
  return seen;
}

bool PictureMeter::follow(const PicturePair& pair, const ShapePrediction& prediction,
                          ServoObservation& observed) {
  std::array<Image<std::uint8_t>, 2> bytes;
  std::array<TubePicture, 2> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    bytes[i] = eight_bits(*pair.frames[i].picture, whites_[i]);
    pictures[i] = {&bytes[i], pair.views[i], view_prior_, scenes_[i].get()};
  }
  TubeFit fit = fitter_->fit(pictures, prediction);
  if (!fit.estimate.is_trusted() || !are_enough(fit.observations)) return false;
  std::ranges::move(fit.observations, observed.seen.begin());
  return true;
}

ServoObservation PictureMeter::measure(const PicturePair& pair,
                                       const std::optional<ShapePrediction>& prediction,
                                       const std::optional<Shape>& expected) {
  ServoObservation observed;
  observed.frames = pair.frames, observed.time = pair.time();
  if (fitter_ && prediction && follow(pair, *prediction, observed)) return observed;
  for (std::size_t i = 0; i < 2; ++i)
    observed.seen[i] = observation(i, *pair.frames[i].picture, pair.views[i], expected, observed.reasons[i]);
  if (are_enough(observed.seen)) return observed;
  for (std::size_t i = 0; i < 2; ++i)
    if (observed.reasons[i].empty() && !are_enough({&observed.seen[i], 1}))
      observed.reasons[i] = "too small a part of the arm is visible";
  return observed;
}

}  // namespace flexura
