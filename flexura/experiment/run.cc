#include "flexura/experiment/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/version.h"
#include "flexura/camera/camera.h"
#include "flexura/experiment/player.h"
#include "flexura/experiment/run_outcomes.h"
#include "flexura/experiment/run_recorder.h"
#include "flexura/experiment/safety_nodes.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/messages.h"
#include "flexura/log/recorder.h"
#include "flexura/log/results.h"
#include "flexura/model/backbone.h"
#include "flexura/report/report.h"
#include "flexura/rig/seeing_config.h"
#include "flexura/safety/violation_groups.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

Node task_nodes(const Experiment& experiment, const ArmModel& arm, const Schedule& schedule) {
  Node::Array tasks;
  for (std::size_t i = 0; i < experiment.task.size(); ++i) {
    const Leg& leg = schedule.legs()[i];
    const double end = leg.end();
    tasks.push_back(
        {Node::Table{{"kind", {}, {leg.kind, {}}},
                     {"name", {}, {leg.name, {}}},
                     {"start", {}, {leg.start, {}}},
                     {"end", {}, {end, {}}},
                     {"tip", {}, pose_node(arm.backbone(leg.motion->at(leg.motion->duration())).tip())}},
         {}});
  }
  return {std::move(tasks), {}};
}

// Returns each camera with its frames and its roll about the optical axis, which a head cannot correct.
Node camera_nodes(const std::vector<CameraConfig>& cameras,
                  const std::map<std::string, std::int64_t>& frames) {
  Node::Array list;
  for (const CameraConfig& config : cameras) {
    const Camera camera(config);
    const auto roll = roll_of(camera.pose(camera.initial_stance()).rotation);
    Node::Table entry{{"name", {}, {config.name, {}}}};
    if (roll) entry.push_back({"roll", {}, {*roll, {}}});
    const auto count = frames.find(config.name);
    entry.push_back({"frames", {}, {count == frames.end() ? std::int64_t{0} : count->second, {}}});
    list.push_back({std::move(entry), {}});
  }
  return {std::move(list), {}};
}

Node summary_of(const Experiment& experiment, const ArmModel& arm, const Player& player, const Played& played,
                const RunResult& result) {
  const Schedule& schedule = player.schedule();
  Node::Table summary{
      {"flexura", {}, {experiment.flexura, {}}},
      {"title", {}, {experiment.title, {}}},
      {"outcome", {}, {std::string(name_of(result.outcome)), {}}},
      {"reasons", {}, texts_node(result.reasons)},
      {"headline", {}, {result.headline, {}}},
      {"outcomes", {}, outcomes_node(result.outcomes)},
      {"seed", {}, {experiment.seed, {}}},
      {"duration", {}, {played.time, {}}},
      {"steps", {}, {static_cast<std::int64_t>(std::max<std::size_t>(played.states, 1) - 1), {}}},
      {"sections", {}, {static_cast<std::int64_t>(arm.driven().sections.size()), {}}},
      {"length", {}, {arm.driven().length(), {}}},
      {"tip_at_start", {}, pose_node(arm.backbone(schedule.initial()).tip())},
      {"tip", {}, pose_node(arm.backbone(played.last).tip())}};
  if (played.states > schedule.steps() && played.failure.empty())
    summary.push_back({"tasks", {}, task_nodes(experiment, arm, schedule)});
  const Node found = safety_node(player.safety());
  for (const char* list : {"violation_count", "groups", "violations", "caveats", "notes"})
    summary.push_back({list, {}, *found.find(list)});
  return {std::move(summary), {}};
}

bool has_failed(const Played& played) { return !played.failure.empty() && !played.is_cancelled; }

// Sets the outcome of a run that did not finish, and the reason.
void conclude(const Played& played, RunResult& result) {
  if (has_failed(played)) result.outcome = RunOutcome::failed, result.reasons.push_back(played.failure);
  if (!played.is_cancelled) return;
  result.outcome = RunOutcome::cancelled;
  result.reasons.insert(result.reasons.begin(), fmt::format("the run was stopped at {:.6g} s", played.time));
}

// Adds the results of the tasks, kind by kind, in the order of the kinds.
void add_results(const Experiment& experiment, const TaskRunners& tasks, Node::Table& summary) {
  for (std::size_t kind = 0; kind < std::variant_size_v<TaskConfig>; ++kind) {
    Node::Array list;
    std::string name;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      if (experiment.task[i].index() != kind) continue;
      name = tasks[i]->summary_list();
      if (auto entry = tasks[i]->summary()) list.push_back(std::move(*entry));
    }
    if (!list.empty()) summary.push_back({name, {}, {std::move(list), {}}});
  }
}

// Adds the chapters in the order of the tasks.
void add_chapters(const Experiment& experiment, const TaskRunners& tasks, std::vector<Chapter>& chapters) {
  std::map<std::size_t, std::size_t> of_kind;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::size_t& number = of_kind[experiment.task[i].index()];
    if (auto chapter = tasks[i]->chapter(number)) chapters.push_back(std::move(*chapter)), ++number;
  }
}

// Returns the targets of the tasks that were performed.
std::vector<ReportSpace::Target> run_targets(const Player& player) {
  std::vector<DoneTask> done;
  const std::vector<Leg>& legs = player.schedule().legs();
  for (std::size_t i = 0; i < std::min(player.tasks().size(), legs.size()); ++i)
    done.push_back({*player.tasks()[i], legs[i].start, *legs[i].motion, legs[i].kind == "hold"});
  return targets_of(done);
}

void write_report(const std::filesystem::path& folder, const ReportData& data) {
  write_new_file(folder / report_file_name, report_html(data));
  std::filesystem::create_directory(folder / figures_folder_name);
  for (const FigureFile& figure : report_figures(data)) {
    write_new_file(folder / figures_folder_name / figure.file_name, figure.svg);
  }
}

}  // namespace

const char* name_of(RunOutcome outcome) {
  switch (outcome) {
    case RunOutcome::done:
      return "done";
    case RunOutcome::unsafe:
      return "unsafe";
    case RunOutcome::failed:
      return "failed";
    case RunOutcome::cancelled:
      break;
  }
  return "cancelled";
}

RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder, Progress& progress,
                         RunWatcher* watcher, const RigFactory& make_rig) {
  Experiment experiment = as_read;
  experiment.flexura = version();
  if (experiment.task.empty())
    throw InputError(std::vector<Problem>{{{}, "nothing to do: expected at least one [[task]]"}});
  const bool is_recorded = !folder.empty();
  if (is_recorded) {
    write_new_file(folder / experiment_file_name, experiment_toml(experiment));
    copy_seeing_files(experiment, folder);
  } else {
    experiment.record.scene = experiment.record.report = experiment.record.cameras = false;
  }

  const ArmModel arm = experiment.arm_model();
  RunResult result;
  result.folder = folder;
  RunRecorder run_recorder(folder, arm, watcher);
  if (experiment.drive) run_recorder.name_axes(experiment.drive->drive());
  if (experiment.record.scene) run_recorder.draw_scene(experiment);
  if (experiment.record.report) run_recorder.add_cameras(experiment);
  Player player(experiment, run_recorder, progress, watcher, make_rig);
  result.reasons = violation_lines(player.safety());
  const bool is_safe = player.safety().is_safe();
  if (!is_safe) result.outcome = RunOutcome::unsafe;
  // No motor commands for harmful motions: an unsafe motion is only simulated.
  if (experiment.drive && is_safe)
    run_recorder.write_commands(experiment.drive->drive(),
                                is_recorded ? folder / commands_file_name : folder);
  const Played played = player.play();
  // A task that decides its motion during the run may differ from the first check.
  const bool became_unsafe = is_safe && !player.safety().is_safe() && !has_failed(played);
  if (became_unsafe) result.outcome = RunOutcome::unsafe, result.reasons = violation_lines(player.safety());
  conclude(played, result);
  run_recorder.log().event(played.time, Recorder::Level::info, "run", name_of(result.outcome));
  run_recorder.close();
  if (became_unsafe && is_recorded) std::filesystem::remove(folder / commands_file_name);

  for (std::size_t i = 0; i < player.tasks().size(); ++i) {
    TaskRunner& task = *player.tasks()[i];
    task.finish(folder, played.is_cancelled, player.progress().results(i));
    player.progress().results(i).update(1, task.name());
  }
  result.outcomes = run_outcomes(player, played, run_recorder.true_tip_off(), run_recorder.first_warning(),
                                 run_recorder.log().frames());
  result.headline = headline_of(result.outcome, played.time, result.outcomes);
  result.summary = summary_of(experiment, arm, player, played, result);
  auto& summary = *result.summary.as<Node::Table>();
  if (experiment.record.cameras || !experiment.camera.empty())
    summary.push_back({"cameras", {}, camera_nodes(experiment.cameras(), run_recorder.log().frames())});
  add_results(experiment, player.tasks(), summary);
  if (is_recorded) write_new_file(folder / summary_file_name, write_json(result.summary, 2) + "\n");
  if (experiment.record.report && !played.is_cancelled) {
    player.progress().report().update(0, "writing the report");
    ReportData data = std::move(run_recorder).report_data(experiment, player.schedule(), player.safety());
    data.headline = result.headline;
    for (const TaskOutcome& outcome : result.outcomes)
      data.outcomes.push_back({outcome.task, outcome.text, outcome.is_reached});
    data.condition = name_of(result.outcome);
    if (!result.reasons.empty()) data.reason = result.reasons.front();
    data.space.targets = run_targets(player);
    add_chapters(experiment, player.tasks(), data.chapters);
    write_report(folder, data);
    player.progress().report().update(1, "writing the report");
  }
  return result;
}

}  // namespace flexura
