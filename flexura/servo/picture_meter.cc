#include "flexura/servo/picture_meter.h"

#include "flexura/estimate/picture_observation.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

PictureMeter::PictureMeter(const RigModel& nominal, const ServoConfig& config)
    : base_(nominal.arm.X_WB.position),
      has_markers_(!config.markers.empty()),
      view_prior_(config.camera_prior) {
  for (std::size_t i = 0; i < 2; ++i) whites_[i] = nominal.cameras.at(config.cameras[i]).sensor.white();
}

Observation PictureMeter::observation(std::size_t i, const Picture& picture, const View& view,
                                      std::string& reason) {
  constexpr double moved = 2;  // Distance of the base in px beyond which the finder is created again.
  const Eigen::Vector2d base = view.project(base_).value_or(Eigen::Vector2d(0.5 * view.width, view.height));
  if (!finders_[i] || (finders_[i]->base - base).norm() > moved) {
    ArmFinderConfig config;
    config.base = base;
    finders_[i].emplace(Finder{base, ArmFinder(config)});
  }
  const ArmObservation& found = finders_[i]->finder.find(picture, whites_[i]);
  reason = found.reason;
  const bool has_bands = has_markers_ && found.is_found();
  Observation seen =
      has_bands ? observation_of(found, view, eight_bits(picture, whites_[i])) : observation_of(found, view);
  seen.view_prior = view_prior_;
  return seen;
}

ServoObservation PictureMeter::measure(const PicturePair& pair) {
  ServoObservation observed;
  observed.frames = pair.frames, observed.time = pair.time();
  for (std::size_t i = 0; i < 2; ++i)
    observed.seen[i] = observation(i, *pair.frames[i].picture, pair.views[i], observed.reasons[i]);
  if (are_enough(observed.seen)) return observed;
  for (std::size_t i = 0; i < 2; ++i)
    if (observed.reasons[i].empty() && !are_enough({&observed.seen[i], 1}))
      observed.reasons[i] = "too small a part of the arm is visible";
  return observed;
}

}  // namespace flexura
