#include "flexura/servo/rig_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "flexura/model/arm_difference.h"
#include "flexura/port/rig_readings.h"

namespace flexura {
namespace {

// Largest lead of a device's clock over the rig's, s.
constexpr double ahead = 0.1;

}  // namespace

RigReader::RigReader(const RigPorts& ports, const RigModel& nominal,
                     const std::array<std::size_t, 2>& cameras, const Times& times)
    : ports_(ports),
      model_(nominal),
      cameras_(cameras),
      optics_{Camera(nominal.cameras.at(cameras[0])), Camera(nominal.cameras.at(cameras[1]))},
      times_(times),
      arm_(times.span, &interpolate),
      stances_{MotionHistory<CameraStance, StanceBlend>(times.span, &interpolate),
               MotionHistory<CameraStance, StanceBlend>(times.span, &interpolate)} {}

RigReader::Error RigReader::read() {
  auto arm = read_arm(*ports_.arm, model_.sections());
  if (auto* why = std::get_if<std::string>(&arm)) return std::move(*why);
  const auto& measured = std::get<ArmReading>(arm);
  if (auto why = invalid_time("the arm", measured.time)) return why;
  arm_.add(measured.time, measured.state);
  for (std::size_t i = 0; i < 2; ++i) {
    auto stance = read_camera(ports_, cameras_[i], optics_[i]);
    if (auto* why = std::get_if<std::string>(&stance)) return std::move(*why);
    const auto& stands = std::get<StanceReading>(stance);
    if (auto why = invalid_time("the head of camera " + name(i), stands.time)) return why;
    stances_[i].add(stands.time, stands.stance.stance());
  }
  return std::nullopt;
}

RigReader::Error RigReader::invalid_time(const std::string& device, double time) const {
  const double age = now() - time;
  if (age < -ahead) return fmt::format("{}: its timestamp is {:.4g} s in the future", device, -age);
  if (age > times_.silent) return fmt::format("{}: no reading for {:.4g} s", device, age);
  return std::nullopt;
}

std::string RigReader::invalid_time(const Frame& frame, const std::deque<Frame>& before) const {
  if (!std::isfinite(frame.time) || !std::isfinite(frame.received))
    return "its picture's timestamp is not finite";
  if (frame.time > now() + ahead)
    return fmt::format("its picture's timestamp is {:.4g} s in the future", frame.time - now());
  if (!before.empty() && frame.time < before.back().time)
    return fmt::format("its picture is {:.4g} s older than the previous picture",
                       before.back().time - frame.time);
  return "";
}

void RigReader::take_newest() {
  constexpr std::size_t kept = 64;  // Frames kept per camera: one may be seconds later than the other.
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = camera(i).camera->newest();
    silence_[i] = frame.fault() ? text(*frame.fault()) : "";
    if (frame.fault() || !frame.value()) continue;
    silence_[i] = invalid_time(*frame.value(), recent_[i]);
    if (!silence_[i].empty()) continue;
    recent_[i].push_back(*frame.value());
    if (recent_[i].size() > kept) recent_[i].pop_front();
  }
}

std::optional<PicturePair> RigReader::newest_pair() {
  take_newest();
  // Takes the newest frame of the second camera that has a partner of the first camera, and the partner
  // nearest in time.
  for (auto second = recent_[1].rbegin(); second != recent_[1].rend(); ++second) {
    if (!(second->time > paired_at_[1])) break;
    const Frame* nearest = nullptr;
    for (const Frame& first : recent_[0]) {
      const double apart = std::abs(first.time - second->time);
      if (first.time > paired_at_[0] && apart <= times_.together &&
          (nearest == nullptr || apart < std::abs(nearest->time - second->time)))
        nearest = &first;
    }
    if (nearest == nullptr || nearest->time < arm_.since()) continue;
    paired_at_ = {nearest->time, second->time};
    return PicturePair{{*nearest, *second}, {view(0, nearest->time), view(1, second->time)}};
  }
  return std::nullopt;
}

std::string RigReader::silence() const {
  for (std::size_t i = 0; i < 2; ++i)
    if (!silence_[i].empty()) return fmt::format("camera {}: {}", name(i), silence_[i]);
  return "";
}

std::string RigReader::no_pair(double since) const {
  std::string whose;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool has_come = !recent_[i].empty() && recent_[i].back().received > since;
    if (!has_come) whose += (whose.empty() ? "camera " : " and ") + name(i);
  }
  return whose.empty() ? "no simultaneous pictures were received" : "no pictures were received from " + whose;
}

std::string RigReader::by_name(std::string reason) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = fmt::format("picture {} ", i + 1);
    if (const std::size_t at = reason.find(number); at != std::string::npos)
      reason.replace(at, number.size(), fmt::format("camera {}'s picture ", name(i)));
  }
  return reason;
}

}  // namespace flexura
