#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/kinematics/motion.h"
#include "flexura/log/logged_message.h"
#include "flexura/safety/motion_check.h"
#include "flexura/store/csv.h"
#include "flexura/tasks/dynamics/dynamics_messages.h"
#include "flexura/tasks/dynamics/dynamics_results.h"
#include "flexura/tasks/dynamics/dynamics_run.h"
#include "flexura/tasks/dynamics/dynamics_task_config.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Returns the expected motion before the simulation: straight to its target.
MotionPtr straight_path(const DynamicsTask& task, const Arm& arm, const ArmState& from) {
  if (!is_possible(from)) return hold_motion(from, task.duration);
  const DynamicsPlant plant(task, arm, from);
  return keyframe_motion({0, task.duration}, {from, plant.state(plant.target(), from)},
                         Interpolation::linear);
}

// Returns the diameter of an arm's thickest section, m.
double thickness_of(const Arm& arm) {
  double thickness = 0;
  for (const Section& section : arm.sections)
    thickness = std::max({thickness, 2 * section.radius[0], 2 * section.radius[1]});
  return thickness;
}

class DynamicsRunner : public TaskRunner {
 public:
  DynamicsRunner(const DynamicsTask& task, const Setup& setup, TaskLabel label)
      : TaskRunner(setup, std::move(label)), task_(task) {}

  [[nodiscard]] TaskMotionSource motion_source() const override { return TaskMotionSource::simulated; }
  [[nodiscard]] TaskWork work() const override {
    constexpr double of_second = 0.1;  // In s.
    return {.duration = task_.duration, .simulating = of_second * task_.duration};
  }
  [[nodiscard]] TaskPlan plan(const ArmState& from, const MotionPtr& done) const override {
    return {.motion = done ? done : straight_path(task_, setup().arm.arm(), from)};
  }
  [[nodiscard]] TaskEnd simulate(const ArmState& from, double start, Progress& progress) override {
    run_ = run_dynamics(task_, label(), setup(), from, start, progress);
    return {run_->motion, run_->is_done() ? std::nullopt : std::optional(run_->reason())};
  }

  // Adds a caveat if the checked arcs are farther from the arm than its thickness. For a task that was not
  // simulated, adds the reason and the violated conditions of the theory.
  void add_caveats(const ArmState& from, const std::string& ended_by, SafetyReport& report) const override {
    const Arm arm = setup().arm.arm();
    if (run_) {
      if (run_->apart > thickness_of(arm))
        report.caveats.push_back(
            fmt::format("{}: the check approximates the arm by arcs, with an error of up to {:.3g} m at the "
                        "tip, because the sections bend out of a plane",
                        name(), run_->apart));
      return;
    }
    report.caveats.push_back(fmt::format(
        "{}: only a straight path to the target is checked: {}", name(),
        ended_by.empty()
            ? "the motion is simulated only after the previous tasks"
            : fmt::format("the motion is not simulated, because the run ends with {}", ended_by)));
    if (!is_possible(from)) return;
    const DynamicsPlant plant(task_, arm, from);
    for (const std::string& violation : theory_violations(task_, plant, potential_law_of(task_, plant)))
      report.notes.push_back(fmt::format("{}: {}", name(), violation));
  }

  // Logs the first and the last sample, and the current one at each time of the log.
  void publish_up_to(double time, RunLog& log) override {
    if (!run_) return;
    const std::size_t count = run_->samples.size();
    const auto is_past = [&](std::size_t i) {
      constexpr double same_time = 1e-9;  // In s.
      return run_->start + run_->samples[i].energies.time <= time + same_time;
    };
    for (; reported_ < count && is_past(reported_); ++reported_) {
      const bool is_end = reported_ == 0 || reported_ + 1 == count;
      if (!is_end && is_past(reported_ + 1)) continue;
      const DynamicsSampleMessage message = run_->message(run_->samples[reported_]);
      log.publish({dynamics_samples_topic, message.time, message});
    }
  }

  [[nodiscard]] TaskOutcome outcome(const Motion& /*motion*/) const override {
    return run_ ? dynamics_outcome(*run_) : not_begun(name(), "dynamics", "law", "agree with the theory");
  }
  [[nodiscard]] std::string_view summary_list() const override { return "dynamics"; }
  [[nodiscard]] std::optional<Node> summary() const override {
    return run_ ? std::optional(dynamics_node(*run_)) : std::nullopt;
  }
  [[nodiscard]] std::optional<Chapter> chapter(std::size_t number) const override {
    return run_ ? std::optional(dynamics_chapter(*run_, number)) : std::nullopt;
  }

 private:
  const DynamicsTask& task_;
  std::optional<DynamicsRun> run_;
  std::size_t reported_ = 0;  // Number of samples logged.
};

// Omits the positions along the arm, which the log has.
class DynamicsTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "dynamics.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == dynamics_samples_topic; }
  void add(std::string_view /*topic*/, double /*time*/, const Node& message) override {
    const auto sample = read_as<DynamicsSampleMessage>(message);
    if (csv_.text().empty()) name_columns();
    csv_.cells(std::array{sample.time, sample.kinetic_energy, sample.gravity_energy, sample.elastic_energy,
                          sample.potential, sample.lyapunov, sample.taken_by_law, sample.taken_by_medium,
                          sample.azimuth_error, sample.elevation_error, sample.spatial_error,
                          sample.tip_error});
    if (sample.points.empty())
      throw std::runtime_error(fmt::format("the log's dynamics sample at {} s has no points", sample.time));
    csv_.cells(sample.points.back());
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  void name_columns() {
    for (const char* title : {"time", "kinetic_energy", "gravity_energy", "elastic_energy", "potential",
                              "lyapunov", "taken_by_law", "taken_by_medium", "azimuth_error",
                              "elevation_error", "spatial_error", "tip_error", "tip_x", "tip_y", "tip_z"})
      csv_.cell(std::string_view(title));
    csv_.end_row();
  }
  CsvText csv_;
};

}  // namespace

std::unique_ptr<TaskRunner> runner_of(const DynamicsTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<DynamicsRunner>(task, setup, std::move(label));
}

LogTables log_tables(const DynamicsTask*) {
  LogTables tables;
  tables.push_back(std::make_unique<DynamicsTable>());
  return tables;
}

}  // namespace flexura
