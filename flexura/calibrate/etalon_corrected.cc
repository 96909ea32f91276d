#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/base/degree.h"
#include "flexura/calibrate/etalon_loop.h"
#include "flexura/calibrate/etalon_observer.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

class EtalonCorrected : public EtalonLoop {
 public:
  explicit EtalonCorrected(LookLoop& loop) : EtalonLoop(loop, false) {}

 private:
  // The lens with the principal point estimated so far.
  [[nodiscard]] Intrinsics lens(std::size_t i) const {
    Intrinsics lens = loop_.lens(i);
    lens.cx += beside_[i].x(), lens.cy += beside_[i].y();
    return lens;
  }

  Error look(std::size_t i) override {
    return loop_.look(i, [this, i](CameraObservation& observed) {
      const EtalonView& view = views_[i] =
          view_etalon(eight_bits(*observed.frame.picture, loop_.model(i).sensor.white()), lens(i),
                      loop_.config().etalon.radius);
      if (view.reason.empty()) {
        observed.seen =
            drawn_etalon(view.observation, loop_.config().etalon, view_of(loop_.nominal(), observed.stance));
        observed.values = {{"silhouette right of the middle, px", view.middle},
                           {"line right of the silhouette's middle, px", view.line},
                           {"silhouette below the middle, px", view.height},
                           {"width above minus width below, px", view.taper},
                           {"width, px", view.width}};
      }
      observed.seen.reason = view.reason;
    });
  }
  Error unmeasured(std::size_t i) const override {
    return views_[i].reason.empty() ? std::nullopt : std::optional(views_[i].reason);
  }

  std::array<Offset, 4> offsets(std::size_t i) const override {
    const EtalonView& view = views_[i];
    const double by_px = 1 / lens(i).fx, accepted = loop_.config().accepted;
    const double distance = view.distance, turn = 1 / distance;
    constexpr double half_turn = 0.5;  // rad
    const double half_way = 0.5 * distance;
    const auto turned = [&](const char* step, double px, double want, const char* how,
                            const Eigen::Vector4d& by) {
      return Offset{step, px, want, accepted * by_px, half_turn, how, by};
    };
    // A camera that slides keeps looking at the cylinder, so that position and orientation do not undo each
    // other.
    const auto slid = [&](const char* step, double px, double angle, double angle_by_px, const char* how,
                          const Eigen::Vector4d& by) {
      return Offset{step, px, distance * angle, accepted * distance * angle_by_px, half_way, how, by};
    };
    return {turned("horizontal orientation", view.middle, view.sight, "pan", {-1, 0, 0, 0}),
            slid("horizontal positioning", view.line, view.bearing, view.bearing_by_px, "slide to the left",
                 {-turn, 0, -1, 0}),
            turned("vertical orientation", view.height, view.drop, "tilt", {0, -1, 0, 0}),
            slid("vertical positioning", view.taper, view.climb, view.climb_by_px, "slide downwards",
                 {0, turn, 0, 1})};
  }

  // Turns towards the visible part of the cylinder until all of it is visible.
  Error prepare(std::size_t i, std::size_t /*offset*/, bool& is_turned) override {
    const EtalonView& view = views_[i];
    is_turned = !view.reason.empty();
    if (!is_turned) turns_[i] = 0;
    if (!is_turned) return std::nullopt;
    constexpr int most = 8;
    const bool is_vain = view.is_too_large || turns_[i]++ == most;
    return loop_.turn_towards(i, "cylinder", view.centroid,
                              is_vain ? std::numeric_limits<double>::infinity() : 0, lens(i),
                              "camera {} cannot show the whole cylinder: {}", view.reason);
  }

  // Nulls all four offsets in one picture, then again with the principal point found by a longer focal
  // length.
  Error align(std::size_t i) override {
    for (const bool is_centered : {false, true}) {
      if (is_centered)
        if (auto error = center(i)) return error;
      if (auto error = null(i, {0, 1, 2, 3})) return error;
      for (const Offset& offset : offsets(i))
        loop_.decide(
            i, offset.step, offset.px, loop_.config().accepted, "px",
            std::abs(offset.want) <= offset.accepted ? "holds" : "at the resolution of the commands");
      loop_.result().roll[i] = views_[i].roll;
    }
    return std::nullopt;
  }

  // Factor by which the focal length can grow while the whole cylinder stays visible.
  [[nodiscard]] double longer(std::size_t i) const {
    const EtalonObservation& seen = views_[i].observation;
    const Intrinsics lens = this->lens(i);
    const SensorConfig& sensor = loop_.model(i).sensor;
    const double half = 0.5 * (seen.bottom - seen.top);
    double times = std::numeric_limits<double>::infinity();
    const auto keep = [&](double from_middle, double room) {
      constexpr double margin = 12;  // px: more than the error of the principal point times the zoom factor.
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

  // A longer focal length moves image points away from the principal point; this determines it.
  Error center(std::size_t i) {
    const RigStance wide = loop_.stance(i);
    const EtalonView before = views_[i];
    const Intrinsics lens = this->lens(i);
    Intrinsics lens_then = lens;
    for (double times = longer(i);;) {
      RigStance next = wide;
      next.head.zoom = zoom_by(loop_.camera(i), wide.head.zoom, times);
      next = loop_.commandable_stance(i, next);
      lens_then = loop_.camera(i).lens().at(next.head.zoom);
      times = lens_then.fx / lens.fx;
      if (times < LookLoop::least_longer) {
        loop_.result().notes.push_back(
            fmt::format("{}: the principal point of the file is used, because no picture with at least {} "
                        "times the shortest focal length shows the whole cylinder",
                        loop_.name(i), LookLoop::least_longer));
        return loop_.stands_there(i, wide) ? std::nullopt : loop_.go(i, wide);
      }
      if (auto error = loop_.go_longer(i, next)) return error;
      if (auto error = look(i)) return error;
      if (views_[i].reason.empty()) break;
      // A large error of the principal point moves the cylinder out of the picture.
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
                 fmt::format("it is {:.3f} px to the right of and {:.3f} px below its position in the file",
                             off.x(), off.y()));
    return loop_.go(i, wide);
  }

  double ratio() const override { return views_[0].magnification / views_[1].magnification; }

  // Chooses, of the neighbouring positions, the pans whose axes are the most nearly orthogonal; among equals
  // those that look at the cylinder. Then takes one more picture per camera to measure the result.
  Error finish() override {
    constexpr double visible = 0.01;
    if (std::abs(*loop_.result().zoom_ratio - 1) > visible)
      return fmt::format(
          "the zoom ranges of the cameras do not allow equal sizes of the cylinder: the ratio remains {:.4f}",
          *loop_.result().zoom_ratio);
    const auto across = [&](std::size_t i) { return views_[i].bearing + views_[i].sight; };
    const auto step = [&](std::size_t i) { return loop_.camera(i).head_axes()[0].resolution; };
    const auto best = best_steps([&](int a, int b) {
      constexpr double aim = 0.01;
      return std::abs(across(0) + a * step(0) - across(1) - b * step(1)) +
             aim * (std::abs(views_[0].sight + a * step(0)) + std::abs(views_[1].sight + b * step(1)));
    });
    for (std::size_t i = 0; i < 2; ++i) {
      RigStance next = loop_.stance(i);
      next.head.pan += best[i] * step(i);
      next = loop_.commandable_stance(i, next);
      if (!loop_.stands_there(i, next)) {
        loop_.decide(i, "orthogonal axes", (across(0) - across(1)) / degree, 0, "deg",
                     "pan by one step, which makes the axes more nearly orthogonal");
        if (auto error = loop_.go(i, next)) return error;
      }
      if (auto error = look(i)) return error;
      if (!views_[i].reason.empty())
        return fmt::format("camera {} after its last move: {}", loop_.name(i), views_[i].reason);
    }
    // The arrangement of the cameras decides whether the angle between the axes is too small or too large.
    const Eigen::Vector3d a = loop_.camera(0).pose(loop_.stance(0).stance()).rotation.col(2),
                          b = loop_.camera(1).pose(loop_.stance(1).stance()).rotation.col(2);
    const double hand = a.cross(b).y() < 0 ? 1 : -1;
    loop_.result().angle = hand * (across(0) - across(1));
    loop_.result().zoom_ratio = ratio();
    loop_.decide(1, "orthogonal axes", *loop_.result().angle / degree, 0, "deg", "");
    return std::nullopt;
  }

  std::array<EtalonView, 2> views_;
  // Offsets of the principal points to the right of and below the file's values, px.
  std::array<Eigen::Vector2d, 2> beside_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::array<int, 2> turns_ = {0, 0};  // Number of turns towards a cylinder that is partly visible.
};

}  // namespace

std::unique_ptr<EtalonLoop> etalon_corrected(LookLoop& loop) {
  return std::make_unique<EtalonCorrected>(loop);
}

}  // namespace flexura
