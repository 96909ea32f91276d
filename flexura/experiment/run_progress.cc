#include "flexura/experiment/run_progress.h"

#include <vector>

#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Returns the computing time of one simulated second, s, on a common machine.
double work_of_second(const Experiment& experiment) {
  constexpr double of_step = 2e-4, of_static_rod = 5e-3, of_pixel = 5e-7, of_moving_rod = 1;
  double of_each_step = of_step;
  if (experiment.true_rig().arm.mechanics != ArmMechanics::kinematic) of_each_step += of_static_rod;
  double work = of_each_step / experiment.clock.step;
  if (experiment.true_rig().arm.mechanics == ArmMechanics::dynamics) work += of_moving_rod;
  if (!experiment.record.cameras) return work;
  for (const CameraConfig& camera : experiment.cameras()) {
    const SensorConfig& sensor = camera.sensor;
    work += of_pixel * static_cast<double>(sensor.width * sensor.height) * sensor.frame_rate;
  }
  return work;
}

std::vector<double> weights_of(const Experiment& experiment, const TaskRunners& tasks) {
  constexpr double checks = 0.2, report = 0.3;  // In s.
  const double of_second = work_of_second(experiment);
  std::vector<double> weights = {checks, experiment.record.report ? report : 0};
  for (const auto& task : tasks) {
    const TaskWork work = task->work();
    weights.insert(weights.end(),
                   {work.simulating, work.performing + of_second * work.duration, work.finishing});
  }
  return weights;
}

}  // namespace

RunProgress::RunProgress(Progress& whole, const Experiment& experiment, const TaskRunners& tasks)
    : work_(whole, weights_of(experiment, tasks)) {}

}  // namespace flexura
