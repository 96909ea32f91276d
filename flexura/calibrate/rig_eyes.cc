#include "flexura/calibrate/rig_eyes.h"

#include <utility>

#include "flexura/calibrate/etalon_eyes.h"
#include "flexura/calibrate/rig_sights.h"

namespace flexura {
namespace {

class ArmEyes : public RigEyes {
 public:
  ArmEyes(const RigModel& believed, const RigPrior& prior, const RigSessionConfig& config,
          const Eigen::Vector3d& target)
      : believed_(believed),
        config_(config),
        reader_(believed, prior, config.cameras, target, config.fewest),
        sights_(believed.arm, config.picture, config.cameras) {
    for (const std::size_t camera : config.cameras) {
      ArmPictureConfig picture = config.picture;
      picture.white = believed.cameras.at(camera).sensor.white();
      pictures_.emplace_back(std::move(picture));
    }
  }

  std::vector<ArmState>& poses() override { return sights_.poses; }
  std::vector<RigStance>& stances() override { return sights_.stances; }

  bool look(std::size_t i, const Picture& picture) override {
    figure_ = pictures_[i].look(picture);
    // One marker alone may be any.
    constexpr std::size_t fewest = 2;
    return markers_of(figure_.scene) >= fewest;
  }
  SeenArm unkept(const View& view) const override {
    MarkerMatch none;
    none.markers.resize(figure_.markers.size());
    return recognised(figure_, none, view.lens, config_.picture);
  }
  SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) override {
    sights_.looks.push_back({.stance = stance, .pose = pose, .arm = std::move(figure_)});
    const MarkerMatch match = reader_.read_last(sights_, found);
    return sights_.seen(found != nullptr ? *found : believed_, sights_.looks.size() - 1, match);
  }

  RigReading read(const RigModel* found) const override { return reader_.read(sights_, found); }
  RigImage told(const RigModel& /*model*/, const RigSight& sight) const override {
    return {.stance = 0, .pose = 0, .markers = sight.seen.markers, .points = sight.seen.points};
  }

 private:
  const RigModel& believed_;
  const RigSessionConfig& config_;
  std::vector<ArmPicture> pictures_;  // Of each camera.
  RigReader reader_;
  RigSights sights_;
  ArmFigure figure_;  // The last one.
};

}  // namespace

std::unique_ptr<RigEyes> session_eyes(const RigModel& believed, const RigPrior& prior,
                                      const RigSessionConfig& config, const Eigen::Vector3d& target) {
  if (config.etalon) return std::make_unique<EtalonEyes>(believed, prior, config);
  return std::make_unique<ArmEyes>(believed, prior, config, target);
}

}  // namespace flexura
