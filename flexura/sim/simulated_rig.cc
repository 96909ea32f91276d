#include "flexura/sim/simulated_rig.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

ArmSetup true_arm(const RigConfig& model, const RigConfig& truth) {
  if (const std::string problem = truth_problem(model, truth); !problem.empty())
    throw std::invalid_argument(problem);
  return ArmSetup(truth);
}

// How far back the slowest camera may look.
double horizon_of(const std::vector<CameraConfig>& cameras) {
  double horizon = 0;
  for (const CameraConfig& camera : cameras) horizon = std::max(horizon, frame_horizon(camera.sensor));
  return horizon;
}

Shot with_view(Shot shot, std::function<View(double)> view) {
  shot.view = std::move(view);
  return shot;
}

}  // namespace

SimulatedView::SimulatedView(const CameraConfig& nominal, const CameraConfig& config, Shot shot,
                             const TakePicture& take_picture, SimulatedClock& clock, double horizon)
    : description_(config),
      head_(description_, Camera(nominal).initial_head(), clock, horizon),
      stage_(description_, Camera(nominal).initial_stage(), clock, horizon),
      camera_(description_, with_view(std::move(shot), [this](double time) { return view(time); }),
              take_picture, clock) {}

SimulatedRig::SimulatedRig(const RigConfig& model, const RigConfig& truth, const TakePicture& take_picture,
                           std::uint64_t seed, const MakePlant& make_plant)
    : arm_(ArmSetup(model), true_arm(model, truth), clock_, horizon_of(truth.cameras), make_plant) {
  clock_.when_passed([this](double now) { arm_.plant().advance(now); });
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    Shot shot;
    shot.camera = i;
    shot.seed = seed;
    shot.backbone = [this](double time) { return arm_.backbone(time); };
    cameras_.push_back(std::make_unique<SimulatedView>(model.cameras[i], truth.cameras[i], std::move(shot),
                                                       take_picture, clock_, horizon_of(truth.cameras)));
  }
}

RigPorts SimulatedRig::ports() {
  RigPorts ports{&clock_, &arm_, {}};
  for (const auto& camera : cameras_) ports.cameras.push_back(camera->ports());
  return ports;
}

}  // namespace flexura
