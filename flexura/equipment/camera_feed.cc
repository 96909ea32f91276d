#include "flexura/equipment/camera_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace flexura {
namespace {

// The condition variable must not be given times beyond the range of its clock.
constexpr double longest_wait = 1e6;

std::chrono::steady_clock::time_point after(double duration) {
  const std::chrono::duration<double> seconds(std::clamp(duration, 0.0, longest_wait));
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds);
}

}  // namespace

std::string camera_prefix(const std::string& name) { return fmt::format("camera \"{}\": ", name); }

CameraFeed::CameraFeed(std::string name, double frame_rate, const ClockPort& clock, Connection connection,
                       const CameraPatience& patience)
    : name_(std::move(name)),
      frame_rate_(frame_rate),
      clock_(clock),
      connection_(std::move(connection)),
      patience_(patience),
      thread_([this] { run(); }) {}

CameraFeed::~CameraFeed() {
  {
    const std::scoped_lock lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void CameraFeed::run() {
  double pause = patience_.first_pause;
  while (!is_over()) {
    {
      const std::scoped_lock lock(mutex_);
      put_count_ = 0;
    }
    ConnectionEnd end = connection_(*this);
    {
      const std::scoped_lock lock(mutex_);
      if (put_count_ > 0) pause = patience_.first_pause;
      fault_ = std::move(end.fault), is_final_ = end.is_final;
    }
    changed_.notify_all();
    if (end.is_final || sleep(pause)) return;
    pause = std::min(std::max(2 * pause, 0.01), patience_.longest_pause);
  }
}

void CameraFeed::put(TakenPicture taken) {
  Frame frame{.time = taken.time,
              .exposure = taken.exposure,
              .picture = std::make_shared<const Picture>(std::move(taken.picture))};
  {
    const std::scoped_lock lock(mutex_);
    frame.received = clock_.now();
    std::int64_t lost = std::max<std::int64_t>(taken.lost, 0);
    if (put_count_ == 0) {
      ++counts_.connections;
      if (frame_) {
        const double missed = std::round((frame.received - frame_->received) * frame_rate_) - 1;
        lost += static_cast<std::int64_t>(std::clamp(missed, 0.0, 1e12));
      }
    }
    frame.number = next_number_ + lost;
    next_number_ = frame.number + 1;
    ++put_count_, ++counts_.frames;
    counts_.lost += lost;
    frame_ = std::move(frame);
    is_new_ = true;
    fault_.reset();
  }
  changed_.notify_all();
}

bool CameraFeed::is_over() const {
  const std::scoped_lock lock(mutex_);
  return is_over_;
}

bool CameraFeed::sleep(double duration) {
  std::unique_lock lock(mutex_);
  return changed_.wait_until(lock, after(duration), [this] { return is_over_; });
}

std::int64_t CameraFeed::put_count() const {
  const std::scoped_lock lock(mutex_);
  return put_count_;
}

CameraCounts CameraFeed::counts() const {
  const std::scoped_lock lock(mutex_);
  return counts_;
}

Outcome<std::optional<Frame>> CameraFeed::taken() {
  if (std::exchange(is_new_, false)) return frame_;
  if (fault_) return *fault_;
  return std::optional<Frame>();
}

Outcome<std::optional<Frame>> CameraFeed::newest() {
  const std::scoped_lock lock(mutex_);
  return taken();
}

Outcome<std::optional<Frame>> CameraFeed::wait(double timeout) {
  if (!std::isfinite(timeout)) {
    return PortFault{FaultKind::refused,
                     camera_prefix(name_) + "the time to wait for a frame must be finite"};
  }
  std::unique_lock lock(mutex_);
  // A lost camera may come back in time, so a fault that is not final does not end the wait.
  changed_.wait_until(lock, after(timeout), [this] { return is_new_ || is_final_; });
  return taken();
}

}  // namespace flexura
