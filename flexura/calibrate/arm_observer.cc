#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/calibrate/rig_observer.h"
#include "flexura/calibrate/rig_pictures.h"
#include "flexura/math/arrays.h"

namespace flexura {
namespace {

// Errors of the views predicted by a rig that was found.
constexpr PointingPrior of_found = {.sideways = 0.03, .roll = 0.02, .scale = 0.05};

// Finds the rig that explains pictures whose markers are not identified yet. Identifies them by a rig,
// estimates the rig from that, and identifies them again.
class ArmObserver : public RigObserver {
 public:
  ArmObserver(const RigModel& nominal, const RigPrior& prior, const RigSessionConfig& config,
              const Eigen::Vector3d& target)
      : RigObserver(nominal),
        prior_(prior),
        config_(config),
        rig_pictures_(nominal.arm, config.picture, config.cameras) {
    for (const std::size_t i : config.cameras) {
      ArmPictureConfig picture = config.picture;
      picture.white = nominal.cameras.at(i).sensor.white();
      pictures_.emplace_back(std::move(picture), i);
      const CameraPrior& camera = prior.cameras.at(i);
      const double moved = camera.position / (vector(nominal.cameras[i].mount.position) - target).norm();
      pointing_prior_.sideways = std::max(pointing_prior_.sideways, std::hypot(camera.rotation, moved));
      pointing_prior_.roll = std::max(pointing_prior_.roll, camera.rotation);
      pointing_prior_.scale = std::max(pointing_prior_.scale, std::hypot(camera.focal, moved));
    }
  }

  std::size_t markers() const override { return count_; }
  // Identifies the markers by the rig found before, if any. If that fails, by the initial guess, and then
  // with the markers of one camera or both shifted to other identities.
  RigReading read(const RigModel* found) const override {
    std::vector<RigReading> readings;
    if (found != nullptr) readings.push_back(read_as(*found, of_found, {0, 0}));
    constexpr std::array<std::array<std::size_t, 2>, 6> ranks = {
        {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}}};
    for (const auto& rank : ranks) {
      if (!readings.empty() && readings.back().is_whole()) break;
      readings.push_back(read_as(nominal_, pointing_prior_, rank));
    }
    return best_of(readings);
  }
  RigImage image_of_observed(const RigModel& /*model*/, const CameraObservation& observed) const override {
    return {.stance = 0, .pose = 0, .markers = observed.seen.markers, .points = observed.seen.points};
  }

 private:
  std::vector<ArmState>& poses() override { return rig_pictures_.poses; }
  std::vector<RigStance>& stances() override { return rig_pictures_.stances; }
  bool look(std::size_t i, const Picture& picture) override {
    figure_ = pictures_[i].look(picture);
    // A single marker could be any of them.
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
    rig_pictures_.looks.push_back({.stance = stance, .pose = pose, .arm = std::move(figure_)});
    const MarkerMatch match =
        rig_pictures_.recognise_last(model(found), found != nullptr ? of_found : pointing_prior_);
    return rig_pictures_.seen(model(found), rig_pictures_.looks.size() - 1, match);
  }

  // Identifies the markers again with each rig that is found, until nothing changes or the rounds are used
  // up. Returns the round that explains most.
  [[nodiscard]] RigReading read_as(const RigModel& first, const PointingPrior& pointing_prior,
                                   const std::array<std::size_t, 2>& rank) const {
    RigReading best;
    std::vector<MarkerMatch> matches = rig_pictures_.recognise(first, pointing_prior, rank);
    RigModel model = first;
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round) {
      RigReading now;
      now.problem.emplace(nominal_, prior_,
                          rig_pictures_.observations(model, matches, round == 0 ? config_.fewest : few));
      now.found = calibrate_rig(*now.problem);
      rate(matches, now);
      const bool is_found = now.found.is_found;
      if (is_found) model = now.found.model;
      if (round == 0 || (is_found && now.explained >= best.explained)) best = std::move(now);
      if (!is_found) break;
      std::vector<MarkerMatch> again = rig_pictures_.recognise(model, of_found);
      // The first round leaves out pictures with few markers.
      if (round > 0 && again == matches) break;
      matches = std::move(again);
    }
    return best;
  }

  // One camera alone determines nothing.
  void rate(const std::vector<MarkerMatch>& matches, RigReading& reading) const {
    double unknown = 0;
    std::vector<std::size_t> images(nominal_.cameras.size(), 0);
    for (const RigImage& image : reading.problem->observations().images) {
      reading.things += static_cast<double>(image.things());
      ++images[rig_pictures_.stances[image.stance].camera];
    }
    for (const std::size_t camera : config_.cameras) {
      if (images[camera] > 0 || !reading.found.is_found) continue;
      reading.found.is_found = false;
      reading.found.reason = fmt::format("no markers were identified in the pictures of camera {}",
                                         nominal_.cameras[camera].name);
    }
    for (std::size_t i = 0; i < matches.size(); ++i)
      unknown += static_cast<double>(markers_of(rig_pictures_.looks[i].arm.scene)) -
                 static_cast<double>(matches[i].count);
    const auto outlier_count = static_cast<double>(reading.found.outliers.size());
    reading.unexplained = outlier_count + unknown;
    reading.explained = reading.things - 2 * outlier_count - unknown;
  }

  const RigPrior& prior_;
  const RigSessionConfig& config_;
  // Errors of the initial guess of the cameras.
  PointingPrior pointing_prior_ = {.sideways = 0.01, .roll = 0.01, .scale = 0.01};
  std::vector<ArmPicture> pictures_;  // One per camera.
  RigPictures rig_pictures_;
  ArmFigure figure_;  // The last one.
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<RigObserver> arm_observer(const RigModel& nominal, const RigPrior& prior,
                                          const RigSessionConfig& config, const Eigen::Vector3d& target) {
  return std::make_unique<ArmObserver>(nominal, prior, config, target);
}

}  // namespace flexura
