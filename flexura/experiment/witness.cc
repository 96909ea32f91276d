#include "flexura/experiment/witness.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "flexura/experiment/report_safety.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/results.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// The log has every state; the report draws no more than this, and a long run should not fill the memory.
constexpr std::size_t max_kept_states = 10000;

}  // namespace

Witness::Witness(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher)
    : log_(folder / log_file_name, model.driven(), watcher), model_(model) {}

void Witness::expect(std::size_t last_step) {
  last_step_ = last_step, kept_every_ = last_step / max_kept_states + 1;
}

void Witness::draw_scene(const Experiment& experiment) {
  const FramesMessage frames = frames_message(experiment);
  log_.recorder().write({frames_topic, 0, frames});
  const SceneMessage stand = stand_message(experiment);
  log_.recorder().write({scene_topic, 0, stand});
  drawn_color_ = experiment.arm.look.color;
}

void Witness::state(std::size_t step, double time, const ArmState& state) {
  const Backbone backbone = model_.backbone(state);
  log_.recorder().state(time, state, backbone);
  if (drawn_color_ && (scene_times_.is_next(time) || step == last_step_)) {
    const SceneMessage arm = arm_message(*drawn_color_, time, backbone);
    log_.recorder().write({scene_topic, time, arm});
  }
  ++recorded_;
  if (step % kept_every_ != 0 && step != last_step_) return;
  times_.push_back(time);
  states_.push_back(state);
}

void Witness::readings(Rig& rig) {
  // While a task waits for the rig, several steps of the clock are recorded at one time of the rig's.
  // Times that the log cannot tell apart are one.
  const RigPorts ports = rig.ports();
  const double now = ports.clock->now();
  const std::int64_t told = std::llround(now * 1e9);
  if (std::exchange(read_at_, told) == told) return;
  Recorder& recorder = log_.recorder();
  if (RigTruth* truth = rig.truth()) recorder.truth(now, truth->backbone(now));
  recorder.reading(ports.arm->read().value());
  for (const CameraPorts& camera : ports.cameras) {
    if (camera.head != nullptr) recorder.reading(camera.name, camera.head->read().value());
    if (camera.stage != nullptr) recorder.reading(camera.name, camera.stage->read().value());
  }
}

void Witness::write_commands(const Drive& drive, const std::filesystem::path& file) {
  commands_.emplace(model_.driven(), drive, file);
}

void Witness::command(double time, const ArmState& state) {
  if (commands_) commands_->step(time, state, log_.recorder());
}

std::optional<std::vector<std::int64_t>> Witness::motors_after(std::span<const ArmState> way) const {
  return commands_ ? std::optional(commands_->positions_after(way)) : std::nullopt;
}

void Witness::close() {
  log_.recorder().close();
  if (commands_) commands_->close();
}

ReportData Witness::report_data(const Experiment& experiment, const Schedule& schedule,
                                const SafetyReport& safety) && {
  std::vector<ReportData::Mark> marks;
  for (const RunLog::Event& event : log_.events())
    marks.push_back({event.time, event.level, event.name + ": " + event.text});
  ReportData data{.title = experiment.title,
                  .version = experiment.flexura,
                  .experiment_text = experiment_toml(experiment),
                  .arm = model_.driven(),
                  .times = std::move(times_),
                  .states = std::move(states_),
                  .events = std::move(marks),
                  .recorded = recorded_,
                  .safety = {},
                  .obstacles = experiment.obstacle,
                  .curve = experiment.record.curve,
                  .tension = experiment.record.tension,
                  .chapters = {}};
  add_safety(safety, schedule, data);
  // However few states are recorded, the picture in the middle is of the middle.
  if (!data.times.empty()) add_state((data.times.front() + data.times.back()) / 2, schedule, data);
  return data;
}

}  // namespace flexura
