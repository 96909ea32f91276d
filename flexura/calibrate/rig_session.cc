#include "flexura/calibrate/rig_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "flexura/base/bounded_text.h"
#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_excursion.h"
#include "flexura/calibrate/rig_observer.h"
#include "flexura/calibrate/rig_prediction.h"
#include "flexura/calibrate/rig_session_plan.h"
#include "flexura/camera/camera.h"

namespace flexura {
namespace {

// Larger standard deviations in messages are no numbers any more: nothing is known of an angle, or of a
// length of which there is as much uncertainty, %.
constexpr double most_degrees = 90;

using Error = RigCommander::Error;

void check(const RigSessionConfig& config) {
  const bool sees_nothing = config.picture.markers.empty() && !config.etalon;
  if (config.poses.empty() || sees_nothing || config.images < 3 || config.first < 1)
    throw std::invalid_argument("a calibration needs a pose, markers and at least 3 images");
}

class Session {
 public:
  Session(const RigPorts& ports, const RigModel& nominal, const RigPrior& prior,
          const RigSessionConfig& config, RigSessionWatcher& watcher)
      : nominal_(nominal),
        config_(config),
        watcher_(watcher),
        excursion_(ports, nominal, config.cameras, config.patience, config.move_duration, watcher),
        plan_(nominal, config),
        observer_(session_observer(nominal, prior, config, plan_.target(nominal))) {}

  RigSessionResult run() {
    Error error = excursion_.begin();
    for (std::size_t i = 0; i < 2; ++i) observer_->sent(i, excursion_.start()[i]);
    if (!error) error = look_and_move();
    if (error) {
      result_.is_done = false;
      result_.reason = *error + excursion_.retreat();
    }
    finish();
    return std::move(result_);
  }

 private:
  Error look_and_move() {
    for (std::size_t i = 0; i < config_.first; ++i)
      if (auto error =
              look({pose(i), {plan_.first(excursion_.stances()[0]), plan_.first(excursion_.stances()[1])}}))
        return error;
    while (result_.looks + 1 < config_.images) {
      if (auto error = calibrate()) return error;
      if (found_ && is_enough()) break;
      if (auto error = look(next())) return error;
    }
    if (!found_ || result_.steps.back().looks < result_.looks)
      if (auto error = calibrate()) return error;
    if (!found_) return "no rig explains the observations: " + result_.steps.back().reason;
    if (auto error = move()) return error;
    if (auto error = calibrate()) return error;
    if (!found_) return "no rig explains the pictures after the move: " + result_.steps.back().reason;
    constexpr double unrecoverable = 3 * degree;
    if (const double sigma = result_.steps.back().sigmas.angle; !(sigma < unrecoverable))
      return fmt::format(
          "the standard deviation of the angle between the axes is still {} deg: use more images, other "
          "poses or larger ranges of the heads",
          bounded_text(sigma / degree, most_degrees));
    result_.is_done = true;
    return std::nullopt;
  }

  [[nodiscard]] const ArmState& pose(std::size_t number) const {
    return config_.poses[number % config_.poses.size()];
  }
  [[nodiscard]] const RigModel& model() const { return found_ ? found_->model : nominal_; }

  // Bends the arm into a pose and takes a picture from each stance.
  Error look(const ViewCandidate& what) {
    if (watcher_.is_cancelled()) return "cancelled";
    if (!config_.etalon)
      if (auto error = excursion_.show(what.pose)) return error;
    for (const RigStance& stance : what.stances)
      if (auto error = send(stance)) return error;
    if (auto error = excursion_.settle()) return error;
    ++result_.looks;
    const auto arm = excursion_.arm();
    if (const auto* why = std::get_if<std::string>(&arm)) return *why;
    pose_ = std::get<ArmState>(arm);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      if (auto error = picture(i)) return error;
      // As long as no rig is found, the arm may be bent out of view.
      if (!found_ && misses_[i] > 0) {
        const bool is_there = observer_->seen_at().has_value();
        const std::string at_first = observed_.seen.reason;
        if (auto error = search(i)) return error;
        if (misses_[i] > 0 && result_.looks == 1) return not_found(i, is_there, at_first);
      }
      constexpr int patience = 3;
      if (misses_[i] >= patience)
        return fmt::format("camera {} does not see the {} in {} successive pictures: {}", name(i), what_,
                           patience, observed_.seen.reason);
    }
    return std::nullopt;
  }

  Error send(const RigStance& stance) {
    const std::size_t i = stance.camera == config_.cameras[0] ? 0 : 1;
    const RigStance& stands = excursion_.stances()[i];
    if (stance.head == stands.head && stance.stage == stands.stage) return std::nullopt;
    observer_->sent(i, stance);
    return excursion_.send(i, stance);
  }
  [[nodiscard]] const std::string& name(std::size_t i) const {
    return nominal_.cameras[config_.cameras[i]].name;
  }
  [[nodiscard]] std::string not_found(std::size_t i, bool is_there, const std::string& why) const {
    const std::string where = is_there ? fmt::format("camera {} does not see the whole {}", name(i), what_)
                                       : fmt::format("the {} is out of view of camera {}", what_, name(i));
    return fmt::format("{}, not even with the head turned by {:.3g} rad in every direction: {}", where,
                       config_.search, why);
  }

  // Takes a picture and measures it; useful ones are added to the observations.
  Error picture(std::size_t i, bool is_search = false) {
    auto taken = excursion_.picture(i, is_search ? 0 : result_.looks);
    if (const auto* why = std::get_if<std::string>(&taken)) return *why;
    observed_ = std::get<CameraObservation>(std::move(taken)), observed_.pose = pose_;
    observer_->see(i, before(), observed_);
    ++result_.pictures[i];
    const std::size_t fewest = found_ ? std::min(RigObserver::few, config_.fewest) : config_.fewest;
    const bool is_of_use = observed_.seen.markers.size() >= fewest;
    if (!is_of_use && observed_.seen.reason.empty())
      observed_.seen.reason =
          fmt::format("{} markers were identified, fewer than {}", observed_.seen.markers.size(), fewest);
    misses_[i] = is_of_use ? 0 : misses_[i] + 1;
    if (!is_of_use) missed_.push_back({observed_.pose, {observed_.stance}});
    watcher_.seen(observed_);
    if (!result_.before[i]) result_.before[i] = observed_;
    result_.after[i] = observed_;
    return std::nullopt;
  }

  [[nodiscard]] const RigModel* before() const { return found_ ? &found_->model : nullptr; }

  [[nodiscard]] RigStance commanded(const RigStance& stance) const {
    return flexura::commanded(Camera(nominal_.cameras[stance.camera]), stance);
  }
  Error try_from(std::size_t i, const RigStance& stance) {
    if (auto error = send(commanded(stance))) return error;
    if (auto error = excursion_.settle()) return error;
    return picture(i, true);
  }

  // Turns towards the visible part of the target until all of it is visible.
  Error approach(std::size_t i) {
    constexpr int most = 4;
    for (int turn = 0; turn < most && misses_[i] > 0; ++turn) {
      const auto seen = observer_->seen_at();
      if (!seen) return std::nullopt;
      const Intrinsics lens = view_of(model(), excursion_.stances()[i]).lens.intrinsics();
      RigStance stance = excursion_.stances()[i];
      stance.head = turned_towards(stance.head, lens, *seen - Eigen::Vector2d(lens.cx, lens.cy));
      if (auto error = try_from(i, stance)) return error;
    }
    return std::nullopt;
  }

  // Turns the head around its position until enough of the arm is visible; otherwise back. A failed search
  // counts as one miss.
  Error search(std::size_t i) {
    const RigStance middle = excursion_.stances()[i];
    const int misses = misses_[i];
    if (auto error = approach(i)) return error;
    if (misses_[i] == 0) return std::nullopt;
    for (const Eigen::Vector2d& way : plan_.search_directions()) {
      RigStance stance = middle;
      stance.head.pan += way.x(), stance.head.tilt += way.y();
      if (auto error = try_from(i, stance)) return error;
      if (misses_[i] == 0) return std::nullopt;
    }
    misses_[i] = misses;
    if (auto error = send(middle)) return error;
    return excursion_.settle();
  }

  Error calibrate() {
    RigReading reading = observer_->read(before());
    problem_ = std::move(reading.problem);
    RigCalibration& found = reading.found;
    RigStep& step = result_.steps.emplace_back();
    step.time = excursion_.now(), step.looks = result_.looks;
    step.is_found = found.is_found, step.reason = found.reason, step.rms = found.rms;
    step.outliers = found.outliers.size();
    found_.reset();
    if (!found.is_found) {
      step.next = config_.etalon ? "a view to the side: no rig is known yet"
                                 : "another pose from the present head positions: no rig is known yet";
      watcher_.known(step);
      return std::nullopt;
    }
    found_ = std::move(found);
    desired_ = plan_.desired(found_->model, excursion_.stances());
    plan_.know(problem_->variables(), *found_, desired_, step);
    choose(step);
    watcher_.known(step);
    return plan_.error_with(found_->model, desired_, step, excursion_.home());
  }

  // Chooses the next look, if the session continues.
  void choose(RigStep& step) {
    next_.reset();
    if (result_.looks + 1 >= config_.images || is_enough()) {
      step.next = result_.looks < config_.images && !has_moved_
                      ? "the move to the target configuration, and a view that verifies it"
                      : "";
      return;
    }
    const auto [candidate, why] = plan_.next(*problem_, *found_, desired_, excursion_.stances(), missed_);
    next_ = candidate, step.next = why;
  }
  [[nodiscard]] ViewCandidate next() const {
    if (next_) return *next_;
    ViewCandidate another{pose(result_.looks), {excursion_.stances()[0], excursion_.stances()[1]}};
    // A fixed target looks the same from the same place.
    constexpr double aside = 0.03;  // rad
    for (RigStance& stance : another.stances) {
      if (!config_.etalon) break;
      stance.head.pan += result_.looks % 2 == 0 ? -aside : aside;
      stance = commanded(stance);
    }
    return another;
  }
  [[nodiscard]] bool is_enough() const {
    const RigSigmas &is = result_.steps.back().sigmas, &desired = config_.desired;
    return result_.looks >= config_.first && is.angle <= desired.angle && is.focal[0] <= desired.focal[0] &&
           is.focal[1] <= desired.focal[1] && is.zoom_ratio <= desired.zoom_ratio;
  }

  // Moves the cameras to the wanted configuration and verifies it with new pictures.
  Error move() {
    has_moved_ = true;
    result_.desired = desired_;
    if (auto error = look({pose(0), {desired_.stances[0], desired_.stances[1]}})) return error;
    for (std::size_t i = 0; i < 2; ++i) {
      if (misses_[i] > 0)
        return fmt::format("after the move, the {} is not visible for camera {}: {}", what_, name(i),
                           result_.after[i]->seen.reason);
      const CameraObservation& observed = *result_.after[i];
      // Marker and border positions have a minimum error, whatever the noise of a picture.
      constexpr double least = 0.5, most = 4;  // px; standard deviations.
      const RigPrediction prediction = predict_image(*problem_, *found_, observed.stance, observed.pose,
                                                     observer_->image_of_observed(model(), observed), least);
      result_.verified[i] = prediction.px;
      if (!(prediction.sigmas <= most))
        return fmt::format(
            "after the move, camera {} sees the {} at a distance of {} px from its predicted position, "
            "which is {} standard deviations. The head may have backlash or was pushed{}",
            name(i), what_, bounded_text(prediction.px, 1000, 3), bounded_text(prediction.sigmas, 1000, 3),
            config_.etalon ? "" : ", or the arm does not bend reproducibly");
    }
    return std::nullopt;
  }

  void finish() {
    if (!found_ || !problem_) return;
    for (const RigImage& image : problem_->observations().images)
      result_.markers += image.markers.size(), result_.points += image.points.size(),
          result_.etalon_points += image.etalon.size();
    result_.observability = observability(problem_->variables(), found_->covariance);
    const Eigen::Vector3d target = plan_.target(found_->model);
    result_.target = target, result_.start = excursion_.start();
    result_.start_remainder = remainder(found_->model, excursion_.start(), target);
    result_.nominal_remainder =
        remainder(found_->model, plan_.desired(nominal_, excursion_.start()).stances, target);
    for (RigStep& step : result_.steps)
      if (step.is_found) step.remainder = remainder(found_->model, step.desired, target);
    // Estimated true camera positions.
    if (observer_->stance(0) && observer_->stance(1) && result_.is_done)
      result_.remainder =
          remainder(found_->model,
                    {found_->stances[*observer_->stance(0)], found_->stances[*observer_->stance(1)]}, target);
    result_.found = std::move(*found_);
    if (result_.is_done) note_what_is_unknown(result_.steps.back().sigmas);
  }

  // Adds notes on what is known less precisely than wanted.
  void note_what_is_unknown(const RigSigmas& is) {
    const RigSigmas& desired = config_.desired;
    const auto note = [&](const std::string& what, double known, double asked, const char* unit) {
      if (known > asked)
        result_.desired.notes.push_back(
            fmt::format("standard deviation of {}: {}{}, required {:.2g}: take more pictures", what,
                        bounded_text(known, most_degrees), unit, asked));
    };
    note("the angle between the axes", is.angle / degree, desired.angle / degree, " degrees");
    for (std::size_t i = 0; i < 2; ++i)
      note(fmt::format("the focal length of camera {}", name(i)), 100 * is.focal[i], 100 * desired.focal[i],
           " %");
    note("the zoom ratio", 100 * is.zoom_ratio, 100 * desired.zoom_ratio, " %");
    // For an accurate arm model, residuals are about half of the stated standard deviations.
    constexpr double suspicious_rms = 1.2;
    if (result_.found.rms > suspicious_rms)
      result_.desired.notes.push_back(fmt::format(
          "the residuals of the best rig are {:.2g} standard deviations (root mean square). The arm may bend "
          "differently from its model, and errors of estimated shapes may be larger than stated",
          result_.found.rms));
  }

  const RigModel& nominal_;
  const RigSessionConfig& config_;
  RigSessionWatcher& watcher_;
  RigExcursion excursion_;
  RigSessionPlan plan_;
  std::unique_ptr<RigObserver> observer_;
  const char* what_ = config_.etalon ? "cylinder" : "arm";
  RigSessionResult result_;

  bool has_moved_ = false;
  ArmState pose_;  // Pose in the last look, as measured by the drives.
  std::array<int, 2> misses_ = {0, 0};
  std::vector<ViewCandidate> missed_;  // Looks of one camera at which too little was visible.
  CameraObservation observed_;         // The last one.
  std::optional<RigProblem> problem_;
  std::optional<RigCalibration> found_;
  DesiredRig desired_;
  std::optional<ViewCandidate> next_;
};

}  // namespace

RigSessionResult calibrate_rig_in_session(const RigPorts& ports, const RigModel& nominal,
                                          const RigPrior& prior, const RigSessionConfig& config,
                                          RigSessionWatcher& watcher) {
  check(config);
  return Session(ports, nominal, prior, config, watcher).run();
}

}  // namespace flexura
