#include "flexura/sim/simulated_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/math/hash.h"

namespace flexura {

double frame_horizon(const SensorConfig& sensor) {
  return frame_times(sensor, 0).received + (frames_kept + 1) / sensor.frame_rate;
}

SimulatedCamera::SimulatedCamera(const Camera& camera, Shot shot, TakePicture take_picture, ClockPort& clock)
    : link_("camera " + camera.config().name, clock),
      sensor_(camera.config().sensor),
      shot_(std::move(shot)),
      take_picture_(std::move(take_picture)),
      clock_(&clock) {
  shot_.sensor = &sensor_;
  for (const auto& [from, to] : sensor_.silent) link_.lose(from, to);
}

bool SimulatedCamera::is_lost(std::int64_t frame) const {
  if (is_within(frame_times(sensor_, frame).received, sensor_.silent)) return true;
  const std::uint64_t number = hash(shot_.seed, shot_.camera, static_cast<std::uint64_t>(frame));
  return static_cast<double>(number >> 11) * 0x1p-53 < sensor_.drop;
}

// Returns the last frame received at `time` or before, counting lost ones; -1 before the first.
std::int64_t SimulatedCamera::last_received(double time) const {
  const double count = std::floor((time - frame_times(sensor_, 0).received) * sensor_.frame_rate);
  auto frame = static_cast<std::int64_t>(std::max(count - 1, -1.0));
  while (frame_times(sensor_, frame + 1).received <= time) ++frame;
  return frame;
}

Frame SimulatedCamera::take(std::int64_t number) {
  const FrameTimes times = frame_times(sensor_, number);
  shot_.frame = number;
  shot_.start = times.start;
  shot_.is_covered = is_within(times.middle, sensor_.covered);
  next_ = number + 1;
  return {number, times.middle, sensor_.exposure, times.received,
          std::make_shared<const Picture>(take_picture_(shot_))};
}

Outcome<std::optional<Frame>> SimulatedCamera::newest() {
  if (auto fault = link_.fault()) return *fault;
  const std::int64_t last = last_received(link_.now());
  const std::int64_t first = std::max(next_, last - frames_kept + 1);
  for (std::int64_t frame = last; frame >= first; --frame)
    if (!is_lost(frame)) return std::optional<Frame>(take(frame));
  return std::optional<Frame>{};
}

Outcome<std::optional<Frame>> SimulatedCamera::wait(double timeout) {
  if (!std::isfinite(timeout)) return link_.refusal(fmt::format("a wait cannot take {} s", timeout));
  const double until = link_.now() + std::max(timeout, 0.0);
  for (;;) {
    auto found = newest();
    if (!found || found.value()) return found;
    const double next = frame_times(sensor_, last_received(link_.now()) + 1).received;
    if (!(next <= until)) break;
    clock_->wait_until(next);
  }
  clock_->wait_until(until);
  return newest();
}

bool SimulatedCamera::has_new() const {
  for (std::int64_t frame = next_, last = last_received(clock_->now()); frame <= last; ++frame)
    if (!is_lost(frame)) return true;
  return false;
}

std::vector<Frame> SimulatedCamera::all_new() {
  std::vector<Frame> frames;
  for (std::int64_t frame = next_, last = last_received(clock_->now()); frame <= last; ++frame)
    if (!is_lost(frame)) frames.push_back(take(frame));
  skip_to_now();
  return frames;
}

}  // namespace flexura
