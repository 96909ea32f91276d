#include "flexura/view/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/log/results.h"
#include "flexura/port/camera_moves.h"
#include "flexura/store/json.h"
#include "flexura/view/answers.h"
#include "flexura/view/seeing_choice.h"

namespace flexura {
namespace {

Node::Table event_table(double time, const std::string& level, const std::string& name,
                        const std::string& text) {
  return {{"type", {}, {std::string("event"), {}}},
          {"time", {}, {time, {}}},
          {"level", {}, {level, {}}},
          {"name", {}, {name, {}}},
          {"text", {}, {text, {}}}};
}

// Where an axis is commanded to that cannot go beyond its ends.
double within(const AxisConfig& axis, double position) {
  return std::clamp(position, axis.limits[0], axis.limits[1]);
}

}  // namespace

// Handles each request.
struct LiveSession::Taker : PictureSession::Taker {
  LiveSession& session;
  using PictureSession::Taker::operator();

  void operator()(const ArmRequest& arm) const {
    session.require_free();
    const ViewedRig& rig = *session.viewed();
    if (arm.tendons && !rig.actuators.empty()) {
      session.move({requested_pull(rig.actuators, *arm.tendons), arm.duration, std::move(reply)});
    } else {
      session.move({requested_shape(rig.model.driven(), rig.drive, arm), arm.duration, std::move(reply)});
    }
  }
  void operator()(const TipRequest& tip) const {
    session.require_free();
    session.move({tip, 0, std::move(reply)});
  }
  void operator()(const HeadRequest& head) const {
    session.require_free();
    const std::size_t place = session.place_of(head.camera);
    HeadState target = session.head_targets_.at(place);
    target = {head.pan.value_or(target.pan), head.tilt.value_or(target.tilt),
              head.zoom.value_or(target.zoom)};
    const auto& axes = session.viewed()->nominal[place].head_axes();
    target = {within(axes[0], target.pan), within(axes[1], target.tilt), within(axes[2], target.zoom)};
    const CameraPorts camera = session.rig_.ports().cameras.at(place);
    if (const auto fault = command_head(camera, session.viewed()->nominal[place], target).fault())
      throw ViewRefusal(text(*fault));
    session.left_.reset();
    session.head_targets_.at(place) = target;
    done();
  }
  void operator()(const StageRequest& stage) const {
    session.require_free();
    const std::size_t place = session.place_of(stage.camera);
    require_travel(session.viewed()->cameras[place], stage);
    StageState target = session.stage_targets_.at(place);
    target.offset = {stage.x.value_or(target.offset.x()), stage.y.value_or(target.offset.y()),
                     stage.z.value_or(target.offset.z())};
    const auto& axes = session.viewed()->nominal[place].stage_axes();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      double& offset = target.offset[static_cast<Eigen::Index>(i)];
      offset = within(axes[i], offset);
    }
    const CameraPorts camera = session.rig_.ports().cameras.at(place);
    if (const auto fault = command_stage(camera, session.viewed()->nominal[place], target).fault())
      throw ViewRefusal(text(*fault));
    session.left_.reset();
    session.stage_targets_.at(place) = target;
    done();
  }
  void operator()(const HaltRequest&) const {
    if (session.is_watched_run())
      throw ViewRefusal("cannot halt: only the terminal that started the run can stop it");
    session.halt();
    done();
  }
  void operator()(const ResetRequest&) const {
    session.require_free();
    session.reset();
    done();
  }
  void operator()(const WeightRequest& weight) const {
    session.require_free();
    session.weigh(weight.on);
    done();
  }
  void operator()(const PushRequest& push) const {
    session.require_free();
    session.push(client, push);
    done();
  }
  void operator()(const ReleaseRequest&) const {
    session.require_free();
    session.release();
    done();
  }
  void operator()(const RunRequest& run) const {
    session.require_free();
    session.start_run(run, reply);
  }
  void operator()(const SpeedRequest& request) const {
    if (session.run_ == nullptr) throw ViewRefusal("no run is active");
    session.pace_->set_speed(request.speed);
    done();
  }
  void operator()(const CancelRequest&) const {
    if (session.is_watched_run()) throw ViewRefusal("only the terminal that started the run can cancel it");
    if (session.run_ == nullptr) throw ViewRefusal("no run is active");
    session.run_->cancel();
    done();
  }
  void operator()(const OpenRequest&) const { throw ViewRefusal("there is no recording yet"); }
  void operator()(const LiveRequest&) const { done(); }
  void operator()(const BranchRequest&) const {
    throw ViewRefusal("expected a recording, but this is a live rig");
  }
  void operator()(const ExperimentRequest&) const { throw ViewRefusal("has no text here"); }
  void operator()(const CheckRequest&) const { throw ViewRefusal("has no text here"); }
  void operator()(const SaveRequest&) const { throw ViewRefusal("has no text here"); }
  void operator()(const AtRequest&) const {
    throw ViewRefusal("a live rig cannot go back in time: expected a recording");
  }
  void operator()(const PixelRequest& pixel) const {
    const std::size_t camera = session.place_of(pixel.camera);
    session.room().pixel({client, camera}, session.newest_shot(camera), static_cast<int>(pixel.u),
                         static_cast<int>(pixel.v), std::move(reply));
  }
  void operator()(const PointRequest& point) const { done(point_answer(session.shown_backbone(), point.s)); }
  void operator()(const BackboneRequest& backbone) const {
    done(backbone_answer(session.rig_.at_rest(requested_shape(session.viewed()->truth.driven(), backbone))));
  }
};

LiveSession::LiveSession(const ViewedRigPtr& rig, Messenger& messenger, Background& background, Config config)
    : PictureSession(rig, messenger, background),
      config_(std::move(config)),
      clock_(config_.start),
      rig_(rig, 0),
      run_(config_.run),
      reporter_(rig, messenger) {
  reset();
  if (!is_watched_run()) return;
  pace_.emplace(config_.speed, viewed()->experiment.clock.step);
  paced_at_ = clock_;
  run_->pace_to(pace_->next(0, 0));
}

void LiveSession::cancel() {
  if (run_ != nullptr && !is_watched_run()) run_->cancel();
}

Hello LiveSession::hello() const {
  Hello hello;
  hello.mode = "live";
  hello.title = viewed()->experiment.title;
  hello.scene = scene_node(*viewed());
  hello.controls = live_controls_node(*viewed());
  hello.readonly = is_watched_run();
  if (is_watched_run() && pace_) hello.speed = pace_->speed();
  return hello;
}

void LiveSession::opened(ClientId client) {
  clients_.insert(client);
  reporter_.repeat();
  messenger().send(client, condition_message(reported_));
}

void LiveSession::closed(ClientId client) {
  clients_.erase(client);
  // Ends the push of a client that has left.
  if (pushing_client_ == client) release();
  PictureSession::closed(client);
}

void LiveSession::take(ClientId client, const Ask& ask, Reply reply) {
  std::visit(Taker{{*this, client, reply}, *this}, ask);
}

void LiveSession::take(const Document& document, std::function<void(HttpAnswer)> answer) {
  const auto* image = std::get_if<ImageAsk>(&document);
  if (image == nullptr) throw ViewRefusal("a live rig has no series and no report: expected a recording");
  if (image->time) throw ViewRefusal("a live rig has only current pictures: expected no time");
  if (!room().file(newest_shot(place_of(image->camera)), std::move(answer)))
    throw ViewRefusal("too many pictures are requested at once");
}

void LiveSession::require_free() const {
  if (is_watched_run()) throw ViewRefusal("this rig can only be viewed, not moved");
  if (run_ != nullptr) throw ViewRefusal("a run of tasks is active");
}

void LiveSession::start_run(const RunRequest& request, const Reply& reply) {
  Experiment experiment = with_choices(viewed()->experiment, request.seeing);
  if (experiment.task.empty()) throw ViewRefusal("the experiment has no tasks");
  if (request.task) {
    const auto place = static_cast<std::size_t>(*request.task);
    if (place >= experiment.task.size())
      throw ViewRefusal(fmt::format("task = {}: expected 0 to {}", place, experiment.task.size() - 1));
    experiment.task = {experiment.task[place]};
  }
  std::filesystem::path folder;
  try {
    folder = make_new_folder(config_.results);
  } catch (const std::exception& error) {
    throw ViewRefusal(error.what());
  }
  release();
  left_.reset();
  run_ = std::make_shared<RunLink>();
  news_ = {};
  pace_.emplace(request.speed, experiment.clock.step);
  paced_at_ = clock_;
  run_->pace_to(pace_->next(0, 0));
  reporter_.begin();
  background().run(Lane::tasks,
                   [experiment = std::move(experiment), folder, run = run_]() -> Background::After {
                     run_linked(experiment, folder, *run);
                     return {};
                   });
  reply({{Node::Table{{"folder", {}, {folder.string(), {}}}}, {}}, ""});
}

void LiveSession::follow_run() {
  if (run_ == nullptr) return;
  const bool was_shown = news_.time.has_value();
  if (viewed()->is_rod) run_->request_truth();
  news_ = run_->news();
  if (pace_) run_->pace_to(pace_->next(clock_ - paced_at_, news_.time.value_or(0)));
  paced_at_ = clock_;
  // The state jumps from that of the rig to the run's start.
  if (news_.time && !was_shown) ++leaps_;
  // Messages have the time of the live rig; for a watched run, they have the time of the run.
  const std::optional<double> now = is_watched_run() ? std::nullopt : std::optional(rig_.now());
  if (news_.end && !is_watched_run()) stay_where_it_ended();
  reporter_.report(*run_, news_, clock_, now, clients_);
  if (!news_.end) return;
  if (!news_.end->folder.empty()) results_ = news_.end->folder;
  left_ = {condition_after(news_.end->outcome), news_.end->text};
  run_.reset();
  pace_.reset();
}

// Keeps the final state of a run: the arm and the cameras stay at their last positions.
void LiveSession::stay_where_it_ended() {
  if (!news_.time) return;  // It never began.
  ++generation_;
  warning_.clear();
  try {
    if (auto rig = run_->take_rig()) {
      rig_.take_over(std::move(rig), rig_.now());
      (void)rig_.ports().arm->halt().value();
    } else {
      rig_.restart(rig_.now(), news_.state);
    }
    aim_at_readings();
    is_touching_ = !touched(rig_.backbone(rig_.now()), viewed()->forbidden).empty();
  } catch (const std::exception& error) {
    notice("error", "safety", std::string("everything is reset to the start: ") + error.what());
    reset();
  }
}

RigInstant LiveSession::instant(ClientId /*client*/) {
  RigInstant instant{is_run_shown() ? news_.state : rig_.nominal(), {}};
  for (std::size_t i = 0; i < viewed()->cameras.size(); ++i) {
    if (!is_run_shown()) {
      instant.cameras.push_back({head_targets_.at(i), stage_targets_.at(i)});
    } else {
      instant.cameras.push_back(i < news_.cameras.size() ? news_.cameras[i] : viewed()->first_reading(i));
    }
  }
  return instant;
}

void LiveSession::advance(double now) {
  clock_ = std::max(clock_, now);
  const double next = clock_ - config_.start;
  move_on(next);
  report_warning();
  report_pace();
  follow_run();
  report_condition();
  if (clients_.empty()) return;
  send_states();
  send_images();
}

Backbone LiveSession::shown_backbone() {
  if (!is_run_shown()) return rig_.backbone(rig_.now());
  return run_truth() != nullptr ? run_truth()->backbone : viewed()->truth.backbone(news_.state);
}

// Returns the last reported true arm of a run; null if none was reported.
const TrueArm* LiveSession::run_truth() const { return news_.truth.get(); }

// Returns the cameras' axis positions in the run, as far as reported.
std::vector<CameraStance> LiveSession::run_stances() const {
  std::vector<CameraStance> stances;
  stances.reserve(viewed()->cameras.size());
  for (std::size_t i = 0; i < viewed()->cameras.size(); ++i)
    stances.push_back(i < news_.cameras.size() ? viewed()->stance(i, news_.cameras[i])
                                               : viewed()->first_stance(i));
  return stances;
}

void LiveSession::send_states() {
  const bool is_running = run_ != nullptr;
  StateMessage state = is_running && news_.time
                           ? still_state(*viewed(), *news_.time, news_.state, run_stances(), run_truth())
                           : rig_.state();
  // Commanded positions differ from readings by the steps of the motors.
  for (std::size_t i = 0; i < state.cameras.size() && !is_run_shown(); ++i) {
    state.cameras[i].commanded_head = head_targets_.at(i);
    state.cameras[i].commanded_stage = stage_targets_.at(i).offset;
  }
  if (is_running) state.pace = pace_ ? pace_->slowness() : std::nullopt;
  // States have the time of the live rig; for a watched run, they have the time of the run.
  if (!is_watched_run()) state.time = rig_.now();
  state.is_running = is_running;
  state.is_moving = state.is_moving || is_running;
  state.is_unsafe = reported_.condition == Condition::unsafe;
  state.leaps = leaps_;
  state.sequence = sequence_++;
  const auto message = std::make_shared<const std::string>(state_message(state));
  for (const ClientId client : clients_) messenger().post(client, state_stream, message);
}

// Returns the picture of a camera to which the drawn measurements of a servo or calibration belong; null if
// there is none.
const RunLink::Measured* LiveSession::measured(std::size_t camera) const {
  if (!is_run_shown()) return nullptr;
  const std::string& name = viewed()->cameras.at(camera).config().name;
  const auto found = std::ranges::find(reporter_.measured(), name, &RunLink::Measured::camera);
  return found == reporter_.measured().end() ? nullptr : &*found;
}

ValueShot LiveSession::measured_shot(std::size_t camera, const RunLink::Measured& seen) {
  const SensorConfig& sensor = viewed()->sensors[camera];
  CameraStance stance = viewed()->first_stance(camera);
  if (seen.reading) {
    stance = viewed()->stance(camera, *seen.reading);
  } else if (camera < seen.readings.size()) {
    stance = viewed()->stance(camera, seen.readings[camera]);
  }
  // So long ago, by the time that states have.
  const double speed = pace_ ? pace_->speed() : 1;
  const double ago = std::max(0.0, *news_.time - seen.time) / (speed > 0 ? speed : 1);
  const double shown = is_watched_run() ? seen.time : rig_.now() - ago;
  const double start = shown - times_of_frame_at(sensor, 0).middle;
  Instant instant{start, seen.state, stance, {}};
  instant.shape = viewed()->is_rod && seen.truth
                      ? std::shared_ptr<const Backbone>(seen.truth, &seen.truth->backbone)
                      : rig_.rod_at_rest(seen.state);
  return with_covers(value_shot(viewed(), camera, seen.frame, start, {std::move(instant)}), seen.time);
}

ValueShot LiveSession::newest_shot(std::size_t camera) {
  const std::int64_t number = std::max<std::int64_t>(rig_.newest_frame(camera), 0);
  if (!is_run_shown()) return rig_.shot(camera, number);
  if (const RunLink::Measured* seen = measured(camera)) return measured_shot(camera, *seen);
  const CameraStance stance = run_stances().at(camera);
  const SensorConfig& sensor = viewed()->sensors[camera];
  // As for states, the time is the page's own, or that of a run watched from start to end. So mid-exposure of
  // a picture is the time of the state that it shows.
  const double start = is_watched_run() ? *news_.time - times_of_frame_at(sensor, 0).middle
                                        : frame_times(sensor, number).start;
  Instant shown{start, news_.state, stance, {}};
  shown.shape = viewed()->is_rod && news_.truth
                    ? std::shared_ptr<const Backbone>(news_.truth, &news_.truth->backbone)
                    : rig_.rod_at_rest(news_.state);
  return with_covers(value_shot(viewed(), camera, number, start, {std::move(shown)}), *news_.time);
}

void LiveSession::send_images() {
  for (std::size_t camera = 0; camera < viewed()->cameras.size(); ++camera) {
    const RunLink::Measured* seen = measured(camera);
    const std::int64_t number = seen != nullptr ? seen->frame : rig_.newest_frame(camera);
    if (number < 0 || room().is_busy(camera)) continue;
    const auto due = streams().due(camera, number, clock_);
    if (!due.empty()) room().show(newest_shot(camera), due, clock_);
  }
}

void LiveSession::event(const char* level, const std::string& name, const std::string& text) {
  broadcast({event_table(rig_.now(), level, name, text), {}});
}

// Sends an event that was not requested, to be shown at once.
void LiveSession::notice(const char* level, const std::string& name, const std::string& text) {
  Node::Table table = event_table(rig_.now(), level, name, text);
  table.push_back({"notice", {}, {true, {}}});
  broadcast({std::move(table), {}});
}

void LiveSession::broadcast(const Node& message) {
  const std::string text = write_json(message);
  for (const ClientId client : clients_) messenger().send(client, text);
}

}  // namespace flexura
