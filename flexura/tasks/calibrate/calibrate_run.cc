#include "flexura/tasks/calibrate/calibrate_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/names.h"
#include "flexura/estimate/backbone_pixels.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/run_log.h"
#include "flexura/port/rig_ports.h"
#include "flexura/rig/commanded_motion.h"
#include "flexura/rig/ideal_picture.h"
#include "flexura/tasks/calibrate/calibration_messages.h"

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
  message.outliers = static_cast<std::int64_t>(step.outliers);
  message.angle = step.angle, message.angle_sigma = step.sigmas.angle;
  message.focal = step.focal, message.focal_sigma = step.sigmas.focal;
  message.zoom_ratio_sigma = step.sigmas.zoom_ratio;
  return message;
}

// Logs all events of a session.
class LoggedSession : public RigSessionWatcher {
 public:
  LoggedSession(CalibrationRun& run, std::size_t images, TaskStage& stage, CommandedMotion& motion)
      : run_(run), images_(images), stage_(stage), log_(stage.log), motion_(motion) {}

  void arm_sent(double time, const ArmState& state, double duration) override {
    motion_.send(time, state, duration);
    CalibrationMoveMessage message;
    message.time = time, message.device = "arm", message.bends = bends_of(state), message.duration = duration;
    log_.publish({calibration_moves_topic, message.time, message});
  }
  void camera_sent(double time, const RigStance& stance) override {
    CalibrationMoveMessage message;
    message.time = time, message.device = name_of(stance.camera);
    message.pan = stance.head.pan, message.tilt = stance.head.tilt, message.zoom = stance.head.zoom;
    message.stage = array_of(stance.stage.offset);
    log_.publish({calibration_moves_topic, message.time, message});
  }
  void planned(const IdealArc& arc) override {
    // From arc to arc via the arm's current state.
    way_.push_back(motion_.at(arc.time)), way_.push_back(arc.state);
    run_.arcs.push_back({arc, rotations_of(arc.state), stage_.motors_after(way_)});
    const CommandedArc& commanded = run_.arcs.back();
    CalibrationArcMessage message;
    message.time = arc.time, message.camera = name_of(arc.camera), message.plane = arc.plane;
    message.bends = bends_of(arc.state), message.rotations = commanded.rotations;
    message.positions = commanded.positions;
    message.pose = pose_message(arc.view.X_WC), message.focal = arc.view.lens.intrinsics().fx;
    log_.publish({calibration_arcs_topic, message.time, message});
    const std::string topic = ideal_image_topic(message.camera);
    log_.recorder().picture(topic, message.time, arc.picture);
  }
  void seen(const CameraObservation& observed) override {
    // Independent of record.cameras: the decisions of a calibration depend on its pictures.
    const std::string& camera = name_of(observed.stance.camera);
    log_.image(camera, observed.frame, logged_image(camera, observed.frame));
    CalibrationObservationMessage message;
    message.time = observed.frame.time, message.look = static_cast<std::int64_t>(observed.look);
    message.camera = camera, message.frame = observed.frame.number;
    message.pan = observed.stance.head.pan, message.tilt = observed.stance.head.tilt;
    message.zoom = observed.stance.head.zoom, message.stage = array_of(observed.stance.stage.offset);
    message.bends = bends_of(observed.pose);
    add_seen(observed, message);
    log_.publish({calibration_observations_topic, observed.frame.received, message});
    ++pictures_;
    stage_.progress.update(std::min(0.99, static_cast<double>(pictures_) / static_cast<double>(2 * images_)),
                           fmt::format("{}, picture {}", run_.name, pictures_));
  }
  void known(const RigStep& step) override {
    const CalibrationDecisionMessage message = decision_message(step);
    log_.publish({calibration_decisions_topic, message.time, message});
    constexpr double most = 90;  // In deg; beyond, nothing is known of an angle.
    const double sigma = step.sigmas.angle / degree;
    std::string what = step.reason;
    if (step.is_found)
      what = sigma < most ? fmt::format("angle between the axes: standard deviation {:.4f} deg", sigma)
                          : "angle between the axes not known yet";
    log_.event(step.time, Recorder::Level::info, run_.name,
               fmt::format("after {} looks: {}", step.looks, what));
  }
  void decided(const LoopDecision& decision) override {
    CalibrationDecisionMessage message;
    message.time = decision.time, message.looks = static_cast<std::int64_t>(decision.looks);
    message.camera = name_of(decision.camera), message.step = decision.step;
    message.offset = decision.offset, message.accepted = decision.accepted, message.unit = decision.unit;
    message.next = decision.next;
    log_.publish({calibration_decisions_topic, message.time, message});
    log_.event(decision.time, Recorder::Level::info, run_.name,
               fmt::format("{} of {}: offset {:.4g} {}; {}", decision.step, name_of(decision.camera),
                           decision.offset, decision.unit, decision.next));
  }
  bool is_cancelled() override { return stage_.progress.is_cancelled(); }

  // Logs the end at `time` s, the last message.
  void ended(double time) {
    // Includes the final results of a bundle.
    CalibrationDecisionMessage message;
    if (!run_.loop && !run_.result.steps.empty()) message = decision_message(run_.result.steps.back());
    message.time = time, message.found = run_.is_done() && !run_.loop, message.ended = true;
    message.looks = static_cast<std::int64_t>(run_.loop ? run_.loop->pictures[0] + run_.loop->pictures[1]
                                                        : run_.result.looks);
    if (!run_.is_done()) message.reason = run_.reason();
    message.next = run_.is_done() ? "calibrated" : run_.reason();
    log_.publish({calibration_decisions_topic, message.time, message});
    log_.event(time, run_.is_done() ? Recorder::Level::info : Recorder::Level::error, run_.name,
               message.next);
  }

 private:
  [[nodiscard]] const std::string& name_of(std::size_t camera) const {
    return run_.nominal.cameras.at(camera).name;
  }

  void add_seen(const CameraObservation& observed, CalibrationObservationMessage& message) const {
    for (const SeenMarker& marker : observed.seen.markers)
      message.markers.push_back({marker.s, marker.pixel.x(), marker.pixel.y(), marker.sigma});
    for (const CurvePoint& point : observed.seen.points)
      message.points.push_back({point.pixel.x(), point.pixel.y(), point.sigma});
    message.unknown = static_cast<std::int64_t>(observed.seen.unknown);
    if (!observed.seen.reason.empty()) message.reason = observed.seen.reason;
    for (const SeenValue& value : observed.values) {
      if (!message.values) message.values.emplace();
      message.values->push_back({value.name, value.value});
    }
    if (const auto& circle = observed.circle)
      message.circle = {circle->center.x(), circle->center.y(), circle->radius, circle->is_verified};
    const std::vector<Eigen::Vector2d> ideal = ideal_axis(run_, observed);
    if (ideal.empty()) return;
    message.ideal.emplace();
    for (const Eigen::Vector2d& pixel : ideal) message.ideal->push_back({pixel.x(), pixel.y()});
  }

  CalibrationRun& run_;
  std::size_t images_;        // Of a camera, at most.
  std::size_t pictures_ = 0;  // Of both.
  TaskStage& stage_;
  RunLog& log_;
  CommandedMotion& motion_;
  std::vector<ArmState> way_;  // Through the arcs.
};

}  // namespace

RigModel CalibrationRun::found() const {
  if (!loop) return result.found.model;
  RigModel model = nominal;
  for (std::size_t i = 0; i < 2; ++i) {
    CameraConfig& camera = model.cameras[loop->stances[i].camera];
    if (const auto& by = loop->principal_point[i]) camera = with_principal_point_moved(camera, *by);
  }
  return model;
}

std::vector<Eigen::Vector2d> ideal_axis(const CalibrationRun& run, const CameraObservation& observed) {
  constexpr int count = 40;
  const auto arc = std::ranges::find(run.arcs, observed.stance.camera,
                                     [](const CommandedArc& commanded) { return commanded.ideal.camera; });
  if (arc == run.arcs.end()) return {};
  return backbone_pixels(run.nominal.arm, observed.pose, arc->ideal.view, count);
}

CalibrationRun run_calibration(const CalibrateTask& task, const std::string& name, const Setup& setup,
                               const ArmState& from, TaskStage& stage) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  RigSessionConfig session = session_config(task, setup.arm, cameras, setup.stand);
  session.picture.scenes = arm_scenes(setup);
  CalibrationRun run;
  run.name = name;
  run.is_before_etalon = is_before_etalon(task);
  run.required = session.desired;
  run.nominal = rig_model(setup.arm_model(), cameras);
  for (std::size_t i = 0; i < 2; ++i) run.cameras[i] = cameras[session.cameras[i]].name;
  RecordedPorts recorded(stage.rig.ports(), from, stage.record_steps);
  LoggedSession log(run, most_images(task), stage, recorded.motion());
  if (is_loop(task)) {
    LoopConfig loop = loop_config(task, setup.arm, cameras, setup.stand);
    loop.picture.scenes = session.picture.scenes;
    loop.draw = ideal_pictures(setup);
    run.accepted = loop.accepted;
    run.loop = calibrate_by_loop(recorded.ports(), run.nominal, loop, log);
  } else {
    const RigPrior prior = session_prior(task, run.nominal, setup.stand);
    run.result = calibrate_rig_in_session(recorded.ports(), run.nominal, prior, session, log);
  }
  const double end = recorded.finish();
  run.motion = recorded.motion().motion(end);
  log.ended(end);
  RigTruth* truth = stage.rig.truth();
  if (!run.is_done() || truth == nullptr) return run;
  const RigConfig rig = setup.true_rig();
  run.truth = remainder(rig_model(rig.arm.arm(), rig.cameras),
                        {truth->stance(session.cameras[0]), truth->stance(session.cameras[1])},
                        run.loop ? run.loop->target : run.result.target);
  run.true_focal.emplace();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t camera = session.cameras[i];
    (*run.true_focal)[i] = Camera(rig.cameras[camera]).lens().at(truth->stance(camera).head.zoom).fx;
  }
  return run;
}

}  // namespace flexura
