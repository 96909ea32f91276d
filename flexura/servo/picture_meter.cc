#include "flexura/servo/picture_meter.h"

#include "flexura/estimate/picture_sighting.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

PictureMeter::PictureMeter(const RigModel& believed, const ServoConfig& config)
    : base_(believed.arm.X_WB.position), has_markers_(!config.markers.empty()), doubt_(config.camera_prior) {
  for (std::size_t i = 0; i < 2; ++i) whites_[i] = believed.cameras.at(config.cameras[i]).sensor.white();
}

Sighting PictureMeter::sighting(std::size_t i, const Picture& picture, const View& view,
                                std::string& reason) {
  constexpr double moved = 2;  // Distance of the base in px beyond which the finder is created again.
  const Eigen::Vector2d base = view.project(base_).value_or(Eigen::Vector2d(0.5 * view.width, view.height));
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

ServoSight PictureMeter::measure(const PicturePair& pair) {
  ServoSight sight;
  sight.frames = pair.frames, sight.time = pair.time();
  for (std::size_t i = 0; i < 2; ++i)
    sight.seen[i] = sighting(i, *pair.frames[i].picture, pair.views[i], sight.reasons[i]);
  if (are_enough(sight.seen)) return sight;
  for (std::size_t i = 0; i < 2; ++i)
    if (sight.reasons[i].empty() && !are_enough({&sight.seen[i], 1}))
      sight.reasons[i] = "too little of the arm is seen";
  return sight;
}

}  // namespace flexura
