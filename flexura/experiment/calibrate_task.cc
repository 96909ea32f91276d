#include "flexura/experiment/calibrate_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/names.h"
#include "flexura/estimate/backbone_pixels.h"
#include "flexura/experiment/commanded_motion.h"
#include "flexura/experiment/ideal_picture.h"
#include "flexura/port/rig_ports.h"

namespace flexura {
namespace {

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<double> rotations_of(const ArmState& state) {
  std::vector<double> rotations;
  rotations.reserve(state.bends.size());
  for (const Eigen::Vector2d& bend : state.bends) rotations.push_back(std::atan2(bend.y(), bend.x()));
  return rotations;
}

CalibrationDecisionMessage decision_message(const RigStep& step) {
  CalibrationDecisionMessage message;
  message.time = step.time, message.looks = static_cast<std::int64_t>(step.looks);
  message.found = step.is_found, message.rms = step.rms, message.next = step.next;
  if (!step.is_found) message.reason = step.reason;
  message.doubts = static_cast<std::int64_t>(step.doubts);
  message.angle = step.angle, message.angle_sigma = step.sigmas.angle;
  message.focal = step.focal, message.focal_sigma = step.sigmas.focal;
  message.zoom_ratio_sigma = step.sigmas.zoom_ratio;
  return message;
}

// Tells the log of everything.
class LoggedSession : public RigSessionWatcher {
 public:
  LoggedSession(CalibrationRun& run, std::size_t images, Witness& witness, Progress& progress,
                CommandedMotion& motion)
      : run_(run), images_(images), witness_(witness), progress_(progress), motion_(motion) {}

  void arm_sent(double time, const ArmState& state, double duration) override {
    motion_.send(time, state, duration);
    CalibrationMoveMessage message;
    message.time = time, message.device = "arm", message.bends = bends_of(state), message.duration = duration;
    witness_.calibration(message);
  }
  void camera_sent(double time, const RigStance& stance) override {
    CalibrationMoveMessage message;
    message.time = time, message.device = name_of(stance.camera);
    message.pan = stance.head.pan, message.tilt = stance.head.tilt, message.zoom = stance.head.zoom;
    message.stage = array_of(stance.stage.offset);
    witness_.calibration(message);
  }
  void planned(const IdealArc& arc) override {
    // From arc to arc by way of where the arm is now.
    way_.push_back(motion_.at(arc.time)), way_.push_back(arc.state);
    run_.arcs.push_back({arc, rotations_of(arc.state), witness_.motors_after(way_)});
    const CommandedArc& commanded = run_.arcs.back();
    CalibrationArcMessage message;
    message.time = arc.time, message.camera = name_of(arc.camera), message.plane = arc.plane;
    message.bends = bends_of(arc.state), message.rotations = commanded.rotations;
    message.positions = commanded.positions;
    message.pose = pose_message(arc.view.X_WC), message.focal = arc.view.lens.intrinsics().fx;
    witness_.calibration(message, arc.picture);
  }
  void seen(const RigSight& sight) override {
    // With or without record.cameras: what a calibration decides is only as good as what it looked at.
    const std::string& camera = name_of(sight.stance.camera);
    witness_.image(camera, sight.frame, logged_image(camera, sight.frame));
    CalibrationSightingMessage message;
    message.time = sight.frame.time, message.look = static_cast<std::int64_t>(sight.look);
    message.camera = camera, message.frame = sight.frame.number;
    message.pan = sight.stance.head.pan, message.tilt = sight.stance.head.tilt;
    message.zoom = sight.stance.head.zoom, message.stage = array_of(sight.stance.stage.offset);
    message.bends = bends_of(sight.pose);
    add_seen(sight, message);
    witness_.calibration(message, sight.frame.received);
    progress_.update(std::min(1.0, static_cast<double>(sight.look) / static_cast<double>(images_)),
                     run_.name);
  }
  void known(const RigStep& step) override {
    witness_.calibration(decision_message(step));
    const std::string what = step.is_found ? fmt::format("angle between the axes known within {:.4f} deg",
                                                         step.sigmas.angle / degree)
                                           : step.reason;
    witness_.event(step.time, Recorder::Level::info, run_.name,
                   fmt::format("after {} looks: {}", step.looks, what));
  }
  void decided(const LoopDecision& decision) override {
    CalibrationDecisionMessage message;
    message.time = decision.time, message.looks = static_cast<std::int64_t>(decision.looks);
    message.camera = name_of(decision.camera), message.step = decision.step;
    message.offset = decision.offset, message.accepted = decision.accepted, message.unit = decision.unit;
    message.next = decision.next;
    witness_.calibration(message);
    witness_.event(decision.time, Recorder::Level::info, run_.name,
                   fmt::format("{} of {}: {:.4g} {} off; {}", decision.step, name_of(decision.camera),
                               decision.offset, decision.unit, decision.next));
  }
  bool is_cancelled() override { return progress_.is_cancelled(); }

  // At `time` s; the last that is told.
  void ended(double time) {
    // With what a bundle knows in the end.
    CalibrationDecisionMessage message;
    if (!run_.loop && !run_.result.steps.empty()) message = decision_message(run_.result.steps.back());
    message.time = time, message.found = run_.is_done() && !run_.loop, message.ended = true;
    message.looks = static_cast<std::int64_t>(run_.loop ? run_.loop->pictures[0] + run_.loop->pictures[1]
                                                        : run_.result.looks);
    if (!run_.is_done()) message.reason = run_.reason();
    message.next = run_.is_done() ? "calibrated" : run_.reason();
    witness_.calibration(message);
    witness_.event(time, run_.is_done() ? Recorder::Level::info : Recorder::Level::error, run_.name,
                   message.next);
  }

 private:
  [[nodiscard]] const std::string& name_of(std::size_t camera) const {
    return run_.believed.cameras.at(camera).name;
  }

  void add_seen(const RigSight& sight, CalibrationSightingMessage& message) const {
    for (const SeenMarker& marker : sight.seen.markers)
      message.markers.push_back({marker.s, marker.pixel.x(), marker.pixel.y(), marker.sigma});
    for (const CurvePoint& point : sight.seen.points)
      message.points.push_back({point.pixel.x(), point.pixel.y(), point.sigma});
    message.unknown = static_cast<std::int64_t>(sight.seen.unknown);
    if (!sight.seen.reason.empty()) message.reason = sight.seen.reason;
    for (const SeenValue& value : sight.values) {
      if (!message.values) message.values.emplace();
      message.values->push_back({value.name, value.value});
    }
    if (const auto& circle = sight.circle)
      message.circle = {circle->center.x(), circle->center.y(), circle->radius, circle->is_verified};
    const std::vector<Eigen::Vector2d> ideal = ideal_axis(run_, sight);
    if (ideal.empty()) return;
    message.ideal.emplace();
    for (const Eigen::Vector2d& pixel : ideal) message.ideal->push_back({pixel.x(), pixel.y()});
  }

  CalibrationRun& run_;
  std::size_t images_;
  Witness& witness_;
  Progress& progress_;
  CommandedMotion& motion_;
  std::vector<ArmState> way_;  // Through the arcs.
};

}  // namespace

RigModel CalibrationRun::found() const {
  if (!loop) return result.found.model;
  RigModel model = believed;
  for (std::size_t i = 0; i < 2; ++i) {
    CameraConfig& camera = model.cameras[loop->stances[i].camera];
    if (const auto& by = loop->principal_point[i]) camera = with_principal_point_moved(camera, *by);
  }
  return model;
}

std::vector<Eigen::Vector2d> ideal_axis(const CalibrationRun& run, const RigSight& sight) {
  constexpr int count = 40;
  const auto arc = std::ranges::find(run.arcs, sight.stance.camera,
                                     [](const CommandedArc& commanded) { return commanded.ideal.camera; });
  if (arc == run.arcs.end()) return {};
  return backbone_pixels(run.believed.arm, sight.pose, arc->ideal.view, count);
}

CalibrationRun run_calibration(const Experiment& experiment, std::size_t task, const ArmState& from,
                               Filming& filming, Witness& witness, Progress& progress,
                               const RecordSteps& record_steps) {
  const auto& config = std::get<CalibrateTask>(experiment.task.at(task));
  const std::vector<CameraConfig> cameras = experiment.cameras();
  const RigSessionConfig session = session_config(config, experiment.arm, cameras, experiment.stand);
  CalibrationRun run;
  run.name = task_name(experiment.task[task]), run.task = task;
  run.is_before_etalon = is_before_etalon(config);
  run.believed = rig_model(experiment.arm.arm(), cameras);
  for (std::size_t i = 0; i < 2; ++i) run.cameras[i] = cameras[session.cameras[i]].name;
  RecordedPorts recorded(filming.ports(), from, record_steps);
  LoggedSession log(run, session.images, witness, progress, recorded.motion());
  if (is_loop(config)) {
    LoopConfig loop = loop_config(config, experiment.arm, cameras, experiment.stand);
    loop.draw = ideal_pictures(experiment);
    run.loop = calibrate_by_loop(recorded.ports(), run.believed, loop, log);
  } else {
    const RigPrior prior = session_prior(config, run.believed, experiment.stand);
    run.result = calibrate_rig_in_session(recorded.ports(), run.believed, prior, session, log);
  }
  const double end = recorded.finish();
  run.motion = recorded.motion().motion(end);
  log.ended(end);
  if (!run.is_done()) return run;
  const RigConfig truth = experiment.true_rig();
  run.truth = remainder(rig_model(truth.arm.arm(), truth.cameras),
                        {filming.true_stance(session.cameras[0]), filming.true_stance(session.cameras[1])},
                        run.loop ? run.loop->target : run.result.target);
  return run;
}

}  // namespace flexura
