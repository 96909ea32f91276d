#include "flexura/experiment/witness.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "flexura/experiment/report_safety.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/run_watcher.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// The log has every state; the report draws no more than this, and a long run should not fill the memory.
constexpr std::size_t max_kept_states = 10000;

}  // namespace

Witness::Witness(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher)
    : recorder_(folder / log_file_name, model.driven()), watcher_(watcher), model_(model) {}

void Witness::expect(std::size_t last_step) {
  last_step_ = last_step, kept_every_ = last_step / max_kept_states + 1;
}

void Witness::event(double time, Recorder::Level level, const std::string& name, const std::string& text) {
  recorder_.event(time, level, name, text);
  const std::string kind = level_name(static_cast<std::int64_t>(level));
  marks_.push_back({time, kind, name + ": " + text});
  if (watcher_ != nullptr) watcher_->happened(time, kind, name, text);
}

void Witness::draw_scene(const Experiment& experiment) {
  recorder_.frames(0, frames_message(experiment));
  recorder_.scene(0, stand_message(experiment));
  drawn_color_ = experiment.arm.look.color;
}

void Witness::state(std::size_t step, double time, const ArmState& state) {
  const Backbone backbone = model_.backbone(state);
  recorder_.state(time, state, backbone);
  if (drawn_color_ && (scene_times_.is_next(time) || step == last_step_))
    recorder_.scene(time, arm_message(*drawn_color_, time, backbone));
  ++recorded_;
  if (step % kept_every_ != 0 && step != last_step_) return;
  times_.push_back(time);
  states_.push_back(state);
}

void Witness::image(const std::string& camera, const Frame& frame, std::string_view message) {
  recorder_.image(camera, frame, message);
  ++frames_[camera];
}

void Witness::calibration(const CalibrationMoveMessage& message) {
  recorder_.calibration(message);
  if (watcher_ != nullptr) watcher_->calibration_moved(message);
}

void Witness::calibration(const CalibrationArcMessage& message, const Image<std::uint8_t>& ideal) {
  recorder_.calibration(message, ideal);
}

void Witness::calibration(const CalibrationSightingMessage& message, double received) {
  recorder_.calibration(message, received);
  if (watcher_ != nullptr) watcher_->calibration_saw(message);
}

void Witness::calibration(const CalibrationDecisionMessage& message) {
  recorder_.calibration(message);
  if (watcher_ != nullptr) watcher_->calibration_decided(message);
}

void Witness::servo(const ServoStep& step) {
  recorder_.servo(step);
  if (watcher_ != nullptr) watcher_->servo_stepped(step);
}

void Witness::servo(const ServoSightingMessage& message, double received) {
  recorder_.servo(message, received);
  if (watcher_ != nullptr) watcher_->servo_saw(message);
}

void Witness::servo_ended() {
  if (watcher_ != nullptr) watcher_->servo_ended();
}

void Witness::readings(const RigPorts& rig, const Backbone& truth) {
  // While a task waits for the rig, several steps of the clock are recorded at one time of the rig's.
  // Times that the log cannot tell apart are one.
  const std::int64_t now = std::llround(rig.clock->now() * 1e9);
  if (std::exchange(read_at_, now) == now) return;
  recorder_.truth(rig.clock->now(), truth);
  recorder_.reading(rig.arm->read().value());
  for (const CameraPorts& camera : rig.cameras) {
    recorder_.reading(camera.name, camera.head->read().value());
    recorder_.reading(camera.name, camera.stage->read().value());
  }
}

void Witness::write_commands(const Drive& drive, const std::filesystem::path& file) {
  commands_.emplace(model_.driven(), drive, file);
}

void Witness::command(double time, const ArmState& state) {
  if (commands_) commands_->step(time, state, recorder_);
}

std::optional<std::vector<std::int64_t>> Witness::motors_after(std::span<const ArmState> way) const {
  return commands_ ? std::optional(commands_->positions_after(way)) : std::nullopt;
}

void Witness::close() {
  recorder_.close();
  if (commands_) commands_->close();
}

ReportData Witness::report_data(const Experiment& experiment, const Schedule& schedule,
                                const SafetyReport& safety) && {
  ReportData data{.title = experiment.title,
                  .version = experiment.flexura,
                  .experiment_text = experiment_toml(experiment),
                  .arm = model_.driven(),
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
  // However few states are recorded, the picture in the middle is of the middle.
  if (!data.times.empty()) add_state((data.times.front() + data.times.back()) / 2, schedule, data);
  return data;
}

}  // namespace flexura
