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
      : RigEyes(believed),
        config_(config),
        reader_(believed, prior, config.cameras, target, config.fewest),
        sights_(believed.arm, config.picture, config.cameras) {
    for (const std::size_t camera : config.cameras) {
      ArmPictureConfig picture = config.picture;
      picture.white = believed.cameras.at(camera).sensor.white();
      pictures_.emplace_back(std::move(picture));
    }
  }

  std::size_t markers() const override { return count_; }
  RigReading read(const RigModel* found) const override { return reader_.read(sights_, found); }
  RigImage told(const RigModel& /*model*/, const RigSight& sight) const override {
    return {.stance = 0, .pose = 0, .markers = sight.seen.markers, .points = sight.seen.points};
  }

 private:
  std::vector<ArmState>& poses() override { return sights_.poses; }
  std::vector<RigStance>& stances() override { return sights_.stances; }
  bool look(std::size_t i, const Picture& picture) override {
    figure_ = pictures_[i].look(picture);
    // One marker alone may be any.
    constexpr std::size_t fewest = 2;
    count_ = markers_of(figure_.scene);
    return count_ >= fewest;
  }
  SeenArm unkept(const View& view) const override {
    MarkerMatch none;
    none.markers.resize(figure_.markers.size());
    return recognised(figure_, none, view.lens, config_.picture);
  }
  SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) override {
    sights_.looks.push_back({.stance = stance, .pose = pose, .arm = std::move(figure_)});
    const MarkerMatch match = reader_.read_last(sights_, found);
    return sights_.seen(model(found), sights_.looks.size() - 1, match);
  }

  const RigSessionConfig& config_;
  std::vector<ArmPicture> pictures_;  // Of each camera.
  RigReader reader_;
  RigSights sights_;
  ArmFigure figure_;  // The last one.
  std::size_t count_ = 0;
};

}  // namespace

void RigEyes::sent(std::size_t i, const RigStance& stance) {
  Sent& camera = cameras_[i];
  if (stance.head == camera.to.head && stance.stage == camera.to.stage) return;
  camera.is_turned |= stance.head.pan != camera.to.head.pan || stance.head.tilt != camera.to.head.tilt;
  camera.to = stance;
  camera.stance.reset();
}

void RigEyes::see(std::size_t i, const RigModel* found, RigSight& sight) {
  if (poses().empty() || poses().back() != sight.pose) poses().push_back(sight.pose);
  if (!look(i, *sight.frame.picture)) {
    sight.seen = unkept(view_of(model(found), sight.stance));
    return;
  }
  Sent& camera = cameras_[i];
  if (!camera.stance) {
    RigStance& stance = stances().emplace_back(sight.stance);
    if (!camera.is_turned) stance.turned_as = camera.last;
    camera.stance = camera.last = stances().size() - 1;
    camera.is_turned = false;
  }
  sight.seen = keep(*camera.stance, poses().size() - 1, found);
}

std::unique_ptr<RigEyes> session_eyes(const RigModel& believed, const RigPrior& prior,
                                      const RigSessionConfig& config, const Eigen::Vector3d& target) {
  if (config.etalon) return std::make_unique<EtalonEyes>(believed, prior, config);
  return std::make_unique<ArmEyes>(believed, prior, config, target);
}

}  // namespace flexura
