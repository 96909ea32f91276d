#include "flexura/calibrate/look_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/camera/axis_config.h"

namespace flexura {
namespace {

const CameraConfig& camera_of(const RigPorts& ports, const RigModel& believed, const LoopConfig& config,
                              std::size_t i) {
  if (ports.cameras.size() != believed.cameras.size() || config.cameras[0] == config.cameras[1])
    throw std::invalid_argument("a calibration needs the ports of two cameras of the model");
  return believed.cameras.at(config.cameras[i]);
}

}  // namespace

LookLoop::LookLoop(const RigPorts& ports, const RigModel& believed, const LoopConfig& config,
                   RigSessionWatcher& watcher)
    : believed_(believed),
      config_(config),
      watcher_(watcher),
      hands_(ports, believed, config.patience),
      trip_(hands_, watcher, config.cameras, config.move_duration),
      cameras_{Camera(camera_of(ports, believed, config, 0)), Camera(camera_of(ports, believed, config, 1))} {
}

LookLoop::Trouble LookLoop::begin() {
  auto trouble = trip_.begin();
  result_.start = stands_ = trip_.start();
  return trouble;
}

LookLoop::Trouble LookLoop::look_from_one_side() const {
  return look_from_one_side(believed_, {start(0), start(1)}, "believed");
}

LookLoop::Trouble LookLoop::look_from_one_side(const RigModel& rig, const std::array<RigStance, 2>& stances,
                                               const char* how) {
  const double beyond = remainder(rig, stances, Eigen::Vector3d::Zero()).angle;
  constexpr double farthest = std::numbers::pi / 4;
  if (std::abs(beyond) <= farthest) return std::nullopt;
  return fmt::format(
      "both cameras look from {}: their axes are {} to be {:.1f} deg apart, expected 45 to 135",
      beyond < 0 ? "one side" : "opposite sides", how, 90 + beyond / degree);
}

LookLoop::Trouble LookLoop::look(std::size_t i, const Measure& measure) {
  if (watcher_.is_cancelled()) return "cancelled";
  if (result_.pictures[i] >= config_.images)
    return fmt::format("the limit of {} pictures of camera {} is reached, during {}", config_.images, name(i),
                       result_.steps.empty() ? "the first step" : result_.steps.back().step);
  const auto taken = hands_.frame(config_.cameras[i], hands_.now());
  if (const auto* why = std::get_if<std::string>(&taken)) return *why;
  const auto stance = hands_.stance(config_.cameras[i]);
  if (const auto* why = std::get_if<std::string>(&stance)) return *why;
  const auto arm = hands_.arm();
  if (const auto* why = std::get_if<std::string>(&arm)) return *why;
  sight_ = {.look = ++result_.pictures[i],
            .stance = std::get<RigStance>(stance),
            .pose = std::get<ArmState>(arm),
            .frame = std::get<Frame>(taken),
            .seen = {},
            .values = {},
            .circle = {}};
  measure(sight_);
  watcher_.seen(sight_);
  if (!result_.before[i]) result_.before[i] = sight_;
  result_.after[i] = sight_;
  return std::nullopt;
}

void LookLoop::plan(std::size_t i, const std::string& plane, const ArmState& arc, const View& ideal,
                    const Image<std::uint8_t>& picture) {
  watcher_.planned({hands_.now(), config_.cameras[i], plane, arc, ideal, picture});
}

void LookLoop::decide(std::size_t i, const std::string& step, double offset, double accepted,
                      const std::string& unit, const std::string& next) {
  result_.steps.push_back({.time = hands_.now(),
                           .looks = result_.pictures[0] + result_.pictures[1],
                           .camera = config_.cameras[i],
                           .step = step,
                           .offset = offset,
                           .accepted = accepted,
                           .unit = unit,
                           .next = next});
  watcher_.decided(result_.steps.back());
}

LookLoop::Trouble LookLoop::go(std::size_t i, const RigStance& stance) {
  watcher_.camera_sent(hands_.now(), stance);
  stands_[i] = stance;
  if (auto trouble = hands_.go(stance)) return trouble;
  return hands_.settle();
}

RigStance LookLoop::commandable_stance(std::size_t i, const RigStance& stance) const {
  RigStance drawn = stance;
  const auto& [pan, tilt, zoom] = cameras_[i].head_axes();
  drawn.head = {commandable(pan, stance.head.pan), commandable(tilt, stance.head.tilt),
                commandable(zoom, stance.head.zoom)};
  for (Eigen::Index j = 0; j < 3; ++j)
    drawn.stage.offset[j] =
        commandable(cameras_[i].stage_axes()[static_cast<std::size_t>(j)], stance.stage.offset[j]);
  return drawn;
}

bool LookLoop::stands_there(std::size_t i, const RigStance& stance) const {
  constexpr double rounding = 1e-9;
  const RigStance& is = stands_[i];
  return std::abs(stance.head.pan - is.head.pan) < rounding &&
         std::abs(stance.head.tilt - is.head.tilt) < rounding &&
         std::abs(stance.head.zoom - is.head.zoom) < rounding * (1 + std::abs(is.head.zoom)) &&
         (stance.stage.offset - is.stage.offset).norm() < rounding;
}

LoopResult LookLoop::finish(const Trouble& trouble) {
  result_.is_done = !trouble;
  if (trouble) result_.reason = *trouble + trip_.retreat();
  result_.stances = trouble ? result_.start : stands_;
  return std::move(result_);
}

double zoom_by(const Camera& camera, double from, double ratio) {
  return zoom_at(camera, camera.lens().ratio(from) * ratio);
}

}  // namespace flexura
