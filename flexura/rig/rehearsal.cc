#include "flexura/rig/rehearsal.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/rig/rehearsed_devices.h"
#include "flexura/rig/rehearsed_world.h"

namespace flexura {
namespace {

// Returns the paths of the cameras' streams.
std::vector<VideoStream> streams_of(const std::vector<CameraConfig>& cameras) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const bool are_plain = std::ranges::all_of(
      cameras, [&](const CameraConfig& camera) { return std::ranges::all_of(camera.name, is_plain); });
  std::vector<VideoStream> streams;
  for (const CameraConfig& camera : cameras) {
    const SensorConfig& sensor = camera.sensor;
    if (sensor.bits != 8)
      throw std::invalid_argument(
          fmt::format("camera \"{}\" has {} bits: a video has 8", camera.name, sensor.bits));
    streams.push_back({are_plain ? camera.name : fmt::format("camera{}", streams.size() + 1),
                       static_cast<int>(sensor.width), static_cast<int>(sensor.height), sensor.pixels,
                       sensor.frame_rate});
  }
  return streams;
}

void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

}  // namespace

// Everything that runs. The order of the members is that in which they may use each other.
class Rehearsal::Devices {
 public:
  Devices(const Setup& setup, const VideoServerConfig& video)
      : cameras_(setup.cameras()),
        video_(open_video_server(streams_of(setup.true_rig().cameras), video)),
        controllers_(started_controllers(setup)),
        world_(setup, [this] { return positions(); }),
        counts_(cameras_.size()) {
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      heads_.push_back(std::make_unique<RehearsedHead>(world_, i, Camera(cameras_[i])));
    threads_.emplace_back([this] { run(); });
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      threads_.emplace_back([this, i] {
        try {
          film(i);
        } catch (const std::exception& error) {
          const std::scoped_lock lock(mutex_);
          failure_ = error.what();
        }
      });
  }
  ~Devices() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  [[nodiscard]] RigEquipment equipment() const {
    RigEquipment equipment{};
    for (const auto& controller : controllers_) {
      GrblConfig& grbl = equipment.grbl.emplace_back();
      grbl.link = controller->path();
      grbl.axes = grbl::axis_letters.substr(0, controller->axes());
    }
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      CameraEquipment& camera = equipment.camera.emplace_back();
      camera.name = cameras_[i].name;
      camera.gstreamer.emplace().source = video_->address(i);
      camera.visca = heads_[i]->config();
    }
    return equipment;
  }
  [[nodiscard]] RehearsedPictures pictures(std::size_t camera) const {
    return {counts_.at(camera).sent, counts_.at(camera).skipped};
  }
  [[nodiscard]] int runs() const { return runs_; }
  [[nodiscard]] RehearsedWorld& world() { return world_; }
  [[nodiscard]] std::string failure() const {
    const std::scoped_lock lock(mutex_);
    return failure_.empty() ? world_.failure() : failure_;
  }

 private:
  static constexpr double step = 0.005;  // s

  struct Counts {
    std::atomic<std::int64_t> sent = 0, skipped = 0;
  };
  // A picture on its way.
  struct Sent {
    double arrives, stamp;  // s
    Picture picture;
  };

  static std::vector<std::unique_ptr<RehearsedController>> started_controllers(const Setup& setup);
  std::vector<double> positions();
  void run();
  void pass_step();
  [[nodiscard]] bool is_watched();
  void put_back();
  void film(std::size_t camera);
  void deliver(std::size_t camera, std::deque<Sent>& on_the_way);

  std::vector<CameraConfig> cameras_;
  std::unique_ptr<VideoServer> video_;
  std::vector<std::unique_ptr<RehearsedController>> controllers_;
  RehearsedWorld world_;
  std::vector<std::unique_ptr<RehearsedHead>> heads_;
  std::vector<Counts> counts_;
  std::atomic<int> runs_ = 0;
  std::atomic<bool> is_over_ = false;
  mutable std::mutex mutex_;
  std::string failure_;  // Of a thread that makes pictures.
  std::vector<std::thread> threads_;
};

std::vector<std::unique_ptr<RehearsedController>> Rehearsal::Devices::started_controllers(
    const Setup& setup) {
  const std::optional<DriveConfig> config = setup.true_rig().drive;
  if (!config) throw std::invalid_argument("the arm has no drive to rehearse: expected [drive]");
  const Drive drive = config->drive();
  const std::size_t most = std::min(drive.axes_per_controller, grbl::most_axes);
  std::vector<std::unique_ptr<RehearsedController>> controllers;
  for (std::size_t first = 0; first < drive.axes.size(); first += most) {
    const auto begin = drive.axes.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = std::min(most, drive.axes.size() - first);
    controllers.push_back(std::make_unique<RehearsedController>(
        std::vector<Axis>(begin, begin + static_cast<std::ptrdiff_t>(count))));
  }
  return controllers;
}

std::vector<double> Rehearsal::Devices::positions() {
  std::vector<double> all;
  for (const auto& controller : controllers_)
    std::ranges::copy(controller->positions(), std::back_inserter(all));
  return all;
}

void Rehearsal::Devices::run() {
  constexpr double pause = 2;  // s; a stream that breaks down comes back sooner.
  bool has_run = false;
  double seen_at = 0;
  while (!is_over_) {
    pass_step();
    if (is_watched()) {
      has_run = true, seen_at = world_.now();
    } else if (has_run && world_.now() - seen_at > pause) {
      put_back();
      has_run = false;
      ++runs_;
    }
  }
}

void Rehearsal::Devices::pass_step() {
  world_.advance();
  nap(step);
}

bool Rehearsal::Devices::is_watched() {
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    if (video_->is_watched(i)) return true;
  return false;
}

// Turns the motors back by hand, and the heads.
void Rehearsal::Devices::put_back() {
  for (std::size_t i = 0; i < cameras_.size(); ++i) world_.turn(i, Camera(cameras_[i]).initial_head());
  constexpr int steps = 200;
  for (int left = steps; left > 0 && !is_over_; --left) {
    for (const auto& controller : controllers_) controller->turn_back(1.0 / left);
    pass_step();
  }
}

void Rehearsal::Devices::film(std::size_t camera) {
  const SensorConfig& sensor = world_.sensor(camera);
  std::deque<Sent> on_the_way;
  std::int64_t next = 0;
  while (!is_over_) {
    constexpr double glance = 0.002;  // s
    deliver(camera, on_the_way);
    const double since_first = world_.now() - frame_times(sensor, 0).end;
    const auto newest = static_cast<std::int64_t>(std::floor(since_first * sensor.frame_rate));
    if (!video_->is_watched(camera)) {
      on_the_way.clear();
      next = newest + 1;
    } else if (newest >= next) {
      counts_[camera].skipped += newest - next;
      next = newest + 1;
      if (!world_.is_lost(camera, newest)) {
        const FrameTimes times = frame_times(sensor, newest);
        on_the_way.push_back({times.received, times.middle, world_.picture(camera, newest)});
      }
      continue;
    }
    nap(glance);
  }
}

void Rehearsal::Devices::deliver(std::size_t camera, std::deque<Sent>& on_the_way) {
  while (!on_the_way.empty() && on_the_way.front().arrives <= world_.now()) {
    const Sent& first = on_the_way.front();
    video_->put(camera, std::get<Image<std::uint8_t>>(first.picture), world_.steady(first.stamp));
    ++counts_[camera].sent;
    on_the_way.pop_front();
  }
}

Rehearsal::Rehearsal(const Setup& setup, const VideoServerConfig& video)
    : devices_(std::make_unique<Devices>(setup, video)) {}
Rehearsal::~Rehearsal() = default;
RigEquipment Rehearsal::equipment() const { return devices_->equipment(); }
std::string Rehearsal::failure() const { return devices_->failure(); }
int Rehearsal::runs() const { return devices_->runs(); }
RehearsedPictures Rehearsal::pictures(std::size_t camera) const { return devices_->pictures(camera); }
Backbone Rehearsal::backbone() { return devices_->world().backbone(); }
RigStance Rehearsal::stance(std::size_t camera) { return devices_->world().stance(camera); }

}  // namespace flexura
