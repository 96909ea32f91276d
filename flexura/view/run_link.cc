#include "flexura/view/run_link.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "flexura/log/logged_message.h"
#include "flexura/rig/filming.h"
#include "flexura/tasks/calibrate/calibration_messages.h"
#include "flexura/tasks/servo/servo_messages.h"

namespace flexura {
namespace {

// Keeps an observation, replacing the previous one of the same camera.
template <class Picture, class Observation>
void keep(std::vector<Picture>& pictures, const Observation& observation, std::int64_t frame) {
  const auto same = std::ranges::find_if(
      pictures, [&](const Picture& picture) { return picture.observation.camera == observation.camera; });
  if (same == pictures.end()) {
    pictures.push_back({observation, frame});
  } else {
    same->observation = observation, same->number = frame;
  }
}

// The usual simulated rig, which stays when the run is over.
class LeftRig : public Rig {
 public:
  LeftRig(const Setup& setup, RunLink& link) : filming_(setup), link_(link) {}
  ~LeftRig() override { link_.leave(filming_.give_away()); }
  LeftRig(const LeftRig&) = delete;
  LeftRig& operator=(const LeftRig&) = delete;

  [[nodiscard]] RigPorts ports() override { return filming_.ports(); }
  [[nodiscard]] RigTruth* truth() override { return filming_.truth(); }
  [[nodiscard]] bool is_simulated() const override { return filming_.is_simulated(); }
  void play_to(double time, const ArmState& state, const TakeFrame& take) override {
    filming_.play_to(time, state, take);
  }
  void pass_to(double time, const ArmState& state) override { filming_.pass_to(time, state); }
  void skip_to_now() override { filming_.skip_to_now(); }

 private:
  Filming filming_;
  RunLink& link_;
};

}  // namespace

void RunLink::update(double fraction, std::string_view what) {
  if (also_ != nullptr) also_->update(fraction, what);
  const std::lock_guard lock(mutex_);
  news_.fraction = fraction;
  news_.what.assign(what);
}

void RunLink::state(double time, const ArmState& state, std::span<const CameraReading> cameras) {
  constexpr double rounding = 1e-9;  // s
  std::unique_lock lock(mutex_);
  may_go_.wait(lock, [&] { return cancelled_ || time <= allowed_ + rounding; });
  news_.time = time;
  news_.state = state;
  news_.cameras.assign(cameras.begin(), cameras.end());
  // Keeps steps of the last seconds, because pictures are measured some time after their exposure.
  constexpr double remembered = 3, between = 1e-3;  // s
  if (!steps_.empty() && time - steps_.back().time < between) steps_.pop_back();
  steps_.push_back({time, state, news_.cameras});
  while (steps_.front().time < time - remembered) steps_.pop_front();
  while (!truths_.empty() && truths_.front().first < time - remembered) truths_.pop_front();
}

const RunLink::Step* RunLink::step_at(double time) const {
  if (steps_.empty()) return nullptr;
  const auto after = std::ranges::lower_bound(steps_, time, {}, &Step::time);
  if (after == steps_.end()) return &steps_.back();
  if (after == steps_.begin() || after->time - time < time - (after - 1)->time) return &*after;
  return &*(after - 1);
}

// Completes `seen` by the state, readings and truth at its time.
void RunLink::measured(Measured seen) {
  const Step* step = step_at(seen.time);
  if (step == nullptr) return;
  if (seen.state.bends.size() != step->state.bends.size()) seen.state = step->state;
  const auto of_camera = [&](const Measured& other) { return other.camera == seen.camera; };
  double nearest = 0.1;  // s
  for (const auto& [time, truth] : truths_)
    if (const double off = std::abs(time - seen.time); off < nearest) nearest = off, seen.truth = truth;
  if (!seen.reading) seen.readings = step->cameras;
  std::erase_if(news_.measured, of_camera);
  news_.measured.push_back(std::move(seen));
}

void RunLink::truth(double time, const TrueArm& arm) {
  auto reported = std::make_shared<const TrueArm>(arm);
  const std::lock_guard lock(mutex_);
  news_.truth = reported;
  truths_.emplace_back(time, std::move(reported));
}

void RunLink::happened(double time, const std::string& level, const std::string& name,
                       const std::string& text) {
  constexpr std::size_t most = 50;
  const std::lock_guard lock(mutex_);
  if (events_.size() == most) events_.pop_front();
  events_.push_back({time, level, name, text});
}

std::vector<RunLink::Event> RunLink::take_events(std::size_t most) {
  const std::lock_guard lock(mutex_);
  const auto end = events_.begin() + static_cast<std::ptrdiff_t>(std::min(most, events_.size()));
  std::vector<Event> taken(events_.begin(), end);
  events_.erase(events_.begin(), end);
  return taken;
}

void RunLink::decided(const CalibrationDecisionMessage& decision) {
  if (decision.ended.value_or(false)) {
    news_.calibration.reset();
    news_.measured.clear();
  } else {
    if (!news_.calibration) news_.calibration.emplace();
    news_.calibration->decision = decision;
  }
}

void RunLink::logged(const LoggedMessage& message) {
  const std::lock_guard lock(mutex_);
  if (const auto* observation = message.as<ServoObservationMessage>()) {
    keep(pictures_, *observation, observation->frame);
    measured({.camera = observation->camera,
              .frame = observation->frame,
              .time = observation->time,
              .state = {},
              .reading = {},
              .readings = {},
              .truth = {}});
    return;
  }
  if (const auto* step = message.as<ServoStep>()) {
    news_.servo = ShownServo{*step, pictures_};
  } else if (const auto* seen = message.as<CalibrationObservationMessage>()) {
    if (!news_.calibration) news_.calibration.emplace();
    keep(news_.calibration->pictures, *seen, seen->frame);
    ArmState state = ArmState::straight(seen->bends.size());
    for (std::size_t i = 0; i < seen->bends.size(); ++i)
      state.bends[i] = {seen->bends[i][0], seen->bends[i][1]};
    measured({.camera = seen->camera,
              .frame = seen->frame,
              .time = seen->time,
              .state = std::move(state),
              .reading = CameraReading{{seen->pan, seen->tilt, seen->zoom},
                                       {{seen->stage[0], seen->stage[1], seen->stage[2]}}},
              .readings = {},
              .truth = {}});
  } else if (const auto* decision = message.as<CalibrationDecisionMessage>()) {
    decided(*decision);
  } else {
    return;
  }
  ++news_.changes;
}

void RunLink::task_ended() {
  const std::lock_guard lock(mutex_);
  pictures_.clear();
  news_.measured.clear();
  news_.servo.reset();
  news_.calibration.reset();
  ++news_.changes;
}

void RunLink::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
  may_go_.notify_all();
}

void RunLink::pace_to(double time) {
  const std::lock_guard lock(mutex_);
  allowed_ = time;
  may_go_.notify_all();
}

void RunLink::leave(std::unique_ptr<SimulatedRig> rig) {
  const std::lock_guard lock(mutex_);
  rig_ = std::move(rig);
}

std::unique_ptr<SimulatedRig> RunLink::take_rig() {
  const std::lock_guard lock(mutex_);
  return std::move(rig_);
}

void RunLink::finish(End end) {
  const std::lock_guard lock(mutex_);
  news_.end = std::move(end);
}

RunLink::News RunLink::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link) {
  RunLink::End end{"failed", "", {}};
  try {
    const RunResult result = run_experiment(experiment, folder, link, &link, [&](const Setup& setup) {
      return std::make_unique<LeftRig>(setup, link);
    });
    end.outcome = name_of(result.outcome);
    end.folder = folder;
    end.text = result.reasons.empty() ? result.headline : result.reasons.front();
  } catch (const std::exception& error) {
    end.text = error.what();
  }
  link.finish(std::move(end));
}

}  // namespace flexura
