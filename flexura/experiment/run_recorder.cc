#include "flexura/experiment/run_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "flexura/experiment/report_safety.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/results.h"
#include "flexura/model/backbone.h"
#include "flexura/report/arm_drawing.h"
#include "flexura/sim/simulation_error.h"

namespace flexura {
namespace {

// The log has every state; the report shows at most this many, which limits the memory of long runs.
constexpr std::size_t max_kept_states = 10000;

LineChart energy_chart(const std::vector<double>& times, const std::vector<RodEnergy>& energies) {
  LineChart chart{.heading = "energy of the true arm",
                  .x_label = "t (s)",
                  .value_label = "energy (J)",
                  .least = 1e-6,
                  .x = times,
                  .legend = "of"};
  for (const char* name : {"motion", "strain", "weight", "all"}) chart.series.emplace_back().name = name;
  for (const RodEnergy& energy : energies) {
    chart.series[0].values.push_back(energy.kinetic);
    chart.series[1].values.push_back(energy.strain);
    chart.series[2].values.push_back(energy.gravity);
    chart.series[3].values.push_back(energy.total());
  }
  return chart;
}

}  // namespace

std::optional<Chapter> RodRecord::chapter(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                                          const Backbone& commanded) const {
  if (times.empty()) return std::nullopt;
  LineChart pulls{.heading = "tension of each tendon",
                  .x_label = "t (s)",
                  .value_label = "tension (N)",
                  .least = 0.1,
                  .x = times,
                  .legend = "tendon"};
  for (std::size_t i = 0; i < tensions.front().size(); ++i) {
    ChartSeries& series = pulls.series.emplace_back();
    series.name = std::to_string(i + 1);
    for (const std::vector<double>& at : tensions) series.values.push_back(at[i]);
  }
  LineChart tip{.heading = "distance of the true tip from the commanded tip",
                .x_label = "t (s)",
                .value_label = "distance (mm)",
                .least = 1,
                .x = times};
  ChartSeries& distance = tip.series.emplace_back();
  for (const double metres : off) distance.values.push_back(1000 * metres);
  const bool is_moving = !energies.empty();
  Chapter chapter{
      .heading = "The true arm",
      .text = fmt::format("The simulated arm is an elastic rod, {} under the forces of its tendons, weight "
                          "and loads. The pictures above show the commanded arm.",
                          is_moving ? "in motion" : "at rest"),
      .figures = {{"true-arm", two_shapes_picture(arm, obstacles, *last, commanded,
                                                  "the true arm at the end, and the commanded arm (line)")}},
      .is_first_tall = false};
  if (!pulls.series.empty()) chapter.figures.push_back({"tensions", std::move(pulls)});
  chapter.figures.push_back({"tip-off", std::move(tip)});
  if (is_moving) chapter.figures.push_back({"energy", energy_chart(times, energies)});
  if (std::ranges::any_of(contact_forces, [](double force) { return force > 0; })) {
    LineChart contacts{.heading = "contact forces on the true arm",
                       .x_label = "t (s)",
                       .value_label = "sum of magnitudes (N)",
                       .least = 1e-3,
                       .x = times};
    contacts.series.emplace_back().values = contact_forces;
    chapter.figures.push_back({"contacts", std::move(contacts)});
  }
  return chapter;
}

RunRecorder::RunRecorder(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher)
    : log_(folder.empty() ? folder : folder / log_file_name, model.driven(), watcher), model_(model) {}

void RunRecorder::expect(std::size_t last_step) {
  last_step_ = last_step, kept_every_ = last_step / max_kept_states + 1;
}

void RunRecorder::draw_scene(const Experiment& experiment) {
  const FramesMessage frames = frames_message(experiment);
  log_.recorder().write({frames_topic, 0, frames});
  const SceneMessage stand = stand_message(experiment);
  log_.recorder().write({scene_topic, 0, stand});
  drawn_color_ = experiment.arm.look.color;
  const std::vector<CameraConfig> cameras = experiment.true_rig().cameras, models = experiment.cameras();
  for (std::size_t i = 0; i < cameras.size(); ++i)
    camera_drawings_.emplace_back(cameras[i], models[i], log_.recorder());
}

void RunRecorder::state(std::size_t step, double time, const ArmState& state) {
  const ArmState shape = model_.actuation().shape(state);
  if (!std::ranges::all_of(shape.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); }))
    throw SimulationError(
        fmt::format("at {:.6g} s the model of the arm has no equilibrium under the commanded bends", time));
  const Backbone& backbone = commanded_.emplace(model_.backbone_of_shape(shape));
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

std::vector<ContactMessage> contact_messages(const std::vector<PlantContact>& contacts) {
  std::vector<ContactMessage> messages;
  messages.reserve(contacts.size());
  for (const PlantContact& contact : contacts)
    messages.push_back({.s = contact.s_rest,
                        .with = contact.with,
                        .point = {contact.point.x(), contact.point.y(), contact.point.z()},
                        .force = {contact.force.x(), contact.force.y(), contact.force.z()},
                        .depth = contact.depth,
                        .normal_force = contact.normal_force,
                        .sticks = contact.sticks});
  return messages;
}

std::optional<EnergyMessage> energy_message(double time, const std::optional<RodEnergy>& energy) {
  if (!energy) return std::nullopt;
  return EnergyMessage{time, energy->kinetic, energy->strain, energy->gravity};
}

// The sum of all contact forces' sizes, N.
double RunRecorder::contact_readings(RigTruth& truth, double now) {
  const std::vector<PlantContact> contacts = truth.contacts(now);
  const ContactsMessage message{now, contact_messages(contacts)};
  double sum = 0;
  for (const PlantContact& contact : contacts) sum += contact.force.norm();
  const bool touches = !message.contacts.empty();
  if (touches || touched_) log_.recorder().write({arm_contacts_topic, now, message});
  touched_ = touches;
  return sum;
}

// Logs a rod's values in addition to its shape.
void RunRecorder::rod_readings(RigTruth& truth, double now, const Backbone& backbone) {
  std::vector<double> tensions = truth.tensions(now);
  const std::optional<RodEnergy> energy = truth.energy(now);
  if (tensions.empty() && !energy) return;
  Recorder& recorder = log_.recorder();
  const std::vector<double> lost = truth.lost_steps(now);
  if (!tensions.empty()) {
    TensionsMessage message{now, tensions, {}};
    if (!lost.empty()) message.lost_steps = lost;
    recorder.write({arm_tensions_topic, now, message});
  }
  if (energy) {
    recorder.write({arm_energy_topic, now, *energy_message(now, energy)});
  }
  const double contact_force = energy ? contact_readings(truth, now) : 0;
  report_lost_steps(now, lost);
  std::string warning = truth.warning(now);
  if (warning != warned_ && !warning.empty()) log_.event(now, Recorder::Level::warning, "arm", warning);
  if (first_warning_.empty() && !warning.empty())
    first_warning_ = fmt::format("from {:.4g} s on: {}", now, warning);
  warned_ = std::move(warning);
  if (readings_++ % kept_every_ == 0) {
    rod_.times.push_back(now);
    rod_.off.push_back(true_tip_off_.value());
    rod_.tensions.push_back(std::move(tensions));
    if (energy) {
      rod_.energies.push_back(*energy);
      rod_.contact_forces.push_back(contact_force);
    }
  }
  rod_.last = backbone;
}

void RunRecorder::readings(Rig& rig) {
  // While a task waits for the rig, several clock steps are recorded at one time of the rig. Times that are
  // equal in the log count as one.
  const RigPorts ports = rig.ports();
  const double now = ports.clock->now();
  const std::int64_t reported = std::llround(now * 1e9);
  if (std::exchange(read_at_, reported) == reported) return;
  Recorder& recorder = log_.recorder();
  if (RigTruth* truth = rig.truth()) {
    const Backbone backbone = truth->backbone(now);
    recorder.truth(now, backbone);
    true_tip_off_ = (backbone.tip().position - commanded_.value().tip().position).norm();
    space_.true_arm(now, backbone, *commanded_);
    rod_readings(*truth, now, backbone);
  }
  recorder.reading(ports.arm->read().value());
  for (const CameraPorts& camera : ports.cameras) {
    const auto drawing = std::ranges::find(camera_drawings_, camera.name, &CameraDrawing::name);
    std::optional<CameraStance> stance;
    if (const CameraStance* first = space_.first_report(camera.name)) stance = *first;
    if (camera.head != nullptr) {
      const HeadReading reading = camera.head->read().value();
      recorder.reading(camera.name, reading);
      if (stance) stance->head = reading.state;
    }
    if (camera.stage != nullptr) {
      const StageReading reading = camera.stage->read().value();
      recorder.reading(camera.name, reading);
      if (stance) stance->stage = reading.state;
    }
    if (!stance) continue;
    space_.report(now, camera.name, *stance);
    if (drawing != camera_drawings_.end()) drawing->report(now, *stance, recorder);
  }
}

void RunRecorder::report_lost_steps(double time, const std::vector<double>& lost) {
  lost_.resize(lost.size());
  for (std::size_t i = 0; i < lost.size(); ++i) {
    if (lost[i] != lost_[i])
      log_.event(
          time, Recorder::Level::warning, "drive",
          fmt::format("the motor of axis {} loses {:.0f} microsteps, which its controller does not notice",
                      axis_names_.at(i), lost[i] - lost_[i]));
    lost_[i] = lost[i];
  }
}

void RunRecorder::name_axes(const Drive& drive) {
  for (std::size_t i = 0; i < drive.axes.size(); ++i) axis_names_.push_back(drive.axis_name(i));
}

void RunRecorder::write_commands(const Drive& drive, const std::filesystem::path& file) {
  commands_.emplace(model_.driven(), drive, file);
}

void RunRecorder::command(double time, const ArmState& state) {
  if (commands_) commands_->step(time, state, log_.recorder());
}

std::optional<std::vector<std::int64_t>> RunRecorder::motors_after(std::span<const ArmState> way) const {
  return commands_ ? std::optional(commands_->positions_after(way)) : std::nullopt;
}

void RunRecorder::close() {
  log_.recorder().close();
  if (commands_) commands_->close();
}

ReportData RunRecorder::report_data(const Experiment& experiment, const Schedule& schedule,
                                    const SafetyReport& safety) && {
  std::vector<ReportData::Mark> marks;
  for (const RunLog::Event& event : log_.events())
    marks.push_back({event.time, event.level, event.name + ": " + event.text});
  ReportData data{.title = experiment.title,
                  .version = experiment.flexura,
                  .experiment_text = experiment_toml(experiment),
                  .arm = model_.driven(),
                  .model = model_,
                  .times = std::move(times_),
                  .states = std::move(states_),
                  .events = std::move(marks),
                  .recorded = recorded_,
                  .safety = {},
                  .obstacles = experiment.obstacle,
                  .curve = experiment.record.curve,
                  .tension = experiment.record.tension,
                  .chapters = {},
                  .space = std::move(space_).space()};
  if (auto chapter = rod_.chapter(data.arm, data.obstacles, model_.backbone(data.states.back())))
    data.chapters.push_back(std::move(*chapter));
  add_safety(safety, schedule, data);
  // Even with few recorded states, the picture of the middle must be of the middle.
  if (!data.times.empty()) add_state((data.times.front() + data.times.back()) / 2, schedule, data);
  return data;
}

}  // namespace flexura
