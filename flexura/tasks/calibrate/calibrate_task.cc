#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm_model.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_run.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Returns a motion with every possible way of a calibration once: out to each pose and back.
MotionPtr tour_of(const CalibrateTask& task, const ArmModel& arm, const ArmState& from) {
  if (is_before_etalon(task)) return hold_motion(from, 0);  // The arm is absent.
  std::vector<double> times = {0};
  std::vector<ArmState> states = {from};
  for (const ArmState& pose : calibration_poses(task, arm.driven())) {
    for (const ArmState* next : {&pose, &from}) {
      times.push_back(times.back() + task.move_duration);
      states.push_back(*next);
    }
  }
  return keyframe_motion(std::move(times), states, Interpolation::linear);
}

// Updates the model with a rig, or with principal points only from a loop. Those replace the file's, but not
// those of a calibrated rig.
void learn(const CalibrationRun& run, NominalRig& nominal) {
  const RigModel found = run.found();
  if (!run.loop) nominal.model = found, nominal.is_found = true;
  for (std::size_t i = 0; run.loop && !nominal.is_found && i < 2; ++i) {
    const std::size_t camera = run.loop->stances[i].camera;
    if (run.loop->principal_point[i]) nominal.model.cameras[camera] = found.cameras[camera];
  }
}

class CalibrateRunner : public TaskRunner {
 public:
  CalibrateRunner(const CalibrateTask& task, const Setup& setup, TaskLabel label)
      : TaskRunner(setup, std::move(label)), task_(task) {}

  [[nodiscard]] TaskMotionSource motion_source() const override { return TaskMotionSource::by_rig; }
  [[nodiscard]] TaskWork work() const override {
    constexpr double of_look = 2;  // In s.
    return {.performing = of_look * static_cast<double>(most_images(task_))};
  }
  [[nodiscard]] TaskPlan plan(const ArmState& from, const MotionPtr& done) const override {
    return {.motion = done ? done : tour_of(task_, setup().arm_model(), from)};
  }
  [[nodiscard]] TaskEnd perform(const ArmState& from, TaskStage& stage) override {
    run_ = run_calibration(task_, name(), setup(), from, stage);
    if (run_->is_done()) learn(*run_, stage.nominal);
    return {run_->motion, run_->is_done() ? std::nullopt : std::optional(run_->reason())};
  }

  void finish(const std::filesystem::path& results, bool /*is_cancelled*/, Progress& /*progress*/) override {
    if (run_ && run_->is_done() && !results.empty()) write_rig_file(setup(), *run_, task_.save, results);
  }
  [[nodiscard]] TaskOutcome outcome(const Motion& /*motion*/) const override {
    return run_ ? calibration_outcome(*run_) : not_begun(name(), "calibrate", "calibration", "reached");
  }
  [[nodiscard]] std::string_view summary_list() const override { return "calibrations"; }
  [[nodiscard]] std::optional<Node> summary() const override {
    return run_ ? std::optional(calibration_node(*run_)) : std::nullopt;
  }
  [[nodiscard]] std::optional<Chapter> chapter(std::size_t number) const override {
    return run_ ? std::optional(calibration_chapter(*run_, number)) : std::nullopt;
  }

 private:
  const CalibrateTask& task_;
  std::optional<CalibrationRun> run_;
};

}  // namespace

std::unique_ptr<TaskRunner> runner_of(const CalibrateTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<CalibrateRunner>(task, setup, std::move(label));
}

}  // namespace flexura
