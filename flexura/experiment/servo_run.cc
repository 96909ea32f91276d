#include "flexura/experiment/servo_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/estimate/backbone_pixels.h"
#include "flexura/experiment/commanded_motion.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/servo/feature_marks.h"

namespace flexura {
namespace {

// Tells the log of everything, and compares with the truth.
class LoggedServo : public ServoSessionWatcher {
 public:
  LoggedServo(const Experiment& experiment, const ServoConfig& session, ServoRun& run, Filming& filming,
              Witness& witness, Progress& progress, CommandedMotion& motion)
      : keeps_images_(experiment.record.cameras),
        run_(run),
        filming_(filming),
        witness_(witness),
        progress_(progress),
        motion_(motion),
        marker_(session.law, run.believed.arm, session.points) {}

  void arm_sent(double time, const ArmState& state, double duration) override {
    motion_.send(time, state, duration);
  }
  void seen(const ServoSight& sight) override {
    const auto marks = marker_.of(sight);
    for (std::size_t i = 0; i < 2; ++i) {
      if (keeps_images_)
        witness_.image(run_.cameras[i], sight.frames[i], logged_image(run_.cameras[i], sight.frames[i]));
      ServoSightingMessage message;
      message.time = sight.frames[i].time, message.camera = run_.cameras[i];
      message.frame = sight.frames[i].number;
      if (!sight.estimate.is_found && !sight.reasons[i].empty()) message.reason = sight.reasons[i];
      for (const CurvePoint& point : thinned(sight.seen[i].points, most_points))
        message.points.push_back({point.pixel.x(), point.pixel.y(), point.sigma});
      for (const Eigen::Vector2d& pixel :
           backbone_pixels(run_.believed.arm, sight.desired, sight.seen[i].view, wanted_points))
        message.wanted.push_back(to_hundredths(pixel));
      if (!marks[i].empty()) message.features.emplace();
      for (const FeatureMark& mark : marks[i])
        message.features->push_back({to_hundredths(mark.seen), to_hundredths(mark.wanted)});
      witness_.servo(message, sight.frames[i].received);
    }
  }
  void stepped(const ServoStep& step) override {
    ServoStep logged = step;
    if (step.seen_at) logged.truth = true_shape(step);
    witness_.servo(logged);
    truth_.push_back(std::move(logged.truth));
    progress_.update(
        0.5, step.error ? fmt::format("{}: {:.2f} % of the length off", run_.name, 100 * step.error->rms)
                        : run_.name);
  }
  void told(double time, const std::string& what) override {
    witness_.event(time, Recorder::Level::warning, run_.name, what);
  }
  bool is_cancelled() override { return progress_.is_cancelled(); }

  /// To the steps of a result, which are those that were told.
  void add_truth(std::vector<ServoStep>& steps) {
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i].truth = std::move(truth_[i]);
  }

 private:
  static constexpr std::size_t most_points = 60;  // Of an axis in the log.
  static constexpr int wanted_points = 40;        // Of the wanted shape's image.

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
  [[nodiscard]] TrueShape true_shape(const ServoStep& step) const {
    const Arm& arm = run_.believed.arm;
    const Backbone shape = filming_.true_backbone(*step.seen_at);
    TrueShape truth;
    for (const Arc& arc : shape.arcs()) truth.bends.push_back(arc.bend), truth.lengths.push_back(arc.length);
    truth.error = servo_error(shape, Backbone(arm, step.desired), arm.length());
    return truth;
  }

  bool keeps_images_;
  ServoRun& run_;
  Filming& filming_;
  Witness& witness_;
  Progress& progress_;
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

std::vector<double> band_places(const Experiment& experiment, const Arm& believed) {
  const ArmModel model = experiment.arm.model();
  const Arm& arm = model.shaped();
  std::vector<double> places;
  for (const Marker& marker : experiment.arm.look.markers(model.driven())) {
    const ArmState straight = ArmState::straight(believed.sections.size());
    places.push_back(arc_length_of(believed, straight, material_point(arm, marker.at)));
  }
  return places;
}

ServoConfig servo_config(const Experiment& experiment, const ServoTask& task, const RigModel& believed,
                         const ArmState& from) {
  const std::vector<CameraConfig> cameras = experiment.cameras();
  ServoConfig config;
  static_cast<ServoSettings&>(config) = servo_settings(task, cameras);
  config.cameras = servo_cameras(task, cameras);
  const CameraConfig &first = cameras[config.cameras[0]], &second = cameras[config.cameras[1]];
  const ArmModel arm = believed.arm_model();
  ArmState state = from;
  for (const ServoTargetConfig& target : task.target) {
    if (!target.pictures.empty()) {
      config.goals.push_back({target.time, recorded_views(target, {first, second}, experiment.folder)});
      continue;
    }
    const ServoTargetShape shape = servo_target_shape(target, arm, state);
    state = shape.state;
    config.goals.push_back({target.time, arm.actuation().shape(shape.state), shape.missed});
  }
  const bool is_colored = first.sensor.pixels == PixelKind::color && second.sensor.pixels == PixelKind::color;
  if (is_colored) config.markers = band_places(experiment, believed.arm);
  config.step = task.step.value_or(1 / slower_frame_rate(cameras, config.cameras));
  if (experiment.drive) config.drive = experiment.drive->drive();
  config.list_step = experiment.clock.step;
  config.obstacles = obstacles(experiment.obstacle);
  return config;
}

ServoRun run_servo(const Experiment& experiment, std::size_t task, const RigModel& believed,
                   const ArmState& from, Filming& filming, Witness& witness, Progress& progress,
                   const RecordSteps& record_steps) {
  const auto& config = std::get<ServoTask>(experiment.task.at(task));
  RecordedPorts recorded(filming.ports(), from, record_steps);
  ServoConfig session = servo_config(experiment, config, believed, from);
  session.sent = from;
  ServoRun run;
  run.name = task_name(experiment.task[task]), run.task = task, run.believed = believed;
  run.settle = config.settle;
  for (std::size_t i = 0; i < 2; ++i) run.cameras[i] = recorded.ports().cameras[session.cameras[i]].name;
  LoggedServo log(experiment, session, run, filming, witness, progress, recorded.motion());
  run.result = servo_in_session(recorded.ports(), run.believed, session, log);
  log.add_truth(run.result.steps);
  const double end = recorded.finish();
  run.motion = recorded.motion().motion(end);
  add_true_remaining(run);
  witness.event(end, run.result.is_done ? Recorder::Level::info : Recorder::Level::error, run.name,
                run.result.is_done ? "there" : run.result.reason);
  witness.servo_ended();
  return run;
}

}  // namespace flexura
