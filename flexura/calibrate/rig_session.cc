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
#include "flexura/calibrate/rig_eyes.h"
#include "flexura/calibrate/rig_foretelling.h"
#include "flexura/calibrate/rig_session_plan.h"
#include "flexura/calibrate/rig_trip.h"
#include "flexura/camera/camera.h"

namespace flexura {
namespace {

// Larger standard deviations in messages are no numbers any more: nothing is known of an angle, or of a
// length of which there is as much uncertainty, %.
constexpr double most_degrees = 90;

using Trouble = RigHands::Trouble;

void check(const RigSessionConfig& config) {
  const bool sees_nothing = config.picture.markers.empty() && !config.etalon;
  if (config.poses.empty() || sees_nothing || config.images < 3 || config.first < 1)
    throw std::invalid_argument("a calibration needs a pose, markers and at least 3 images");
}

class Session {
 public:
  Session(const RigPorts& ports, const RigModel& believed, const RigPrior& prior,
          const RigSessionConfig& config, RigSessionWatcher& watcher)
      : believed_(believed),
        config_(config),
        watcher_(watcher),
        trip_(ports, believed, config.cameras, config.patience, config.move_duration, watcher),
        plan_(believed, config),
        eyes_(session_eyes(believed, prior, config, plan_.target(believed))) {}

  RigSessionResult run() {
    Trouble trouble = trip_.begin();
    for (std::size_t i = 0; i < 2; ++i) eyes_->sent(i, trip_.start()[i]);
    if (!trouble) trouble = look_and_move();
    if (trouble) {
      result_.is_done = false;
      result_.reason = *trouble + trip_.retreat();
    }
    finish();
    return std::move(result_);
  }

 private:
  Trouble look_and_move() {
    for (std::size_t i = 0; i < config_.first; ++i)
      if (auto trouble = look({pose(i), {plan_.first(trip_.stances()[0]), plan_.first(trip_.stances()[1])}}))
        return trouble;
    while (result_.looks + 1 < config_.images) {
      if (auto trouble = calibrate()) return trouble;
      if (found_ && is_enough()) break;
      if (auto trouble = look(next())) return trouble;
    }
    if (!found_ || result_.steps.back().looks < result_.looks)
      if (auto trouble = calibrate()) return trouble;
    if (!found_) return "no rig explains what was seen: " + result_.steps.back().reason;
    if (auto trouble = move()) return trouble;
    if (auto trouble = calibrate()) return trouble;
    if (!found_) return "what is seen after the move fits nothing: " + result_.steps.back().reason;
    constexpr double hopeless = 3 * degree;
    if (const double sigma = result_.steps.back().sigmas.angle; !(sigma < hopeless))
      return fmt::format(
          "the pictures tell the angle between the axes to {} deg only: more images, other poses or "
          "turns of the heads tell more",
          bounded_text(sigma / degree, most_degrees));
    result_.is_done = true;
    return std::nullopt;
  }

  [[nodiscard]] const ArmState& pose(std::size_t number) const {
    return config_.poses[number % config_.poses.size()];
  }
  [[nodiscard]] const RigModel& model() const { return found_ ? found_->model : believed_; }

  // Bends the arm into a pose and takes a picture from each stance.
  Trouble look(const ViewCandidate& what) {
    if (watcher_.is_cancelled()) return "cancelled";
    if (!config_.etalon)
      if (auto trouble = trip_.show(what.pose)) return trouble;
    for (const RigStance& stance : what.stances)
      if (auto trouble = send(stance)) return trouble;
    if (auto trouble = trip_.settle()) return trouble;
    ++result_.looks;
    const auto arm = trip_.arm();
    if (const auto* why = std::get_if<std::string>(&arm)) return *why;
    pose_ = std::get<ArmState>(arm);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      if (auto trouble = picture(i)) return trouble;
      // As long as no rig is found, the arm may be bent out of view.
      if (!found_ && misses_[i] > 0) {
        const bool is_there = eyes_->whereabouts().has_value();
        const std::string at_first = sight_.seen.reason;
        if (auto trouble = search(i)) return trouble;
        if (misses_[i] > 0 && result_.looks == 1) return not_found(i, is_there, at_first);
      }
      constexpr int patience = 3;
      if (misses_[i] >= patience)
        return fmt::format("camera {} does not see the {} in {} pictures in a row: {}", name(i), what_,
                           patience, sight_.seen.reason);
    }
    return std::nullopt;
  }

  Trouble send(const RigStance& stance) {
    const std::size_t i = stance.camera == config_.cameras[0] ? 0 : 1;
    const RigStance& stands = trip_.stances()[i];
    if (stance.head == stands.head && stance.stage == stands.stage) return std::nullopt;
    eyes_->sent(i, stance);
    return trip_.send(i, stance);
  }
  [[nodiscard]] const std::string& name(std::size_t i) const {
    return believed_.cameras[config_.cameras[i]].name;
  }
  [[nodiscard]] std::string not_found(std::size_t i, bool is_there, const std::string& why) const {
    const std::string where = is_there ? fmt::format("camera {} does not see all of the {}", name(i), what_)
                                       : fmt::format("the {} is out of view of camera {}", what_, name(i));
    return fmt::format("{}, also {:.3g} rad to all sides: {}", where, config_.search, why);
  }

  // Takes a picture and measures it; useful ones are added to the observations.
  Trouble picture(std::size_t i, bool is_search = false) {
    auto taken = trip_.picture(i, is_search ? 0 : result_.looks);
    if (const auto* why = std::get_if<std::string>(&taken)) return *why;
    sight_ = std::get<RigSight>(std::move(taken)), sight_.pose = pose_;
    eyes_->see(i, before(), sight_);
    ++result_.pictures[i];
    const std::size_t fewest = found_ ? std::min(RigEyes::few, config_.fewest) : config_.fewest;
    const bool is_of_use = sight_.seen.markers.size() >= fewest;
    if (!is_of_use && sight_.seen.reason.empty())
      sight_.seen.reason =
          fmt::format("{} markers are recognised, fewer than {}", sight_.seen.markers.size(), fewest);
    misses_[i] = is_of_use ? 0 : misses_[i] + 1;
    if (!is_of_use) missed_.push_back({sight_.pose, {sight_.stance}});
    watcher_.seen(sight_);
    if (!result_.before[i]) result_.before[i] = sight_;
    result_.after[i] = sight_;
    return std::nullopt;
  }

  [[nodiscard]] const RigModel* before() const { return found_ ? &found_->model : nullptr; }

  [[nodiscard]] RigStance commanded(const RigStance& stance) const {
    return flexura::commanded(Camera(believed_.cameras[stance.camera]), stance);
  }
  Trouble try_from(std::size_t i, const RigStance& stance) {
    if (auto trouble = send(commanded(stance))) return trouble;
    if (auto trouble = trip_.settle()) return trouble;
    return picture(i, true);
  }

  // Turns towards the visible part of the target until all of it is visible.
  Trouble approach(std::size_t i) {
    constexpr int most = 4;
    for (int turn = 0; turn < most && misses_[i] > 0; ++turn) {
      const auto seen = eyes_->whereabouts();
      if (!seen) return std::nullopt;
      const Intrinsics lens = view_of(model(), trip_.stances()[i]).lens.intrinsics();
      RigStance stance = trip_.stances()[i];
      stance.head = turned_towards(stance.head, lens, *seen - Eigen::Vector2d(lens.cx, lens.cy));
      if (auto trouble = try_from(i, stance)) return trouble;
    }
    return std::nullopt;
  }

  // Turns the head around its position until enough of the arm is visible; otherwise back. A failed search
  // counts as one miss.
  Trouble search(std::size_t i) {
    const RigStance middle = trip_.stances()[i];
    const int misses = misses_[i];
    if (auto trouble = approach(i)) return trouble;
    if (misses_[i] == 0) return std::nullopt;
    for (const Eigen::Vector2d& way : plan_.search_ways()) {
      RigStance stance = middle;
      stance.head.pan += way.x(), stance.head.tilt += way.y();
      if (auto trouble = try_from(i, stance)) return trouble;
      if (misses_[i] == 0) return std::nullopt;
    }
    misses_[i] = misses;
    if (auto trouble = send(middle)) return trouble;
    return trip_.settle();
  }

  Trouble calibrate() {
    RigReading reading = eyes_->read(before());
    problem_ = std::move(reading.problem);
    RigCalibration& found = reading.found;
    RigStep& step = result_.steps.emplace_back();
    step.time = trip_.now(), step.looks = result_.looks;
    step.is_found = found.is_found, step.reason = found.reason, step.rms = found.rms;
    step.doubts = found.doubts.size();
    found_.reset();
    if (!found.is_found) {
      step.next = config_.etalon ? "a little aside: nothing is known yet"
                                 : "another pose from where the heads stand: nothing is known yet";
      watcher_.known(step);
      return std::nullopt;
    }
    found_ = std::move(found);
    wanted_ = plan_.wanted(found_->model, trip_.stances());
    plan_.know(problem_->variables(), *found_, wanted_, step);
    choose(step);
    watcher_.known(step);
    return plan_.trouble_with(found_->model, wanted_, step, trip_.home());
  }

  // Chooses the next look, if the session continues.
  void choose(RigStep& step) {
    next_.reset();
    if (result_.looks + 1 >= config_.images || is_enough()) {
      step.next =
          result_.looks < config_.images && !has_moved_ ? "the move, and a look that verifies it" : "";
      return;
    }
    const auto [candidate, why] = plan_.next(*problem_, *found_, wanted_, trip_.stances(), missed_);
    next_ = candidate, step.next = why;
  }
  [[nodiscard]] ViewCandidate next() const {
    if (next_) return *next_;
    ViewCandidate another{pose(result_.looks), {trip_.stances()[0], trip_.stances()[1]}};
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
    const RigSigmas &is = result_.steps.back().sigmas, &wanted = config_.wanted;
    return result_.looks >= config_.first && is.angle <= wanted.angle && is.focal[0] <= wanted.focal[0] &&
           is.focal[1] <= wanted.focal[1] && is.zoom_ratio <= wanted.zoom_ratio;
  }

  // Moves the cameras to the wanted configuration and verifies it with new pictures.
  Trouble move() {
    has_moved_ = true;
    result_.wanted = wanted_;
    if (auto trouble = look({pose(0), {wanted_.stances[0], wanted_.stances[1]}})) return trouble;
    for (std::size_t i = 0; i < 2; ++i) {
      if (misses_[i] > 0)
        return fmt::format("the {} is not seen by camera {} after the move: {}", what_, name(i),
                           result_.after[i]->seen.reason);
      const RigSight& sight = *result_.after[i];
      // Marker and border positions have a minimum error, whatever the noise of a picture.
      constexpr double least = 0.5, most = 4;  // px; standard deviations.
      const RigForetelling foretelling =
          foretell(*problem_, *found_, sight.stance, sight.pose, eyes_->told(model(), sight), least);
      result_.verified[i] = foretelling.px;
      if (!(foretelling.sigmas <= most))
        return fmt::format(
            "camera {} sees the {} {} px from where it was foretold after the move, which is {} "
            "times what is not known: a head with play, or one that was pushed{}",
            name(i), what_, bounded_text(foretelling.px, 1000, 3), bounded_text(foretelling.sigmas, 1000, 3),
            config_.etalon ? "" : ", or an arm that bends otherwise each time");
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
    result_.target = target, result_.start = trip_.start();
    result_.start_remainder = remainder(found_->model, trip_.start(), target);
    result_.believed_remainder =
        remainder(found_->model, plan_.wanted(believed_, trip_.start()).stances, target);
    for (RigStep& step : result_.steps)
      if (step.is_found) step.remainder = remainder(found_->model, step.wanted, target);
    // Estimated true camera positions.
    if (eyes_->stance(0) && eyes_->stance(1) && result_.is_done)
      result_.remainder = remainder(
          found_->model, {found_->stances[*eyes_->stance(0)], found_->stances[*eyes_->stance(1)]}, target);
    result_.found = std::move(*found_);
    if (result_.is_done) note_what_is_unknown(result_.steps.back().sigmas);
  }

  // Adds notes on what is known less precisely than wanted.
  void note_what_is_unknown(const RigSigmas& is) {
    const RigSigmas& wanted = config_.wanted;
    const auto note = [&](const std::string& what, double known, double asked, const char* unit) {
      if (known > asked)
        result_.wanted.notes.push_back(
            fmt::format("{} known to {}{}, where {:.2g} is wanted: more pictures tell it better", what,
                        bounded_text(known, most_degrees), unit, asked));
    };
    note("the angle between the axes is", is.angle / degree, wanted.angle / degree, " degrees");
    for (std::size_t i = 0; i < 2; ++i)
      note(fmt::format("the focal length of camera {} is", name(i)), 100 * is.focal[i], 100 * wanted.focal[i],
           " %");
    note("the zoom ratio is", 100 * is.zoom_ratio, 100 * wanted.zoom_ratio, " %");
    // For an accurate arm model, residuals are about half of the stated standard deviations.
    constexpr double suspicious_rms = 1.2;
    if (result_.found.rms > suspicious_rms)
      result_.wanted.notes.push_back(fmt::format(
          "the pictures differ from the best rig by {:.2g} standard deviations (root mean square): the "
          "arm may bend otherwise than is believed, and shapes that are seen may be wrong by more than "
          "is stated",
          result_.found.rms));
  }

  const RigModel& believed_;
  const RigSessionConfig& config_;
  RigSessionWatcher& watcher_;
  RigTrip trip_;
  RigSessionPlan plan_;
  std::unique_ptr<RigEyes> eyes_;
  const char* what_ = config_.etalon ? "cylinder" : "arm";
  RigSessionResult result_;

  bool has_moved_ = false;
  ArmState pose_;  // Pose in the last look, as measured by the drives.
  std::array<int, 2> misses_ = {0, 0};
  std::vector<ViewCandidate> missed_;  // Looks of one camera at which too little was visible.
  RigSight sight_;                     // The last one.
  std::optional<RigProblem> problem_;
  std::optional<RigCalibration> found_;
  WantedRig wanted_;
  std::optional<ViewCandidate> next_;
};

}  // namespace

RigSessionResult calibrate_rig_in_session(const RigPorts& ports, const RigModel& believed,
                                          const RigPrior& prior, const RigSessionConfig& config,
                                          RigSessionWatcher& watcher) {
  check(config);
  return Session(ports, believed, prior, config, watcher).run();
}

}  // namespace flexura
