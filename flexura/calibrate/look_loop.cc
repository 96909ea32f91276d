#include "flexura/calibrate/look_loop.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "flexura/base/degree.h"

namespace flexura {

LookLoop::LookLoop(const RigPorts& ports, const RigModel& nominal, const LoopConfig& config,
                   RigSessionWatcher& watcher)
    : nominal_(nominal),
      config_(config),
      watcher_(watcher),
      excursion_(ports, nominal, config.cameras, config.patience, config.move_duration, watcher),
      cameras_{Camera(nominal.cameras.at(config.cameras[0])), Camera(nominal.cameras.at(config.cameras[1]))} {
}

LookLoop::Error LookLoop::begin() {
  auto error = excursion_.begin();
  result_.start = excursion_.start();
  return error ? error : look_from_one_side(nominal_, excursion_.start(), "assumed");
}

LookLoop::Error LookLoop::look_from_one_side(const RigModel& rig, const std::array<RigStance, 2>& stances,
                                             const char* how) {
  const double beyond = remainder(rig, stances, Eigen::Vector3d::Zero()).angle;
  constexpr double farthest = std::numbers::pi / 4;
  if (std::abs(beyond) <= farthest) return std::nullopt;
  return fmt::format(
      "both cameras look from {}: the angle between their axes is {} to be {:.1f} deg, expected 45 deg to "
      "135 deg",
      beyond < 0 ? "one side" : "opposite sides", how, 90 + beyond / degree);
}

LookLoop::Error LookLoop::look(std::size_t i, const Measure& measure) {
  if (watcher_.is_cancelled()) return "cancelled";
  if (result_.pictures[i] >= config_.images)
    return fmt::format("the limit of {} pictures of camera {} is reached during {}", config_.images, name(i),
                       result_.steps.empty() ? "the first step" : result_.steps.back().step);
  auto taken = excursion_.picture(i, result_.pictures[i] + 1);
  if (const auto* why = std::get_if<std::string>(&taken)) return *why;
  const auto arm = excursion_.arm();
  if (const auto* why = std::get_if<std::string>(&arm)) return *why;
  ++result_.pictures[i];
  observed_ = std::get<CameraObservation>(std::move(taken)), observed_.pose = std::get<ArmState>(arm);
  measure(observed_);
  watcher_.seen(observed_);
  if (!result_.before[i]) result_.before[i] = observed_;
  result_.after[i] = observed_;
  return std::nullopt;
}

void LookLoop::plan(std::size_t i, const std::string& plane, const ArmState& arc, const View& ideal,
                    const Image<std::uint8_t>& picture) {
  watcher_.planned({excursion_.now(), config_.cameras[i], plane, arc, ideal, picture});
}

void LookLoop::decide(std::size_t i, const std::string& step, double offset, double accepted,
                      const std::string& unit, const std::string& next) {
  result_.steps.push_back({.time = excursion_.now(),
                           .looks = result_.pictures[0] + result_.pictures[1],
                           .camera = config_.cameras[i],
                           .step = step,
                           .offset = offset,
                           .accepted = accepted,
                           .unit = unit,
                           .next = next});
  watcher_.decided(result_.steps.back());
}

LookLoop::Error LookLoop::go(std::size_t i, const RigStance& stance) {
  if (auto error = excursion_.send(i, stance)) return error;
  return excursion_.settle();
}

LookLoop::Error LookLoop::begin_zoomed(std::size_t i, double zoom, const char* step, const char* why) {
  RigStance next = stance(i);
  next.head.zoom = zoom;
  next = commandable_stance(i, next);
  if (stands_there(i, next)) return std::nullopt;
  decide(i, step, 0, 0, "px", fmt::format(fmt::runtime(why), next.head.zoom));
  return go(i, next);
}

LookLoop::Error LookLoop::turn_towards(std::size_t i, const char* what,
                                       const std::optional<Eigen::Vector2d>& seen, double near,
                                       const Intrinsics& lens, const char* in_vain,
                                       const std::string& reason) {
  if (!seen) return fmt::format("the {} is out of view of camera {}: {}", what, name(i), reason);
  const Eigen::Vector2d off = *seen - Eigen::Vector2d(lens.cx, lens.cy);
  RigStance next = stance(i);
  next.head = turned_towards(next.head, lens, off);
  next = commandable_stance(i, next);
  if (off.norm() < near || stands_there(i, next)) return fmt::format(fmt::runtime(in_vain), name(i), reason);
  decide(i, "into view", off.norm(), 0, "px", "turn towards the visible part: " + reason);
  return go(i, next);
}

LookLoop::Error LookLoop::go_longer(std::size_t i, const RigStance& stance) {
  decide(
      i, "principal point", 0, 0, "px",
      fmt::format("zoom to {:.5g}: the principal point is the point that does not move", stance.head.zoom));
  return go(i, stance);
}

RigStance LookLoop::zoomed(std::size_t i, double ratio) const {
  RigStance next = stance(i);
  next.head.zoom = zoom_by(cameras_[i], next.head.zoom, ratio);
  return commandable_stance(i, next);
}

bool LookLoop::stands_there(std::size_t i, const RigStance& stance) const {
  constexpr double rounding = 1e-9;
  const RigStance& is = this->stance(i);
  return std::abs(stance.head.pan - is.head.pan) < rounding &&
         std::abs(stance.head.tilt - is.head.tilt) < rounding &&
         std::abs(stance.head.zoom - is.head.zoom) < rounding * (1 + std::abs(is.head.zoom)) &&
         (stance.stage.offset - is.stage.offset).norm() < rounding;
}

LoopResult LookLoop::finish(const Error& error) {
  result_.is_done = !error;
  if (error) result_.reason = *error + excursion_.retreat();
  result_.stances = error ? result_.start : excursion_.stances();
  return std::move(result_);
}

std::array<int, 2> best_steps(const std::function<double(int, int)>& cost) {
  std::array<int, 2> best = {0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (const int a : {0, -1, 1})
    for (const int b : {0, -1, 1})
      if (const double value = cost(a, b); value < least) least = value, best = {a, b};
  return best;
}

}  // namespace flexura
