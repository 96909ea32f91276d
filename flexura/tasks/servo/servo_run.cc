#include "flexura/tasks/servo/servo_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "flexura/estimate/backbone_pixels.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/run_log.h"
#include "flexura/rig/commanded_motion.h"
#include "flexura/servo/feature_marks.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/tasks/servo/servo_target.h"

namespace flexura {
namespace {

// Logs all events, and compares with the true values.
class LoggedServo : public ServoSessionWatcher {
 public:
  // `expected`: how long it takes, about, s.
  LoggedServo(const Setup& setup, const ServoConfig& session, double expected, ServoRun& run,
              TaskStage& stage, CommandedMotion& motion)
      : keeps_images_(setup.record.cameras),
        expected_(expected),
        run_(run),
        stage_(stage),
        log_(stage.log),
        motion_(motion),
        marker_(session.law, run.nominal.arm, session.points) {}

  void arm_sent(double time, const ArmState& state, double duration) override {
    motion_.send(time, state, duration);
  }
  void seen(const ServoObservation& observed) override {
    const auto marks = marker_.of(observed);
    for (std::size_t i = 0; i < 2; ++i) {
      if (keeps_images_)
        log_.image(run_.cameras[i], observed.frames[i], logged_image(run_.cameras[i], observed.frames[i]));
      ServoObservationMessage message;
      message.time = observed.frames[i].time, message.camera = run_.cameras[i];
      message.frame = observed.frames[i].number;
      if (!observed.estimate.is_found && !observed.reasons[i].empty()) message.reason = observed.reasons[i];
      for (const CurvePoint& point : thinned(observed.seen[i].points, most_points))
        message.points.push_back({point.pixel.x(), point.pixel.y(), point.sigma});
      for (const Eigen::Vector2d& pixel :
           backbone_pixels(run_.nominal.arm, observed.desired, observed.seen[i].view, desired_points))
        message.desired.push_back(to_hundredths(pixel));
      if (!marks[i].empty()) message.features.emplace();
      for (const FeatureMark& mark : marks[i])
        message.features->push_back({to_hundredths(mark.seen), to_hundredths(mark.desired)});
      log_.publish({servo_observations_topic, observed.frames[i].received, message});
    }
  }
  void stepped(const ServoStep& step) override {
    ServoStep logged = step;
    if (RigTruth* truth = stage_.rig.truth(); truth != nullptr && step.seen_at)
      logged.truth = true_shape(step, *truth);
    log_.publish({servo_steps_topic, logged.time, logged});
    truth_.push_back(std::move(logged.truth));
    if (!begun_) begun_ = step.time;
    stage_.progress.update(
        std::min(0.99, (step.time - *begun_) / expected_),
        step.error ? fmt::format("{}: error {:.2f} % of the length", run_.name, 100 * step.error->rms)
                   : run_.name);
  }
  void reported(double time, const std::string& what) override {
    log_.event(time, Recorder::Level::warning, run_.name, what);
  }
  bool is_cancelled() override { return stage_.progress.is_cancelled(); }

  /// Adds the truth to the steps of a result, which are the logged ones.
  void add_truth(std::vector<ServoStep>& steps) {
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i].truth = std::move(truth_[i]);
  }

 private:
  static constexpr std::size_t most_points = 60;  // Points of an axis in the log.
  static constexpr int desired_points = 40;       // Points of the target shape's image.

  static std::array<double, 2> to_hundredths(const Eigen::Vector2d& pixel) {
    return {std::round(100 * pixel.x()) / 100, std::round(100 * pixel.y()) / 100};
  }
  static std::vector<std::array<double, 2>> to_hundredths(const std::vector<Eigen::Vector2d>& pixels) {
    std::vector<std::array<double, 2>> rounded;
    rounded.reserve(pixels.size());
    for (const Eigen::Vector2d& pixel : pixels) rounded.push_back(to_hundredths(pixel));
    return rounded;
  }

  // At the time of the step's pictures.
  [[nodiscard]] TrueShape true_shape(const ServoStep& step, RigTruth& truth) const {
    const Arm& arm = run_.nominal.arm;
    const Backbone shape = truth.backbone(*step.seen_at);
    TrueShape found;
    for (const Arc& arc : shape.arcs()) found.bends.push_back(arc.bend), found.lengths.push_back(arc.length);
    found.error = servo_error(shape, Backbone(arm, step.desired), arm.length());
    return found;
  }

  bool keeps_images_;
  double expected_;              // In s.
  std::optional<double> begun_;  // Time of the first step, s.
  ServoRun& run_;
  TaskStage& stage_;
  RunLog& log_;
  CommandedMotion& motion_;
  FeatureMarker marker_;
  std::vector<std::optional<TrueShape>> truth_;  // Of each step.
};

void add_true_remaining(ServoRun& run) {
  LateErrors late(run.settle);
  for (const ServoStep& step : run.result.steps)
    if (step.is_fresh && step.truth) late.add(*step.seen_at, step.truth->error);
  run.true_remaining = late.mean();
}

}  // namespace

std::vector<double> band_places(const Setup& setup, const Arm& nominal) {
  const ArmModel model = setup.arm_model();
  const Arm& arm = model.shaped();
  std::vector<double> places;
  for (const Marker& marker : setup.arm.look.markers(model.driven())) {
    const ArmState straight = ArmState::straight(nominal.sections.size());
    places.push_back(arc_length_of(nominal, straight, material_point(arm, marker.at)));
  }
  return places;
}

double expected_duration(const ServoTask& task) {
  constexpr double to_settle = 3;  // In s.
  return to_settle + (task.target.empty() ? 0 : task.target.back().time);
}

ServoConfig servo_config(const Setup& setup, const ServoTask& task, const RigModel& nominal,
                         const ArmState& from) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  ServoConfig config;
  static_cast<ServoSettings&>(config) = servo_settings(task, cameras);
  config.cameras = servo_cameras(task, cameras);
  const CameraConfig &first = cameras[config.cameras[0]], &second = cameras[config.cameras[1]];
  const ArmModel arm = nominal.arm_model();
  ArmState state = from;
  for (const ServoTargetConfig& target : task.target) {
    if (!target.pictures.empty()) {
      config.goals.push_back({target.time, recorded_views(target, {first, second}, setup.folder)});
      continue;
    }
    const ServoTargetShape shape = servo_target_shape(target, arm, state);
    state = shape.state;
    config.goals.push_back({target.time, arm.actuation().shape(shape.state), shape.missed});
  }
  const bool is_colored = first.sensor.pixels == PixelKind::color && second.sensor.pixels == PixelKind::color;
  if (is_colored) config.markers = band_places(setup, nominal.arm);
  const auto scenes = arm_scenes(setup);
  for (std::size_t i = 0; i < 2; ++i) config.scenes[i] = scenes[config.cameras[i]];
  config.step = task.step.value_or(1 / slower_frame_rate(cameras, config.cameras));
  if (setup.drive) config.drive = setup.drive->drive();
  config.list_step = setup.clock.step;
  config.obstacles = obstacles(setup.obstacle);
  return config;
}

ServoRun run_servo(const ServoTask& task, const std::string& name, const Setup& setup, const ArmState& from,
                   TaskStage& stage) {
  RecordedPorts recorded(stage.rig.ports(), from, stage.record_steps);
  ServoRun run;
  run.name = name, run.nominal = stage.nominal.model;
  ServoConfig session = servo_config(setup, task, run.nominal, from);
  session.sent = from;
  run.settle = task.settle;
  for (std::size_t i = 0; i < 2; ++i) run.cameras[i] = recorded.ports().cameras[session.cameras[i]].name;
  LoggedServo log(setup, session, expected_duration(task), run, stage, recorded.motion());
  run.result = servo_in_session(recorded.ports(), run.nominal, session, log);
  log.add_truth(run.result.steps);
  const double end = recorded.finish();
  run.motion = recorded.motion().motion(end);
  add_true_remaining(run);
  stage.log.event(end, run.result.is_done ? Recorder::Level::info : Recorder::Level::error, run.name,
                  run.result.is_done ? "there" : run.result.reason);
  return run;
}

}  // namespace flexura
