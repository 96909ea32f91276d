#include "flexura/calibrate/arcs_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "flexura/calibrate/eight_bits.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/camera/mount.h"

namespace flexura {
namespace {

constexpr double in_degrees = 180 / std::numbers::pi;
constexpr std::size_t fewest_markers = 4;

// The camera in its mount's frame at stage offset 0.
Pose in_mount(const Camera& camera, const RigStance& stance) {
  return camera.mount().inverse() * camera.pose(stance.stage, stance.head);
}

}  // namespace

ArcsLoop::ArcsLoop(LookLoop& loop) : loop_(loop) {
  ArmPictureConfig picture = loop.config().picture;
  picture.white = loop.config().white;
  for (std::size_t i = 0; i < 2; ++i) eyes_.emplace_back(picture), X_WM_[i] = loop.camera(i).mount();
}

Pose ArcsLoop::pose(std::size_t i) const { return X_WM_[i] * in_mount(loop_.camera(i), loop_.stance(i)); }

View ArcsLoop::expected_view(std::size_t i) const {
  View view = plan_.ideal[i];
  view.lens = Lens(loop_.lens(i));
  view.X_WC = pose(i);
  return view;
}

LookLoop::Trouble ArcsLoop::look(std::size_t i, std::size_t arc) {
  const Arm& arm = loop_.believed().arm;
  ArcPicture seen{i, in_mount(loop_.camera(i), loop_.stance(i)), plan_.arcs[arc], {}};
  auto trouble = loop_.look(i, [&](RigSight& sight) {
    const View view = expected_view(i);
    sight.seen = eyes_[i].see(*sight.frame.picture, view.lens,
                              expected_markers(arm, plan_.arcs[arc], loop_.config().picture.markers, view));
    // What is recognised far from where it is known to be by now is something else.
    constexpr double far = 15;  // px
    if (is_located_)
      std::erase_if(sight.seen.markers, [&](const SeenMarker& marker) {
        const auto place =
            expected_markers(arm, plan_.arcs[arc], {KnownMarker{.s = marker.s}}, view).markers[0];
        return !place || (place->pixel - marker.pixel).norm() > far;
      });
    if (sight.seen.markers.size() < fewest_markers && sight.seen.reason.empty())
      sight.seen.reason =
          fmt::format("{} markers are recognised, fewer than {}", sight.seen.markers.size(), fewest_markers);
    sight.values = {{"markers", static_cast<double>(sight.seen.markers.size())}};
    seen.markers = sight.seen.markers;
  });
  if (trouble) return trouble;
  if (!loop_.sight().seen.reason.empty()) return into_view(i, arc);
  pictures_.push_back(std::move(seen));
  return std::nullopt;
}

// Turns towards what is dark in the picture until enough markers are seen.
LookLoop::Trouble ArcsLoop::into_view(std::size_t i, std::size_t arc) {
  const RigSight& sight = loop_.sight();
  const Intrinsics lens = loop_.lens(i);
  const auto middle = dark_centroid(eight_bits(*sight.frame.picture, loop_.config().white));
  if (!middle)
    return fmt::format("the arm is out of view of camera {}: {}", loop_.name(i), sight.seen.reason);
  RigStance next = loop_.stance(i);
  next.head.pan -= std::atan((middle->x() - lens.cx) / lens.fx);
  next.head.tilt -= std::atan((middle->y() - lens.cy) / lens.fy);
  next = loop_.commandable_stance(i, next);
  const double off = (*middle - Eigen::Vector2d(lens.cx, lens.cy)).norm();
  constexpr double near = 4;  // px: it is in the middle, and yet too little is recognised.
  if (off < near || loop_.stands_there(i, next))
    return fmt::format("camera {} does not see enough of the arm: {}", loop_.name(i), sight.seen.reason);
  loop_.decide(i, "into view", off, 0, "px", "turn towards what is seen: " + sight.seen.reason);
  if (auto trouble = loop_.go(i, next)) return trouble;
  return look(i, arc);
}

// Both arcs, seen by both cameras, and where the cameras are by that.
LookLoop::Trouble ArcsLoop::locate() {
  for (const std::size_t arc : {std::size_t{0}, std::size_t{1}}) {
    if (auto trouble = loop_.show(plan_.arcs[arc])) return trouble;
    for (std::size_t i = 0; i < 2; ++i)
      if (auto trouble = look(i, arc)) return trouble;
  }
  fit_ = fit_arcs(loop_.believed().arm, {loop_.lens(0), loop_.lens(1)}, pictures_, X_WM_);
  if (!fit_.reason.empty()) return fit_.reason;
  is_located_ = true;
  X_WM_ = fit_.X_WM;
  for (std::size_t i = 0; i < 2; ++i) loop_.result().roll[i] = roll_of(pose(i).rotation);
  loop_.result().angle =
      std::acos(std::clamp(pose(0).rotation.col(2).dot(pose(1).rotation.col(2)), -1.0, 1.0)) -
      std::numbers::pi / 2;
  return std::nullopt;
}

// How far a camera's picture is from the simulator's, as the larger of turn and shift, px.
double ArcsLoop::offset(std::size_t i) const {
  const Pose is = pose(i);
  const Pose& ideal = plan_.ideal[i].X_WC;
  const double turn = std::acos(std::clamp(is.rotation.col(2).dot(ideal.rotation.col(2)), -1.0, 1.0));
  const Eigen::Vector3d shift = ideal.rotation.transpose() * (is.position - ideal.position);
  const double distance = std::abs((ideal.position - plan_.centers[i]).dot(plan_.normals[i]));
  return loop_.lens(i).fx * std::max(turn, shift.norm() / distance);
}

// The commands that bring both cameras to where the simulator has them; of the heads' positions around, the
// pans whose axes are together the most nearly orthogonal.
std::array<RigStance, 2> ArcsLoop::wanted() const {
  std::array<RigStance, 2> stances = {loop_.stance(0), loop_.stance(1)};
  std::array<double, 2> pans = {0, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Matrix3d& R_WM = X_WM_[i].rotation;
    const Eigen::Vector3d u = R_WM.transpose() * plan_.ideal[i].X_WC.rotation.col(2);
    stances[i].head.tilt = std::asin(std::clamp(-u.y(), -1.0, 1.0));
    pans[i] = stances[i].head.pan = std::atan2(-u.x(), u.z());
    stances[i] = loop_.commandable_stance(i, stances[i]);
    // Where the pupil will be by then decides how far the stage goes.
    const Eigen::Vector3d will_be = (X_WM_[i] * in_mount(loop_.camera(i), stances[i])).position;
    stances[i].stage.offset += R_WM.transpose() * (plan_.ideal[i].X_WC.position - will_be);
  }
  double least = std::numeric_limits<double>::infinity();
  const std::array<RigStance, 2> base = stances;
  for (const int a : {0, -1, 1}) {
    for (const int b : {0, -1, 1}) {
      std::array<RigStance, 2> tried = base;
      tried[0].head.pan += a * loop_.camera(0).head_axes()[0].resolution;
      tried[1].head.pan += b * loop_.camera(1).head_axes()[0].resolution;
      for (std::size_t i = 0; i < 2; ++i) tried[i] = loop_.commandable_stance(i, tried[i]);
      const double off0 = tried[0].head.pan - pans[0], off1 = tried[1].head.pan - pans[1];
      constexpr double aim = 0.01;
      const double cost = std::abs(off0 - off1) + aim * (std::abs(off0) + std::abs(off1));
      if (cost < least) least = cost, stances = tried;
    }
  }
  return stances;
}

LookLoop::Trouble ArcsLoop::run() {
  if (auto trouble = begin_with_arm(loop_)) return trouble;
  if (auto why = plan_arcs(loop_, false, plan_)) return why;
  loop_.result().target = plan_.target;
  if (auto trouble = zoom_as_planned(loop_, plan_)) return trouble;
  std::array<double, 2> last = {std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
  for (;;) {
    if (auto trouble = locate()) return trouble;
    const std::array<RigStance, 2> next = wanted();
    bool is_moved = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const double off = offset(i);
      const bool is_accepted = off <= loop_.config().accepted || loop_.stands_there(i, next[i]);
      // Steps that shrink no more are what the pictures do not tell.
      const bool is_noise = off > 0.5 * last[i];
      last[i] = off;
      const bool goes = !is_accepted && !is_noise;
      std::string decision =
          is_accepted ? "holds, or nothing finer can be commanded" : "holds: the pictures tell nothing finer";
      if (goes)
        decision = fmt::format(
            "{:.2f} px are left of the markers; pan to {:.5g} rad, tilt to {:.5g} rad, "
            "stage to {:.4g}, {:.4g}, {:.4g} m",
            fit_.rms, next[i].head.pan, next[i].head.tilt, next[i].stage.offset.x(), next[i].stage.offset.y(),
            next[i].stage.offset.z());
      loop_.decide(i, "orientation and positioning", off, loop_.config().accepted, "px", decision);
      if (!goes) continue;
      if (auto trouble = loop_.go(i, next[i])) return trouble;
      is_moved = true;
    }
    if (!is_moved) break;
  }
  loop_.result().notes.push_back(fmt::format(
      "turned about the vertical within {:.3f} deg and {:.3f} deg (standard deviations); {:.2f} px are left "
      "of the markers",
      fit_.turn_sigma[0] * in_degrees, fit_.turn_sigma[1] * in_degrees, fit_.rms));
  return equalize_zooms(loop_, plan_);
}

}  // namespace flexura
