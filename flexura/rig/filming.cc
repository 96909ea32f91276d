#include "flexura/rig/filming.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>

#include "flexura/log/recorder.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {
namespace {

std::vector<std::unique_ptr<Photographer>> photographers(const Setup& setup, std::size_t count) {
  std::vector<std::unique_ptr<Photographer>> all;
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) all.push_back(std::make_unique<Photographer>(setup));
  return all;
}

// Returns a time with few frames: limits the pictures of a camera in memory at once, for any clock step.
double few_frames(const std::vector<CameraConfig>& cameras) {
  constexpr double few = 4;
  double fastest = 1;
  for (const CameraConfig& camera : cameras) fastest = std::max(fastest, camera.sensor.frame_rate);
  return few / fastest;
}

// Times are sums of durations, so one that is due may be slightly in the past by rounding.
double left_until(double time, const ClockPort& clock) {
  constexpr double rounding = 1e-9;  // In s.
  const double left = time - clock.now();
  return left < 0 && left > -rounding ? 0 : left;
}

}  // namespace

Filming::Filming(const Setup& setup) : Filming(setup, setup.true_rig().cameras.size()) {}

Filming::Filming(const Setup& setup, std::size_t threads)
    : cameras_(setup.true_rig().cameras),
      photographers_(photographers(setup, cameras_.size())),
      rig_(std::make_unique<SimulatedRig>(
          setup.model_rig(), setup.true_rig(), [this](const Shot& shot) { return take(shot); },
          static_cast<std::uint64_t>(setup.seed))),
      seed_(static_cast<std::uint64_t>(setup.seed)),
      stretch_(few_frames(cameras_)),
      thread_pool_(threads) {}

// Returns the new frames of all cameras, in the order of time and then of the cameras.
std::vector<FilmedFrame> Filming::new_frames() {
  std::vector<std::size_t> due;
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    if (rig_->camera(i).camera().has_new()) due.push_back(i);
  std::vector<std::vector<FilmedFrame>> films(due.size());
  thread_pool_.run(due.size(), [&](std::size_t place) {
    const std::size_t camera = due[place];
    const std::string& name = cameras_[camera].name;
    for (const Frame& frame : rig_->camera(camera).camera().all_new())
      films[place].push_back({name, frame, logged_image(name, frame)});
  });
  std::vector<FilmedFrame> frames;
  for (auto& film : films) std::ranges::move(film, std::back_inserter(frames));
  std::ranges::stable_sort(frames, {}, [](const FilmedFrame& filmed) { return filmed.frame.received; });
  return frames;
}

void Filming::play_to(double time, const ArmState& state, const TakeFrame& take) {
  const RigPorts ports = rig_->ports();
  // The simulated rig has no lost links: a fault here is a program error.
  (void)ports.arm->command(state, left_until(time, *ports.clock)).value();
  do {
    ports.clock->wait_until(std::min(time, ports.clock->now() + stretch_));
    for (const FilmedFrame& filmed : new_frames()) take(filmed);
  } while (ports.clock->now() < time);
}

void Filming::pass_to(double time, const ArmState& state) {
  const RigPorts ports = rig_->ports();
  (void)ports.arm->command(state, left_until(time, *ports.clock)).value();
  ports.clock->wait_until(time);
}

void Filming::skip_to_now() {
  for (std::size_t i = 0; i < cameras_.size(); ++i) rig_->camera(i).camera().skip_to_now();
}

RigStance Filming::stance(std::size_t camera) {
  const double now = rig_->clock().now();
  return {camera, rig_->camera(camera).head().truth(now), rig_->camera(camera).stage().truth(now)};
}

Shot Filming::shot(std::size_t camera, double start) {
  Shot shot;
  shot.camera = camera;
  shot.sensor = &cameras_.at(camera).sensor;
  shot.frame = std::llround(start * shot.sensor->frame_rate);
  shot.seed = seed_;
  shot.start = start;
  shot.is_covered = is_within(times_of_frame_at(*shot.sensor, start).middle, shot.sensor->covered);
  shot.view = [&seen = rig_->camera(camera)](double time) { return seen.view(time); };
  shot.backbone = [this](double time) { return rig_->arm().backbone(time); };
  return shot;
}

std::unique_ptr<Rig> simulated_rig(const Setup& setup) { return std::make_unique<Filming>(setup); }

}  // namespace flexura
