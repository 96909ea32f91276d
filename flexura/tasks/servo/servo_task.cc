#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/kinematics/motion.h"
#include "flexura/math/arrays.h"
#include "flexura/model/arm_model.h"
#include "flexura/rig/setup.h"
#include "flexura/servo/servo_step.h"
#include "flexura/store/csv.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/tasks/servo/servo_results.h"
#include "flexura/tasks/servo/servo_run.h"
#include "flexura/tasks/servo/servo_target.h"
#include "flexura/tasks/servo/servo_task_config.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Returns a slow, straight motion to each target.
MotionPtr way_to(const std::vector<std::optional<ServoTargetShape>>& shapes, const Arm& arm,
                 const ArmState& from) {
  // In s per target. Slower sections take longer, because the limiter keeps their rates. A smooth motion is
  // at most three times as fast as its mean.
  constexpr double slow = 10, faster = 3;
  const auto lasts = [&](const ArmState& a, const ArmState& b) {
    double duration = slow;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const double bending = (b.bends[i] - a.bends[i]).norm(),
                   stretching = std::abs(b.stretches[i] - a.stretches[i]);
      duration = std::max({duration, faster * bending / arm.sections[i].max_bend_rate,
                           faster * stretching / arm.sections[i].max_stretch_rate});
    }
    return duration;
  };
  std::vector<double> times = {0};
  std::vector<ArmState> states = {from};
  for (const auto& shape : shapes) {
    if (!shape) continue;  // Not known yet.
    times.push_back(times.back() + lasts(states.back(), shape->state));
    states.push_back(shape->state);
  }
  if (times.size() < 2) return hold_motion(from, 0);
  return keyframe_motion(std::move(times), states, Interpolation::smooth);
}

class ServoRunner : public TaskRunner {
 public:
  ServoRunner(const ServoTask& task, const Setup& setup, TaskLabel label)
      : TaskRunner(setup, std::move(label)), task_(task) {}

  [[nodiscard]] TaskMotionSource motion_source() const override { return TaskMotionSource::by_rig; }
  [[nodiscard]] TaskWork work() const override {
    constexpr double of_second = 5;  // In s.
    return {.performing = of_second * expected_duration(task_)};
  }

  // Includes the targets whose nearest shape of the arm is too far away.
  [[nodiscard]] TaskPlan plan(const ArmState& from, const MotionPtr& done) const override {
    const ArmModel arm = setup().arm_model();
    const auto shapes = servo_target_shapes(task_, arm, from);
    TaskPlan plan{.motion = done ? done : way_to(shapes, arm.driven(), from),
                  .is_steered = true,
                  .is_planned = done != nullptr};
    const double length = arm.driven().length();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (!shapes[i] || shapes[i]->missed <= task_.tolerance) continue;
      const auto& position = task_.target[i].position;
      plan.missed.push_back({.place = fmt::format("target[{}]", i),
                             .distance = shapes[i]->missed * length,
                             .limit = task_.tolerance * length,
                             .position = position ? std::optional(vector(*position)) : std::nullopt});
    }
    return plan;
  }

  [[nodiscard]] TaskEnd perform(const ArmState& from, TaskStage& stage) override {
    run_ = run_servo(task_, name(), setup(), from, stage);
    return {run_->motion, run_->result.is_done ? std::nullopt : std::optional(run_->result.reason)};
  }

  void add_caveats(const ArmState& /*from*/, const std::string& /*ended_by*/,
                   SafetyReport& report) const override {
    if (!run_)
      report.caveats.push_back(
          fmt::format("{}: only a slow straight path to the targets is checked now. The servo chooses the "
                      "actual path during the run, where each command is checked against all limits",
                      name()));
  }

  [[nodiscard]] TaskOutcome outcome(const Motion& /*motion*/) const override {
    return run_ ? servo_outcome(*run_) : not_begun(name(), "servo", "servo", "converged");
  }
  [[nodiscard]] std::string_view summary_list() const override { return "servos"; }
  [[nodiscard]] std::optional<Node> summary() const override {
    return run_ ? std::optional(servo_node(*run_)) : std::nullopt;
  }
  [[nodiscard]] std::vector<ReportSpace::Target> targets(const Motion& motion) const override {
    return run_ ? servo_targets(*run_, motion.duration()) : std::vector<ReportSpace::Target>();
  }
  [[nodiscard]] std::optional<Chapter> chapter(std::size_t number) const override {
    return run_ ? std::optional(servo_chapter(*run_, number)) : std::nullopt;
  }

 private:
  const ServoTask& task_;
  std::optional<ServoRun> run_;
};

// Omits the shapes, which the log has.
class ServoTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "servo.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == servo_steps_topic; }
  void add(std::string_view /*topic*/, double /*time*/, const Node& message) override {
    const auto step = read_as<ServoStep>(message);
    if (csv_.text().empty()) name_columns();
    csv_.cell(step.time);
    add_cells(std::array{step.seen_at.value_or(0)}, step.seen_at.has_value());
    add_error(step.error);
    add_error(step.truth ? std::optional(step.truth->error) : std::nullopt);
    csv_.cell(step.potential);
    csv_.cell(std::string_view(step.limited));
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  void name_columns() {
    for (const char* title : {"time", "seen_at", "rms", "most", "tip", "true_rms", "true_most", "true_tip",
                              "potential", "limited"})
      csv_.cell(std::string_view(title));
    csv_.end_row();
  }
  template <std::size_t Count>
  void add_cells(const std::array<double, Count>& numbers, bool are_known) {
    for (const double number : numbers) are_known ? csv_.cell(number) : csv_.cell(std::string_view());
  }
  void add_error(const std::optional<ServoError>& error) {
    const ServoError known = error.value_or(ServoError{});
    add_cells(std::array{known.rms, known.most, known.tip}, error.has_value());
  }
  CsvText csv_;
};

}  // namespace

void read_files(ServoTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  const auto [first, second] = servo_cameras(task, cameras);
  for (std::size_t i = 0; i < task.target.size(); ++i) {
    if (task.target[i].pictures.empty()) continue;
    try {
      (void)recorded_views(task.target[i], {cameras[first], cameras[second]}, setup.folder);
    } catch (const InputError& error) {
      const Node& target = written.find("target")->as<Node::Array>()->at(i);
      for (const Problem& problem : error.problems())
        problems.push_back(
            {target.find("pictures")->where,
             fmt::format("{}.target[{}].pictures: {}{}", path, i,
                         problem.where.source ? *problem.where.source + ": " : "", problem.what)});
    }
  }
}

std::unique_ptr<TaskRunner> runner_of(const ServoTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<ServoRunner>(task, setup, std::move(label));
}

LogTables log_tables(const ServoTask*) {
  LogTables tables;
  tables.push_back(std::make_unique<ServoTable>());
  return tables;
}

}  // namespace flexura
