#include "flexura/calibrate/etalon_loop.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"

namespace flexura {
namespace {

// Returns whether limits end a move more than one step before its target.
bool falls_short(const Camera& camera, const RigStance& asked, const RigStance& next) {
  const auto is_beyond = [](double off, double resolution) { return std::abs(off) > resolution + 1e-9; };
  const auto& [pan, tilt, zoom] = camera.head_axes();
  const auto stage = camera.stage_axes();
  const Eigen::Vector3d off = next.stage.offset - asked.stage.offset;
  return is_beyond(next.head.pan - asked.head.pan, pan.resolution) ||
         is_beyond(next.head.tilt - asked.head.tilt, tilt.resolution) ||
         is_beyond(off.x(), stage[0].resolution) || is_beyond(off.y(), stage[1].resolution);
}

}  // namespace

LookLoop::Error EtalonLoop::run() {
  loop_.result().target = EtalonFigure(loop_.config().etalon).middle();
  // Red lines are 90 degrees apart: the camera model identifies which one a camera sees.
  if (auto error = loop_.begin()) return error;
  for (std::size_t i = 0; i < 2; ++i)
    if (auto error = loop_.begin_zoomed(i, zoom_ends(loop_.camera(i))[0], "zoom to x1",
                                        "the shortest focal length, to see the whole cylinder"))
      return error;
  for (std::size_t i = 0; i < 2; ++i)
    if (auto error = align(i)) return error;
  if (auto error = zoom()) return error;
  return finish();
}

LookLoop::Error EtalonLoop::null(std::size_t i, std::initializer_list<std::size_t> which) {
  std::vector<OffsetSteps> steps;
  const auto begun = [](const Offset& offset) {
    return offset.most > 0 ? OffsetSteps(offset.accepted, offset.most) : OffsetSteps(offset.accepted);
  };
  for (;;) {
    if (auto error = look(i)) return error;
    bool is_moved = false;
    if (auto error = prepare(i, *which.begin(), is_moved)) return error;
    if (is_moved) {
      if (is_printed_) steps.clear();
      continue;
    }
    const auto all = offsets(i);
    for (std::size_t k = 0; k < which.size() && !is_moved; ++k) {
      const Offset& offset = all[which.begin()[k]];
      if (steps.size() == k) steps.push_back(begun(offset));
      if (auto error = step(i, offset, steps[k], is_moved)) return error;
      // The correction that a slide leaves to the head does not count as one of the head's own steps.
      if (is_moved && k % 2 == 1) steps[k - 1] = begun(all[which.begin()[k - 1]]);
    }
    if (!is_moved) return std::nullopt;
  }
}

LookLoop::Error EtalonLoop::step(std::size_t i, const Offset& offset, OffsetSteps& steps, bool& is_moved) {
  OffsetSteps tried = steps;
  const bool holds = std::abs(offset.want) <= offset.accepted;
  if (tried.take(offset.want) == LoopState::stuck && !holds)
    return fmt::format("{} of camera {} {}", offset.step, loop_.name(i), tried.reason());
  RigStance asked = loop_.stance(i);
  const Eigen::Vector4d by = tried.move() * offset.by;
  asked.head.pan += by[0], asked.head.tilt += by[1];
  asked.stage.offset += Eigen::Vector3d(by[2], by[3], 0);
  const RigStance next = loop_.commandable_stance(i, asked);
  const bool stays = loop_.stands_there(i, next);
  if (!is_printed_) {
    if (holds) return std::nullopt;
    if (falls_short(loop_.camera(i), asked, next))
      return fmt::format("{} of camera {}: at the limit of its range, an offset of {:.4g} px remains",
                         offset.step, loop_.name(i), std::abs(offset.px));
    if (stays) return std::nullopt;  // Nothing finer can be commanded.
  }
  const std::string what = is_printed_ ? "a step"
                                       : fmt::format("{} by {:.5g} {}", offset.how, tried.move(),
                                                     offset.by.tail<2>().isZero(0) ? "rad" : "m");
  loop_.decide(i, offset.step, offset.px, loop_.config().accepted, "px", holds ? "holds" : what);
  if (holds) return std::nullopt;
  if (stays)
    return fmt::format("{} of camera {}: no further step can be commanded, an offset of {:.3g} px remains",
                       offset.step, loop_.name(i), std::abs(offset.px));
  steps = tried, is_moved = true;
  return loop_.go(i, next);
}

LookLoop::Error EtalonLoop::zoom() {
  const double accepted = loop_.config().zoom_accepted;
  OffsetSteps steps(accepted);
  std::array<bool, 2> is_new = {is_printed_, is_printed_};
  for (;;) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!is_new[i]) continue;
      if (auto error = look(i)) return error;
      if (auto why = unmeasured(i)) return fmt::format("zoom of camera {}: {}", loop_.name(i), *why);
    }
    const double ratio = this->ratio();
    const LoopState state = steps.take(ratio - 1);
    if (is_printed_ && state == LoopState::stuck)
      return "zoom " + steps.reason() +
             "; the paper's method zooms in with the camera that shows the larger cylinder";
    loop_.result().zoom_ratio = ratio;
    // As printed: zooms the camera that shows the cylinder larger already. Corrected: enlarges the smaller
    // one, or reduces the other one if the lens is at its limit.
    const std::size_t chosen = (ratio < 1) == is_printed_ ? 1 : 0;
    const bool holds = is_printed_ ? state == LoopState::holds : std::abs(std::log(ratio)) <= accepted;
    std::optional<std::size_t> next;
    RigStance stance;
    for (const std::size_t i : {chosen, 1 - chosen}) {
      if (holds || next || (is_printed_ && i != chosen)) break;
      const double larger = i == 0 ? 1 / ratio : ratio;
      stance = loop_.zoomed(i, is_printed_ ? 1 + loop_.config().zoom_step : larger);
      if (!loop_.stands_there(i, stance)) next = i;
    }
    std::string what = "both show the cylinder in equal size, up to the resolution of the commands";
    if (is_printed_)
      what = holds ? "stops" : fmt::format("zoom in with {}", loop_.name(chosen));
    else if (next)
      what = fmt::format("zoom of {} to {:.5g}", loop_.name(*next), stance.head.zoom);
    loop_.decide(chosen, "zoom", ratio - 1, accepted, "share", what);
    if (is_printed_ && !holds && !next)
      return fmt::format("the zoom diverges: camera {} is at the limit of its zoom", loop_.name(chosen));
    if (!next) return std::nullopt;
    if (auto error = loop_.go(*next, stance)) return error;
    is_new = {is_printed_ || *next == 0, is_printed_ || *next == 1};
  }
}

}  // namespace flexura
