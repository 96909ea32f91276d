#include "flexura/calibrate/etalon_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/calibrate/etalon_eyes.h"
#include "flexura/calibrate/offset_steps.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/math/arrays.h"
#include "flexura/math/pose.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

using LoopTrouble = LookLoop::Trouble;

void tell(const EtalonView& view, const LookLoop& loop, RigSight& sight) {
  if (view.reason.empty())
    sight.seen = drawn_etalon(view.sighting, loop.config().etalon, view_of(loop.believed(), sight.stance));
  sight.seen.reason = view.reason;
  if (!view.reason.empty()) return;
  sight.values = {{"silhouette right of the middle, px", view.middle},
                  {"line right of the silhouette's middle, px", view.line},
                  {"silhouette below the middle, px", view.height},
                  {"width above less below, px", view.taper},
                  {"width, px", view.width}};
}

// Whether limits end a move by more than a step before what was asked for.
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

LoopTrouble begin_with_etalon(LookLoop& loop) {
  if (auto trouble = loop.begin()) return trouble;
  loop.result().target = EtalonFigure(loop.config().etalon).middle();
  // Red lines are every 90 degrees: which one a camera sees is told by what is believed of the cameras.
  if (auto trouble = loop.look_from_one_side()) return trouble;
  for (std::size_t i = 0; i < 2; ++i) {
    RigStance stance = loop.stance(i);
    stance.head.zoom = zoom_ends(loop.camera(i))[0];
    stance = loop.commandable_stance(i, stance);
    if (loop.stands_there(i, stance)) continue;
    loop.decide(i, "zoom to x1", 0, 0, "px", "the shortest focal length, to see all of the cylinder");
    if (auto trouble = loop.go(i, stance)) return trouble;
  }
  return std::nullopt;
}

// Something to be nulled, and the motion that does it by the behaviour of the image that is believed.
struct EtalonLoop::Offset {
  const char* step;
  double px;                         // As measured.
  double want;                       // As a motion: rad, or m.
  double accepted, most;             // Likewise; most: of one step.
  const char* how;                   // In words.
  Eigen::Vector<double, 4> by_want;  // Of pan, tilt, stage x and y, for each unit of `want`.
};

std::array<EtalonLoop::Offset, 4> EtalonLoop::offsets(std::size_t i) const {
  const EtalonView& view = views_[i];
  const double by_px = 1 / lens(i).fx, accepted = loop_.config().accepted;
  const double distance = view.distance, turn = 1 / distance;
  constexpr double half_turn = 0.5;  // rad
  const double half_way = 0.5 * distance;
  // A camera that slides keeps looking at the cylinder: position and orientation do not undo each other.
  return {
      Offset{"horizontal orientation",
             view.middle,
             view.sight,
             accepted * by_px,
             half_turn,
             "pan",
             {-1, 0, 0, 0}},
      Offset{"horizontal positioning",
             view.line,
             distance * view.bearing,
             accepted * distance * view.bearing_by_px,
             half_way,
             "slide to the left",
             {-turn, 0, -1, 0}},
      Offset{
          "vertical orientation", view.height, view.drop, accepted * by_px, half_turn, "tilt", {0, -1, 0, 0}},
      Offset{"vertical positioning",
             view.taper,
             distance * view.climb,
             accepted * distance * view.climb_by_px,
             half_way,
             "slide downwards",
             {0, turn, 0, 1}}};
}

// As it is believed to be by now.
Intrinsics EtalonLoop::lens(std::size_t i) const {
  Intrinsics lens = loop_.lens(i);
  lens.cx += beside_[i].x(), lens.cy += beside_[i].y();
  return lens;
}

LoopTrouble EtalonLoop::look(std::size_t i) {
  return loop_.look(i, [this, i](RigSight& sight) {
    views_[i] = view_etalon(eight_bits(*sight.frame.picture, loop_.model(i).sensor.white()), lens(i),
                            loop_.config().etalon.radius);
    tell(views_[i], loop_, sight);
  });
}

// Turns towards what is seen of the cylinder until all of it is.
LoopTrouble EtalonLoop::into_view(std::size_t i) {
  constexpr int most = 8;
  for (int turn = 0; !views_[i].reason.empty(); ++turn) {
    const EtalonView& view = views_[i];
    if (!view.centroid)
      return fmt::format("the cylinder is out of view of camera {}: {}", loop_.name(i), view.reason);
    const Intrinsics lens = this->lens(i);
    RigStance next = loop_.stance(i);
    next.head.pan -= std::atan((view.centroid->x() - lens.cx) / lens.fx);
    next.head.tilt -= std::atan((view.centroid->y() - lens.cy) / lens.fy);
    next = loop_.commandable_stance(i, next);
    if (view.is_too_large || turn == most || loop_.stands_there(i, next))
      return fmt::format("camera {} cannot have all of the cylinder in its picture: {}", loop_.name(i),
                         view.reason);
    loop_.decide(i, "into view", (*view.centroid - Eigen::Vector2d(lens.cx, lens.cy)).norm(), 0, "px",
                 "turn towards what is seen: " + view.reason);
    if (auto trouble = loop_.go(i, next)) return trouble;
    if (auto trouble = look(i)) return trouble;
  }
  return std::nullopt;
}

LoopTrouble EtalonLoop::align(std::size_t i) {
  std::vector<ShrinkingSteps> steps;
  const auto begun = [](const Offset& offset) { return ShrinkingSteps(offset.accepted, offset.most); };
  if (auto trouble = look(i)) return trouble;
  for (;;) {
    if (auto trouble = into_view(i)) return trouble;
    const auto all = offsets(i);
    bool is_moved = false;
    for (std::size_t j = 0; j < all.size() && !is_moved; ++j) {
      const Offset& offset = all[j];
      if (steps.size() == j) steps.push_back(begun(offset));
      if (std::abs(offset.want) <= offset.accepted) continue;
      ShrinkingSteps tried = steps[j];
      if (tried.take(offset.want) == LoopState::stuck)
        return fmt::format("{} of camera {} {}", offset.step, loop_.name(i), tried.reason());
      RigStance asked = loop_.stance(i);
      const Eigen::Vector4d by = tried.move() * offset.by_want;
      asked.head.pan += by[0], asked.head.tilt += by[1];
      asked.stage.offset += Eigen::Vector3d(by[2], by[3], 0);
      const RigStance next = loop_.commandable_stance(i, asked);
      if (falls_short(loop_.camera(i), asked, next))
        return fmt::format("{} of camera {}: what can be commanded ends {:.4g} px before it holds",
                           offset.step, loop_.name(i), std::abs(offset.px));
      if (loop_.stands_there(i, next)) continue;  // Nothing finer can be commanded.
      steps[j] = tried;
      // What a slide leaves to the head is none of the head's own steps.
      if (j % 2 == 1) steps[j - 1] = begun(all[j - 1]);
      loop_.decide(i, offset.step, offset.px, loop_.config().accepted, "px",
                   fmt::format("{} by {:.5g} {}", offset.how, tried.move(), j % 2 == 0 ? "rad" : "m"));
      if (auto trouble = loop_.go(i, next)) return trouble;
      is_moved = true;
    }
    if (!is_moved) break;
    if (auto trouble = look(i)) return trouble;
  }
  for (const Offset& offset : offsets(i))
    loop_.decide(i, offset.step, offset.px, loop_.config().accepted, "px",
                 std::abs(offset.want) <= offset.accepted ? "holds" : "nothing finer can be commanded");
  loop_.result().roll[i] = views_[i].roll;
  return std::nullopt;
}

// How many times as long a focal length shows all of the cylinder still.
double EtalonLoop::longer(std::size_t i) const {
  const EtalonSighting& seen = views_[i].sighting;
  const Intrinsics lens = this->lens(i);
  const SensorConfig& sensor = loop_.model(i).sensor;
  const double half = 0.5 * (seen.bottom - seen.top);
  double times = std::numeric_limits<double>::infinity();
  const auto keep = [&](double from_middle, double room) {
    constexpr double margin = 12;  // px: more than a principal point is off, times what it grows by.
    if (from_middle > 0) times = std::min(times, (room - margin) / from_middle);
  };
  for (const UprightLine& side : {seen.left, seen.right}) {
    for (const double at : {side.at - side.slope * half, side.at + side.slope * half})
      keep(at - lens.cx, static_cast<double>(sensor.width - 1) - lens.cx), keep(lens.cx - at, lens.cx);
  }
  keep(lens.cy - seen.top, lens.cy);
  keep(seen.bottom - lens.cy, static_cast<double>(sensor.height - 1) - lens.cy);
  return times;
}

// What a longer focal length moves in the picture moves away from the principal point.
LoopTrouble EtalonLoop::center(std::size_t i) {
  constexpr double least = 1.2;  // Where noise counts eight times.
  const RigStance wide = loop_.stance(i);
  const EtalonView before = views_[i];
  const Intrinsics lens = this->lens(i);
  Intrinsics lens_then = lens;
  double times = longer(i);
  for (;;) {
    RigStance next = wide;
    next.head.zoom = zoom_by(loop_.camera(i), wide.head.zoom, times);
    next = loop_.commandable_stance(i, next);
    lens_then = loop_.camera(i).lens().at(next.head.zoom);
    times = lens_then.fx / lens.fx;
    if (times < least) {
      loop_.result().notes.push_back(
          fmt::format("{}: the principal point is taken to be where the file has it: no picture by {} times "
                      "the shortest focal length or more has all of the cylinder",
                      loop_.name(i), least));
      return loop_.stands_there(i, wide) ? std::nullopt : loop_.go(i, wide);
    }
    loop_.decide(i, "principal point", 0, 0, "px",
                 fmt::format("zoom to {:.5g}, for what stays where it is", next.head.zoom));
    if (auto trouble = loop_.go(i, next)) return trouble;
    if (auto trouble = look(i)) return trouble;
    if (views_[i].reason.empty()) break;
    // A principal point that is far off carries the cylinder out of the picture.
    times = std::sqrt(times);
  }
  const auto stays = [](double was, double is, double f, double f_then) {
    return (was * f_then - is * f) / (f_then - f);
  };
  const Eigen::Vector2d off(stays(before.middle, views_[i].middle, lens.fx, lens_then.fx),
                            stays(before.height, views_[i].height, lens.fy, lens_then.fy));
  beside_[i] += off;
  loop_.result().principal_point[i] = beside_[i];
  loop_.decide(i, "principal point", off.norm(), 0, "px",
               fmt::format("it is {:.3f} px to the right of and {:.3f} px below where the file has it",
                           off.x(), off.y()));
  return loop_.go(i, wide);
}

LoopTrouble EtalonLoop::zoom() {
  for (;;) {
    const double ratio = views_[0].magnification / views_[1].magnification;
    loop_.result().zoom_ratio = ratio;
    const double accepted = loop_.config().zoom_accepted;
    const bool is_alike = std::abs(std::log(ratio)) <= accepted;
    const std::size_t smaller = ratio < 1 ? 0 : 1;
    std::optional<std::pair<std::size_t, RigStance>> next;
    // The smaller one is enlarged; where its lens ends, the other one is made smaller.
    for (const std::size_t i : {smaller, 1 - smaller}) {
      if (is_alike) break;
      RigStance stance = loop_.stance(i);
      const double by = i == 0 ? 1 / ratio : ratio;
      stance.head.zoom = zoom_by(loop_.camera(i), stance.head.zoom, by);
      stance = loop_.commandable_stance(i, stance);
      if (loop_.stands_there(i, stance)) continue;
      next.emplace(i, stance);
      break;
    }
    loop_.decide(smaller, "zoom", ratio - 1, accepted, "share",
                 next ? fmt::format("zoom of {} to {:.5g}", loop_.name(next->first), next->second.head.zoom)
                      : "both show the cylinder alike, or nothing nearer can be commanded");
    if (!next) break;
    if (auto trouble = loop_.go(next->first, next->second)) return trouble;
    if (auto trouble = look(next->first)) return trouble;
    if (!views_[next->first].reason.empty())
      return fmt::format("zoom of camera {}: {}", loop_.name(next->first), views_[next->first].reason);
  }
  constexpr double visible = 0.01;
  if (std::abs(*loop_.result().zoom_ratio - 1) > visible)
    return fmt::format("no zoom that both cameras have shows the cylinder alike: the ratio stays at {:.4f}",
                       *loop_.result().zoom_ratio);
  return std::nullopt;
}

// Of the positions around, the pans whose axes are the most nearly orthogonal; of equals those that look at
// the cylinder. Then one more picture each, which says how it is.
LoopTrouble EtalonLoop::square() {
  std::array<int, 2> best = {0, 0};
  double least = std::numeric_limits<double>::infinity();
  const auto step = [&](std::size_t i) { return loop_.camera(i).head_axes()[0].resolution; };
  for (const int a : {0, -1, 1}) {
    for (const int b : {0, -1, 1}) {
      const double off = across(0) + a * step(0) - across(1) - b * step(1);
      constexpr double aim = 0.01;
      const double cost = std::abs(off) + aim * (std::abs(views_[0].sight + a * step(0)) +
                                                 std::abs(views_[1].sight + b * step(1)));
      if (cost < least) least = cost, best = {a, b};
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    RigStance next = loop_.stance(i);
    next.head.pan += best[i] * step(i);
    next = loop_.commandable_stance(i, next);
    if (!loop_.stands_there(i, next)) {
      loop_.decide(i, "orthogonal axes", (across(0) - across(1)) / degree, 0, "deg",
                   "pan by a step: together the axes are more nearly orthogonal");
      if (auto trouble = loop_.go(i, next)) return trouble;
    }
    if (auto trouble = look(i)) return trouble;
    if (!views_[i].reason.empty())
      return fmt::format("camera {} after its last move: {}", loop_.name(i), views_[i].reason);
  }
  // Which way around they stand: the angle between the axes is less or more.
  const Eigen::Vector3d a = loop_.camera(0).pose(loop_.stance(0).stance()).rotation.col(2),
                        b = loop_.camera(1).pose(loop_.stance(1).stance()).rotation.col(2);
  const double hand = a.cross(b).y() < 0 ? 1 : -1;
  loop_.result().angle = hand * (across(0) - across(1));
  loop_.result().zoom_ratio = views_[0].magnification / views_[1].magnification;
  loop_.decide(1, "orthogonal axes", *loop_.result().angle / degree, 0, "deg", "");
  return std::nullopt;
}

LoopTrouble EtalonLoop::run() {
  if (auto trouble = begin_with_etalon(loop_)) return trouble;
  for (std::size_t i = 0; i < 2; ++i) {
    if (auto trouble = align(i)) return trouble;
    if (auto trouble = center(i)) return trouble;
    if (auto trouble = align(i)) return trouble;
  }
  if (auto trouble = zoom()) return trouble;
  return square();
}

}  // namespace flexura
