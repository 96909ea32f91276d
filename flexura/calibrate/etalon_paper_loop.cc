#include "flexura/calibrate/etalon_paper_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/calibrate/etalon_loop.h"
#include "flexura/calibrate/offset_steps.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

using PaperTrouble = LookLoop::Trouble;

/// A printed procedure: what is counted, and what moves.
struct EtalonPaperLoop::Procedure {
  const char* step;
  int EtalonCounts::* from;
  int EtalonCounts::* less;
  Eigen::Vector4d by;  ///< Of pan, tilt, stage x and y, for a positive offset, in the steps' signs.
  bool needs_axes = false;
};

namespace {

void tell_counts(const EtalonCounts& counts, const LookLoop& loop, RigSight& sight) {
  sight.seen.reason = counts.reason;
  if (!counts.reason.empty()) return;
  // As drawn_etalon has them: what is counted bounds the silhouette, and an axis is a column.
  constexpr double whole_pixel = 0.29;  // Of a place known to a pixel, the standard deviation, px.
  const SensorConfig& sensor = loop.believed().cameras[sight.stance.camera].sensor;
  const double left = counts.left, right = static_cast<double>(sensor.width - 1 - counts.right),
               top = counts.above, bottom = static_cast<double>(sensor.height - 1 - counts.below);
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(left, top), {left, bottom}, {right, bottom}, {right, top}})
    sight.seen.points.push_back({corner, whole_pixel});
  for (const double axis : counts.axes)
    for (const double share : {0.75, 0.25})
      sight.seen.markers.push_back(
          {{axis, bottom + share * (top - bottom)}, share * loop.config().etalon.height, whole_pixel});
  sight.values = {{"white left, px", static_cast<double>(counts.left)},
                  {"white right, px", static_cast<double>(counts.right)},
                  {"white above, px", static_cast<double>(counts.above)},
                  {"white below, px", static_cast<double>(counts.below)},
                  {"black in the first line, px", static_cast<double>(counts.first)},
                  {"black in the last line, px", static_cast<double>(counts.last)},
                  {"white, px", static_cast<double>(counts.white)},
                  {"red axes", static_cast<double>(counts.axes.size())}};
}

}  // namespace

PaperTrouble EtalonPaperLoop::look(std::size_t i) {
  auto trouble = loop_.look(i, [this, i](RigSight& sight) {
    counts_[i] = count_etalon(eight_bits(*sight.frame.picture, loop_.model(i).sensor.white()));
    tell_counts(counts_[i], loop_, sight);
  });
  if (trouble) return trouble;
  if (!counts_[i].reason.empty())
    return fmt::format("camera {} does not see the cylinder: {}", loop_.name(i), counts_[i].reason);
  return std::nullopt;
}

PaperTrouble EtalonPaperLoop::follow(std::size_t i, const Procedure& what) {
  EqualSteps steps(1, loop_.config().accepted);
  for (;;) {
    if (auto trouble = look(i)) return trouble;
    bool is_turned = false;
    if (what.needs_axes)
      if (auto trouble = turn_away(i, is_turned)) return trouble;
    if (is_turned) {
      steps = EqualSteps(1, loop_.config().accepted);
      continue;
    }
    const double offset = counts_[i].*what.from - counts_[i].*what.less;
    const LoopState state = steps.take(offset);
    if (state == LoopState::stuck)
      return fmt::format("{} of camera {} {}", what.step, loop_.name(i), steps.reason());
    RigStance next = loop_.stance(i);
    const Eigen::Vector4d by = steps.move() * what.by;
    next.head.pan += by[0], next.head.tilt += by[1];
    next.stage.offset += Eigen::Vector3d(by[2], by[3], 0);
    next = loop_.commandable_stance(i, next);
    loop_.decide(i, what.step, offset, loop_.config().accepted, "px",
                 state == LoopState::holds ? "holds" : "a step");
    if (state == LoopState::holds) return std::nullopt;
    if (loop_.stands_there(i, next))
      return fmt::format("{} of camera {}: a step more cannot be commanded, {:.3g} px before it holds",
                         what.step, loop_.name(i), std::abs(offset));
    if (auto trouble = loop_.go(i, next)) return trouble;
  }
}

PaperTrouble EtalonPaperLoop::turn_away(std::size_t i, bool& is_turned) {
  const std::vector<double>& axes = counts_[i].axes;
  if (axes.empty()) return fmt::format("camera {} sees no red axis", loop_.name(i));
  is_turned = axes.size() > 1;
  if (!is_turned) return std::nullopt;
  constexpr int most = 3;
  if (++turned_away_[i] > most)
    return fmt::format(
        "horizontal positioning of camera {} cannot stop: each time that the outer of two red axes was "
        "turned out of the picture both were there again when the cylinder was back in its middle",
        loop_.name(i));
  const auto off = [&](double u) { return std::abs(u - counts_[i].middle); };
  const double outer = off(axes.front()) > off(axes.back()) ? axes.front() : axes.back();
  const Intrinsics lens = loop_.lens(i);
  const auto width = static_cast<double>(loop_.model(i).sensor.width);
  constexpr double margin = 8;  // px, more than half of a line's width.
  const double beyond = outer < counts_[i].middle ? -margin : width - 1 + margin;
  const double turn = std::atan((beyond - lens.cx) / lens.fx) - std::atan((outer - lens.cx) / lens.fx);
  RigStance next = loop_.stance(i);
  next.head.pan += turn;
  next = loop_.commandable_stance(i, next);
  loop_.decide(
      i, "horizontal positioning", off(outer), 0, "px",
      fmt::format("two axes are seen: pan by {:.4f} rad, so that the outer one leaves the picture", turn));
  return loop_.go(i, next);
}

PaperTrouble EtalonPaperLoop::horizontal(std::size_t i) {
  const LoopConfig& config = loop_.config();
  using C = EtalonCounts;
  for (;;) {
    if (auto trouble = follow(i, {"horizontal orientation", &C::left, &C::right, {-config.turn, 0, 0, 0}}))
      return trouble;
    if (auto trouble =
            follow(i, {"horizontal positioning", &C::left, &C::right, {0, 0, config.slide, 0}, true}))
      return trouble;
    if (auto trouble = look(i)) return trouble;
    const int offset = counts_[i].left - counts_[i].right;
    const bool holds = std::abs(offset) <= config.accepted;
    loop_.decide(i, "full horizontal calibration", offset, config.accepted, "px",
                 holds ? "stops" : "goes to step 1");
    if (holds) return std::nullopt;
  }
}

PaperTrouble EtalonPaperLoop::vertical(std::size_t i) {
  const LoopConfig& config = loop_.config();
  using C = EtalonCounts;
  if (auto trouble = follow(i, {"vertical orientation", &C::above, &C::below, {0, -config.turn, 0, 0}}))
    return trouble;
  if (auto trouble = follow(i, {"vertical positioning", &C::first, &C::last, {0, 0, 0, config.slide}}))
    return trouble;
  // As printed the offset of the orientation is computed, and that of the positioning tested, which was just
  // accepted: it always stops.
  if (auto trouble = look(i)) return trouble;
  loop_.decide(i, "full vertical calibration", counts_[i].first - counts_[i].last, config.accepted, "px",
               "stops");
  if (counts_[i].above == 0 && counts_[i].below == 0)
    return fmt::format(
        "vertical calibration of camera {} stops, but the cylinder touches the upper and the lower border of "
        "its picture: that it is as far from both tells nothing",
        loop_.name(i));
  return std::nullopt;
}

PaperTrouble EtalonPaperLoop::zoom() {
  EqualSteps steps(1, loop_.config().zoom_accepted);
  for (;;) {
    for (std::size_t i = 0; i < 2; ++i)
      if (auto trouble = look(i)) return trouble;
    const double ratio = static_cast<double>(counts_[1].white) / static_cast<double>(counts_[0].white);
    const LoopState state = steps.take(ratio - 1);
    // As printed: of the camera that shows the cylinder larger already.
    const std::size_t chosen = ratio < 1 ? 1 : 0;
    if (state == LoopState::stuck)
      return "zoom " + steps.reason() +
             "; as printed the camera that shows the larger cylinder is the one that zooms in";
    loop_.decide(chosen, "zoom", ratio - 1, loop_.config().zoom_accepted, "share",
                 state == LoopState::holds ? "stops" : fmt::format("zoom in with {}", loop_.name(chosen)));
    loop_.result().zoom_ratio = ratio;
    if (state == LoopState::holds) return std::nullopt;
    RigStance next = loop_.stance(chosen);
    next.head.zoom = zoom_by(loop_.camera(chosen), next.head.zoom, 1 + loop_.config().zoom_step);
    next = loop_.commandable_stance(chosen, next);
    if (loop_.stands_there(chosen, next))
      return fmt::format("zoom runs away: camera {} is at the end of its zoom", loop_.name(chosen));
    if (auto trouble = loop_.go(chosen, next)) return trouble;
  }
}

PaperTrouble EtalonPaperLoop::run() {
  if (auto trouble = begin_with_etalon(loop_)) return trouble;
  for (std::size_t i = 0; i < 2; ++i) {
    if (auto trouble = horizontal(i)) return trouble;
    if (auto trouble = vertical(i)) return trouble;
  }
  if (auto trouble = zoom()) return trouble;
  // Nothing as printed asks whether what is counted is all of the cylinder.
  for (std::size_t i = 0; i < 2; ++i) {
    const EtalonCounts& last = counts_[i];
    if (std::min({last.left, last.right, last.above, last.below}) == 0)
      return fmt::format(
          "all procedures stop, but the cylinder touches the border of camera {}'s picture: a part was "
          "counted",
          loop_.name(i));
  }
  loop_.result().zoom_ratio.reset();  // White pixels are no magnification.
  loop_.result().notes.emplace_back(
      "as printed: where the cameras stand around the cylinder was not measured, for the white pixels beside "
      "the red axis do not depend on where the axis is");
  return std::nullopt;
}

}  // namespace flexura
