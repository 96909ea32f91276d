#include "flexura/view/branch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "flexura/base/source.h"
#include "flexura/model/arm_difference.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

ShapeConfig shape_of_start(const ArmState& state) {
  ShapeConfig shape;
  shape.bends.emplace();
  for (const auto& bend : state.bends) shape.bends->push_back({bend.x(), bend.y()});
  if (std::ranges::any_of(state.stretches, [](double stretch) { return stretch != 1; }))
    shape.stretches = state.stretches;
  return shape;
}

CameraStartConfig start_of_camera(const CameraStance& stance) {
  const Eigen::Vector3d& stage = stance.stage.offset;
  return {stance.head.pan, stance.head.tilt, stance.head.zoom, {stage.x(), stage.y(), stage.z()}};
}

void start_arm_at(const ArmState& state, Experiment& experiment) {
  const ArmDifference off =
      minus(ArmSetup(experiment.true_rig()).initial, ArmSetup(experiment.model_rig()).initial);
  experiment.arm.initial = shape_of_start(state);
  if (experiment.truth && experiment.truth->arm)
    experiment.truth->arm->initial = shape_of_start(plus(state, off));
}

void start_cameras_at(const Recording& recording, double time, Experiment& experiment) {
  const ViewedRig& rig = *recording.rig();
  std::vector<CameraConfig> models = experiment.cameras();
  bool is_moved = false;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const CameraStance stance = recording.stance(i, time);
    if (stance == rig.first_stance(i)) continue;
    is_moved = true;
    const CameraReading reading = rig.reading(i, stance);
    models[i].initial = start_of_camera({reading.head, reading.stage});
    if (experiment.truth && !experiment.truth->camera.empty())
      experiment.truth->camera.at(i).initial = start_of_camera(stance);
  }
  if (!is_moved) return;
  experiment.camera = std::move(models);
  // The cameras are now written out.
  experiment.stand.camera_distances.reset();
  if (experiment.truth && experiment.truth->stand) experiment.truth->stand->camera_distances.reset();
}

}  // namespace

Experiment experiment_from(const Recording& recording, double time) {
  Experiment experiment = recording.rig()->experiment;
  const std::size_t place = recording.state_at(time);
  const double start = recording.time_of_state(place);
  start_arm_at(recording.state(place), experiment);
  start_cameras_at(recording, start, experiment);
  experiment.title = fmt::format("{} (from {:.4g} s)", experiment.title, start);
  // A start that no file may have is refused here, and not when the results of a run are opened.
  try {
    Experiment checked = parse_experiment(experiment_toml(experiment), "");
    checked.folder = experiment.folder;
    return checked;
  } catch (const InputError& error) {
    throw ViewRefusal(fmt::format("no rig can start at {:.4g} s: {}", start, error.problems().front().what));
  }
}

}  // namespace flexura
