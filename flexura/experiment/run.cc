#include "flexura/experiment/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "flexura/base/version.h"
#include "flexura/experiment/drive_commands.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/recorder.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/schedule.h"
#include "flexura/model/backbone.h"
#include "flexura/report/report.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

Node tip_at(const Arm& arm, const Schedule& schedule, double time) {
  return pose_node(Backbone(arm, schedule.state_at(time)).tip());
}

Node task_nodes(const Experiment& experiment, const Arm& arm, const Schedule& schedule) {
  Node::Array tasks;
  for (std::size_t i = 0; i < experiment.task.size(); ++i) {
    const Leg& leg = schedule.legs()[i];
    const double end = leg.end();
    tasks.push_back(
        {Node::Table{{"kind", {}, {leg.kind, {}}},
                     {"name", {}, {leg.name, {}}},
                     {"start", {}, {leg.start, {}}},
                     {"end", {}, {end, {}}},
                     {"tip", {}, pose_node(Backbone(arm, leg.motion->at(leg.motion->duration())).tip())}},
         {}});
  }
  return {std::move(tasks), {}};
}

Node reason_nodes(const std::vector<std::string>& reasons) {
  Node::Array lines;
  for (const std::string& reason : reasons) lines.push_back({reason, {}});
  return {std::move(lines), {}};
}

Node summary_of(const Experiment& experiment, const Arm& arm, const Schedule& schedule,
                const RunResult& result) {
  const bool done = result.outcome == Outcome::done;
  const double end = done ? schedule.duration() : 0.0;
  Node::Table summary{{"flexura", {}, {experiment.flexura, {}}},
                      {"title", {}, {experiment.title, {}}},
                      {"outcome", {}, {std::string(done ? "done" : "unsafe"), {}}},
                      {"reasons", {}, reason_nodes(result.reasons)},
                      {"seed", {}, {experiment.seed, {}}},
                      {"duration", {}, {end, {}}},
                      {"steps", {}, {static_cast<std::int64_t>(done ? schedule.steps() : 0), {}}},
                      {"sections", {}, {static_cast<std::int64_t>(arm.sections.size()), {}}},
                      {"length", {}, {arm.length(), {}}},
                      {"tip_at_start", {}, tip_at(arm, schedule, 0)},
                      {"tip", {}, tip_at(arm, schedule, end)}};
  if (done) summary.push_back({"tasks", {}, task_nodes(experiment, arm, schedule)});
  return {std::move(summary), {}};
}

// Everything the loop leaves behind while it runs: the log, and what the report will show.
class Witness {
 public:
  Witness(const std::filesystem::path& folder, const Arm& arm, const Schedule& schedule)
      : recorder_(folder / log_file_name, arm),
        arm_(arm),
        last_step_(schedule.steps()),
        kept_every_(schedule.steps() / max_kept_states + 1) {}

  void event(double time, Recorder::Level level, const std::string& name, const std::string& text) {
    recorder_.event(time, level, name, text);
    const char* kind = level == Recorder::Level::info      ? "info"
                       : level == Recorder::Level::warning ? "warning"
                                                           : "error";
    marks_.push_back({time, kind, name + ": " + text});
  }
  void state(std::size_t step, double time, const ArmState& state) {
    recorder_.state(time, state, Backbone(arm_, state));
    ++recorded_;
    if (step % kept_every_ != 0 && step != last_step_) return;
    times_.push_back(time);
    states_.push_back(state);
  }
  void write_commands(const Drive& drive, const std::filesystem::path& file) {
    commands_.emplace(arm_, drive, file);
  }
  // Takes every step, logged or not: a command list has no gaps.
  void command(double time, const ArmState& state) {
    if (commands_) commands_->step(time, state, recorder_);
  }
  void close() {
    recorder_.close();
    if (commands_) commands_->close();
  }

  ReportData report_data(const Experiment& experiment) && {
    return {experiment.title, experiment.flexura, experiment_toml(experiment),
            std::move(arm_),  std::move(times_),  std::move(states_),
            std::move(marks_)};
  }

 private:
  // The log has every state; the report draws no more than this, and a long run should not fill the memory.
  static constexpr std::size_t max_kept_states = 10000;

  Recorder recorder_;
  std::optional<DriveCommands> commands_;
  Arm arm_;
  std::size_t last_step_;
  std::size_t kept_every_;
  std::size_t recorded_ = 0;
  std::vector<double> times_;
  std::vector<ArmState> states_;
  std::vector<ReportData::Mark> marks_;
};

void play(const Experiment& experiment, const Schedule& schedule, Witness& witness, Progress& progress) {
  const auto every = static_cast<std::size_t>(experiment.record.every);
  std::size_t started = 0;  // legs whose start was told
  for (std::size_t step = 0; step <= schedule.steps(); ++step) {
    const double time = schedule.time_of_step(step);
    for (; started < schedule.legs().size() && schedule.legs()[started].start <= time; ++started) {
      const Leg& leg = schedule.legs()[started];
      witness.event(leg.start, Recorder::Level::info, leg.name, fmt::format("{} starts", leg.kind));
    }
    const ArmState state = schedule.state_at(time);
    if (step % every == 0 || step == schedule.steps()) witness.state(step, time, state);
    witness.command(time, state);
    progress.update(schedule.duration() > 0 ? time / schedule.duration() : 1.0,
                    schedule.legs()[schedule.leg_at(time)].name);
  }
  witness.event(schedule.duration(), Recorder::Level::info, "run", "done");
}

void write_report(const std::filesystem::path& folder, const ReportData& data) {
  write_new_file(folder / report_file_name, report_html(data));
  std::filesystem::create_directory(folder / figures_folder_name);
  for (const Figure& figure : report_figures(data)) {
    write_new_file(folder / figures_folder_name / figure.file_name, figure.svg);
  }
}

}  // namespace

RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder, Progress& progress) {
  Experiment experiment = as_read;
  experiment.flexura = version();
  if (experiment.task.empty())
    throw InputError(std::vector<Problem>{{{}, "nothing to do: expected at least one [[task]]"}});
  write_new_file(folder / experiment_file_name, experiment_toml(experiment));

  const Arm arm = experiment.arm.arm();
  const Schedule schedule(experiment);
  RunResult result;
  result.folder = folder;
  Witness witness(folder, arm, schedule);
  const SafetyReport safety = schedule.check();
  for (const Violation& violation : safety.violations) {
    result.outcome = Outcome::unsafe;
    result.reasons.push_back(violation.text());
    witness.event(0, Recorder::Level::error, "run", violation.text());
  }
  if (result.outcome == Outcome::done) {
    if (experiment.drive) witness.write_commands(experiment.drive->drive(), folder / commands_file_name);
    play(experiment, schedule, witness, progress);
  } else {
    witness.state(0, 0, schedule.state_at(0));
  }
  witness.close();
  result.summary = summary_of(experiment, arm, schedule, result);
  write_new_file(folder / summary_file_name, write_json(result.summary, 2) + "\n");
  if (experiment.record.report) write_report(folder, std::move(witness).report_data(experiment));
  return result;
}

}  // namespace flexura
