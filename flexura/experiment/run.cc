#include "flexura/experiment/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/base/version.h"
#include "flexura/camera/camera.h"
#include "flexura/experiment/drive_commands.h"
#include "flexura/experiment/filming.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/recorder.h"
#include "flexura/experiment/report_safety.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/safety_nodes.h"
#include "flexura/experiment/schedule.h"
#include "flexura/experiment/study_results.h"
#include "flexura/model/backbone.h"
#include "flexura/port/rig_ports.h"
#include "flexura/report/report.h"
#include "flexura/safety/motion_check.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

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

// Each camera, what it gave, and how it is turned about its optical axis: a head cannot correct that.
Node camera_nodes(const std::vector<CameraConfig>& cameras,
                  const std::map<std::string, std::int64_t>& frames) {
  Node::Array list;
  for (const CameraConfig& config : cameras) {
    const Camera camera(config);
    const auto roll = roll_of(camera.pose(camera.initial_stage(), camera.initial_head()).rotation);
    Node::Table entry{{"name", {}, {config.name, {}}}};
    if (roll) entry.push_back({"roll", {}, {*roll, {}}});
    const auto count = frames.find(config.name);
    entry.push_back({"frames", {}, {count == frames.end() ? std::int64_t{0} : count->second, {}}});
    list.push_back({std::move(entry), {}});
  }
  return {std::move(list), {}};
}

// How far a run came.
struct Played {
  std::size_t states = 0;  // of the clock's steps, from time 0
  double time = 0;         // of the last one, s
  ArmState last;
};

Node summary_of(const Experiment& experiment, const Arm& arm, const Schedule& schedule,
                const SafetyReport& safety, const Played& played, const RunResult& result) {
  const bool done = result.outcome == RunOutcome::done;
  Node::Table summary{
      {"flexura", {}, {experiment.flexura, {}}},
      {"title", {}, {experiment.title, {}}},
      {"outcome", {}, {std::string(done ? "done" : "unsafe"), {}}},
      {"reasons", {}, reason_nodes(result.reasons)},
      {"seed", {}, {experiment.seed, {}}},
      {"duration", {}, {played.time, {}}},
      {"steps", {}, {static_cast<std::int64_t>(std::max<std::size_t>(played.states, 1) - 1), {}}},
      {"sections", {}, {static_cast<std::int64_t>(arm.sections.size()), {}}},
      {"length", {}, {arm.length(), {}}},
      {"tip_at_start", {}, pose_node(Backbone(arm, schedule.initial()).tip())},
      {"tip", {}, pose_node(Backbone(arm, played.last).tip())}};
  if (played.states > schedule.steps())
    summary.push_back({"tasks", {}, task_nodes(experiment, arm, schedule)});
  const Node found = safety_node(safety);
  for (const char* list : {"violations", "caveats", "notes"})
    summary.push_back({list, {}, *found.find(list)});
  return {std::move(summary), {}};
}

const char* name_of(Recorder::Level level) {
  if (level == Recorder::Level::info) return "info";
  return level == Recorder::Level::warning ? "warning" : "error";
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
    marks_.push_back({time, name_of(level), name + ": " + text});
  }
  void state(std::size_t step, double time, const ArmState& state) {
    recorder_.state(time, state, Backbone(arm_, state));
    ++recorded_;
    if (step % kept_every_ != 0 && step != last_step_) return;
    times_.push_back(time);
    states_.push_back(state);
  }
  void image(const std::string& camera, const Frame& frame) {
    recorder_.image(camera, frame);
    ++frames_[camera];
  }
  // What the devices of the rig say of themselves.
  void readings(const RigPorts& rig) {
    recorder_.reading(rig.arm->read().value());
    for (const CameraPorts& camera : rig.cameras) recorder_.reading(camera.name, camera.head->read().value());
  }
  // Of each camera that gave any.
  [[nodiscard]] const std::map<std::string, std::int64_t>& frames() const { return frames_; }
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

  ReportData report_data(const Experiment& experiment, const Schedule& schedule,
                         const SafetyReport& safety) && {
    ReportData data{.title = experiment.title,
                    .version = experiment.flexura,
                    .experiment_text = experiment_toml(experiment),
                    .arm = std::move(arm_),
                    .times = std::move(times_),
                    .states = std::move(states_),
                    .events = std::move(marks_),
                    .recorded = recorded_,
                    .safety = {},
                    .obstacles = experiment.obstacle,
                    .curve = experiment.record.curve,
                    .tension = experiment.record.tension,
                    .chapters = {}};
    add_safety(safety, schedule, data);
    return data;
  }

 private:
  // The log has every state; the report draws no more than this, and a long run should not fill the memory.
  static constexpr std::size_t max_kept_states = 10000;

  Recorder recorder_;
  std::optional<DriveCommands> commands_;
  std::map<std::string, std::int64_t> frames_;  // by camera
  Arm arm_;
  std::size_t last_step_;
  std::size_t kept_every_;
  std::size_t recorded_ = 0;
  std::vector<double> times_;
  std::vector<ArmState> states_;
  std::vector<ReportData::Mark> marks_;
};

// What is told at its time while the run plays, in the order of time.
class Events {
 public:
  Events(const Schedule& schedule, const SafetyReport& safety) {
    for (const Leg& leg : schedule.legs())
      add(leg.start, Recorder::Level::info, leg.name, fmt::format("{} starts", leg.kind));
    for (const Violation& violation : safety.violations)
      add(violation.start, Recorder::Level::error, "unsafe", violation.text());
    std::ranges::sort(events_, {}, [](const Event& event) { return std::pair(event.time, event.place); });
  }
  void tell_up_to(double time, Witness& witness) {
    for (; told_ < events_.size() && events_[told_].time <= time; ++told_) {
      const Event& event = events_[told_];
      witness.event(event.time, event.level, event.name, event.text);
    }
  }

 private:
  struct Event {
    double time;
    std::size_t place;  // among those of one time
    Recorder::Level level;
    std::string name;
    std::string text;
  };
  void add(double time, Recorder::Level level, const std::string& name, const std::string& text) {
    events_.push_back({time, events_.size(), level, name, text});
  }
  std::vector<Event> events_;
  std::size_t told_ = 0;
};

// Plays every step, or those before the first state that no arm can take.
Played play(const Experiment& experiment, const Schedule& schedule, const SafetyReport& safety,
            Witness& witness, Progress& progress) {
  const auto every = static_cast<std::size_t>(experiment.record.every);
  Played played{0, 0, schedule.initial()};
  Events events(schedule, safety);
  std::optional<Filming> filming;
  if (experiment.record.cameras) filming.emplace(experiment);
  for (std::size_t step = 0; step <= schedule.steps(); ++step) {
    const double time = schedule.time_of_step(step);
    events.tell_up_to(time, witness);
    const ArmState state = schedule.state_at(time);
    if (!is_possible(state)) break;
    if (filming) {
      filming->play_to(time, state,
                       [&](const std::string& camera, const Frame& frame) { witness.image(camera, frame); });
    }
    if (step % every == 0 || step == schedule.steps()) {
      witness.state(step, time, state);
      if (filming) witness.readings(filming->ports());
    }
    witness.command(time, state);
    played = {step + 1, time, state};
    progress.update(schedule.duration() > 0 ? time / schedule.duration() : 1.0,
                    schedule.legs()[schedule.leg_at(time)].name);
  }
  if (played.states == 0) witness.state(0, 0, played.last);
  return played;
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
  for (const Violation& violation : safety.violations) result.reasons.push_back(violation.text());
  if (!safety.is_safe()) result.outcome = RunOutcome::unsafe;
  // Nobody should send motors where the arm would come to harm: an unsafe motion is simulated only.
  if (experiment.drive && safety.is_safe())
    witness.write_commands(experiment.drive->drive(), folder / commands_file_name);
  const Played played = play(experiment, schedule, safety, witness, progress);
  witness.event(played.time, Recorder::Level::info, "run", safety.is_safe() ? "done" : "unsafe");
  witness.close();
  result.summary = summary_of(experiment, arm, schedule, safety, played, result);
  if (experiment.record.cameras || !experiment.camera.empty()) {
    result.summary.as<Node::Table>()->push_back(
        {"cameras", {}, camera_nodes(experiment.cameras(), witness.frames())});
  }
  const std::vector<ImageStudy> studies = studies_of(experiment);
  write_study_tables(studies, folder);
  if (!studies.empty()) result.summary.as<Node::Table>()->push_back({"studies", {}, study_nodes(studies)});
  write_new_file(folder / summary_file_name, write_json(result.summary, 2) + "\n");
  if (experiment.record.report) {
    ReportData data = std::move(witness).report_data(experiment, schedule, safety);
    for (const ImageStudy& study : studies) data.chapters.push_back(study_chapter(study));
    write_report(folder, data);
  }
  return result;
}

}  // namespace flexura
