#include "flexura/calibrate/arcs_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/camera/mount.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

// Of an arm that has as many.
std::size_t fewest_markers(const LoopConfig& config) {
  return std::min<std::size_t>(5, config.picture.markers.size());
}

ArmPictureConfig picture_of(const LookLoop& loop, std::size_t i) {
  ArmPictureConfig picture = loop.config().picture;
  picture.white = loop.model(i).sensor.white();
  return picture;
}

// Of the arm, unbent.
Eigen::Vector3d middle_of(const LookLoop& loop) {
  return arm_middle(loop.believed(), ArmState::straight(loop.believed().arm.sections.size()));
}

}  // namespace

RigPrior arcs_prior(RigPrior prior) {
  // The same factors in both arcs. Two cameras that each look from about one place would not tell how the
  // planes of two arcs stand to each other that bend each as they like.
  prior.arm.bend_share = prior.arm.bend = 0;
  for (CameraPrior& camera : prior.cameras) {
    camera.pan_zero = camera.tilt_zero = camera.tilt_axis = camera.pupil = camera.pupil_shift = 0;
    camera.focal = camera.aspect = camera.zoom_row = 0;
    camera.distortion = {0, 0, 0, 0, 0};
    camera.principal_point = 1;
  }
  return prior;
}

ArcsLoop::ArcsLoop(LookLoop& loop)
    : loop_(loop),
      prior_(arcs_prior(loop.config().prior.value_or(rough_prior(loop.believed())))),
      sights_(loop.believed().arm, loop.config().picture, loop.config().cameras),
      reader_(loop.believed(), prior_, loop.config().cameras, middle_of(loop),
              fewest_markers(loop.config())) {
  for (std::size_t i = 0; i < 2; ++i) eyes_.emplace_back(picture_of(loop, i));
}

LookLoop::Trouble ArcsLoop::look(std::size_t i, std::size_t arc) {
  const std::size_t fewest = fewest_markers(loop_.config());
  std::size_t markers = 0;  // Whichever they are.
  auto trouble = loop_.look(i, [&](RigSight& sight) {
    ArmFigure figure = eyes_[i].look(*sight.frame.picture);
    markers = markers_of(figure.scene);
    sight.seen.reason = figure.reason;
    if (figure.reason.empty()) keep(i, std::move(figure), sight);
    if (markers < fewest && sight.seen.reason.empty())
      sight.seen.reason = fmt::format("{} markers are seen, fewer than {}", markers, fewest);
    sight.values = {{"markers", static_cast<double>(sight.seen.markers.size())}};
  });
  if (trouble) return trouble;
  return markers < fewest ? into_view(i, arc) : std::nullopt;
}

// Keeps a picture among all of them, and tells which of its markers is which by these.
void ArcsLoop::keep(std::size_t i, ArmFigure figure, RigSight& sight) {
  const auto pose = std::ranges::find(sights_.poses, sight.pose);
  const auto pose_number = static_cast<std::size_t>(pose - sights_.poses.begin());
  if (pose == sights_.poses.end()) sights_.poses.push_back(sight.pose);
  RigStance stance = sight.stance;
  if (stance_[i]) {
    const RigStance& last = sights_.stances[*stance_[i]];
    if (last.head.pan == stance.head.pan && last.head.tilt == stance.head.tilt) stance.turned_as = stance_[i];
    if (last.head != stance.head || last.stage != stance.stage) stance_[i].reset();
  }
  if (!stance_[i]) {
    stance_[i] = sights_.stances.size();
    sights_.stances.push_back(stance);
  }
  sights_.looks.push_back({.stance = *stance_[i], .pose = pose_number, .arm = std::move(figure)});
  sight.seen = sights_.seen(model(), sights_.looks.size() - 1, reader_.read_last(sights_, before()));
}

// Turns towards what is dark in the picture until enough markers are seen.
LookLoop::Trouble ArcsLoop::into_view(std::size_t i, std::size_t arc) {
  const RigSight& sight = loop_.sight();
  const Intrinsics lens = loop_.lens(i);
  const auto middle = dark_centroid(eight_bits(*sight.frame.picture, loop_.model(i).sensor.white()));
  if (!middle)
    return fmt::format("the arm is out of view of camera {}: {}", loop_.name(i), sight.seen.reason);
  RigStance next = loop_.stance(i);
  next.head.pan -= std::atan((middle->x() - lens.cx) / lens.fx);
  next.head.tilt -= std::atan((middle->y() - lens.cy) / lens.fy);
  next = loop_.commandable_stance(i, next);
  const double off = (*middle - Eigen::Vector2d(lens.cx, lens.cy)).norm();
  constexpr double near = 4;  // px: it is in the middle, and yet too little is seen.
  if (off < near || loop_.stands_there(i, next))
    return fmt::format("camera {} does not see enough of the arm: {}", loop_.name(i), sight.seen.reason);
  loop_.decide(i, "into view", off, 0, "px", "turn towards what is seen: " + sight.seen.reason);
  if (auto trouble = loop_.go(i, next)) return trouble;
  return look(i, arc);
}

// Both arcs, seen by both cameras, and where the cameras are by all that was seen.
LookLoop::Trouble ArcsLoop::locate() {
  for (const std::size_t arc : {std::size_t{0}, std::size_t{1}}) {
    if (auto trouble = loop_.show(plan_.arcs[arc])) return trouble;
    for (std::size_t i = 0; i < 2; ++i)
      if (auto trouble = look(i, arc)) return trouble;
  }
  foretold_.reset();
  if (reading_) foretold_ = angle({AskedStance{loop_.stance(0), {}}, AskedStance{loop_.stance(1), {}}});
  RigReading reading = reader_.read(sights_, before());
  if (!reading.found.is_found) return "no two cameras explain what was seen: " + reading.found.reason;
  reading_ = std::move(reading);
  const RigVariables& variables = reading_->problem->variables();
  angle_ = angle({observed_stance(variables, *stance_[0]), observed_stance(variables, *stance_[1])});
  for (std::size_t i = 0; i < 2; ++i) loop_.result().roll[i] = roll_of(pose(i).rotation);
  loop_.result().angle = angle_.value - std::numbers::pi / 2;
  return std::nullopt;
}

Pose ArcsLoop::pose(std::size_t i) const { return view_of(model(), loop_.stance(i)).X_WC; }

ArcsLoop::Angle ArcsLoop::angle(const std::array<AskedStance, 2>& stances) const {
  const RigVariables& variables = reading_->problem->variables();
  const RigQuantity asked = axes_angle(optical_axis(variables, reading_->found.x, stances[0]),
                                       optical_axis(variables, reading_->found.x, stances[1]));
  Angle angle{asked.value, asked.sigma(reading_->found.covariance)};
  // What heads do with commands of which nothing was seen yet.
  for (std::size_t i = 0; i < 2; ++i)
    if (!stances[i].observed)
      angle.sigma = std::hypot(angle.sigma, prior_.cameras[loop_.config().cameras[i]].steps *
                                                loop_.camera(i).head_axes()[0].resolution);
  return angle;
}

// Why what was seen cannot be trusted.
LookLoop::Trouble ArcsLoop::disagreement() const {
  if (!reading_->is_whole())
    return fmt::format(
        "{:.0f} of {:.0f} things that were seen are not explained: expected a twentieth at most",
        reading_->amiss, reading_->things);
  if (!foretold_) return std::nullopt;
  constexpr double farthest = 6;  // Standard deviations.
  const double off = std::abs(angle_.value - foretold_->value);
  if (off <= farthest * foretold_->sigma) return std::nullopt;
  return fmt::format(
      "the last pictures do not agree with those before: the angle between the axes is {:.3f} deg, foretold "
      "were {:.3f} deg with a standard deviation of {:.3f} deg",
      angle_.value / degree, foretold_->value / degree, foretold_->sigma / degree);
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

// How far it may be when nothing brings it nearer: by what the pictures do not tell, and what cannot be
// commanded, px.
double ArcsLoop::allowed(std::size_t i) const {
  constexpr double likely = 4;  // Standard deviations, or steps.
  const double distance = std::abs((plan_.ideal[i].X_WC.position - plan_.centers[i]).dot(plan_.normals[i]));
  double finest = angle_.sigma;
  for (const auto& axis : {loop_.camera(i).head_axes()[0], loop_.camera(i).head_axes()[1]})
    finest = std::max(finest, axis.resolution);
  for (const auto& axis : loop_.camera(i).stage_axes()) finest = std::max(finest, axis.resolution / distance);
  return std::max(loop_.config().accepted, likely * loop_.lens(i).fx * finest);
}

// The commands that bring both cameras to where the simulator has them; of the heads' positions around, the
// pans whose axes are together the most nearly orthogonal.
ArcsLoop::Wanted ArcsLoop::wanted() const {
  std::array<RigStance, 2> stances = {loop_.stance(0), loop_.stance(1)};
  std::array<double, 2> pans = {0, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    const CameraConfig& camera = model().cameras[loop_.config().cameras[i]];
    stances[i].head = Camera(camera).looking_along(plan_.ideal[i].X_WC.rotation.col(2), stances[i].head.zoom);
    pans[i] = stances[i].head.pan;
    const double tilt = stances[i].head.tilt;
    stances[i] = loop_.commandable_stance(i, stances[i]);
    // Where the pupil will be by then decides how far the stage goes.
    stances[i].stage.offset = stage_towards(camera, stances[i], plan_.ideal[i].X_WC.position);
    stances[i].head.tilt = tilt;
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
  Wanted wanted{stances, {false, false}};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto is_beyond = [&](double is, double asked, const AxisConfig& axis) {
      return std::abs(is - asked) > 2 * axis.resolution + 1e-9;
    };
    const auto& [pan, tilt, zoom] = loop_.camera(i).head_axes();
    bool is_short = is_beyond(stances[i].head.pan, pans[i], pan) ||
                    is_beyond(stances[i].head.tilt, base[i].head.tilt, tilt);
    for (int k = 0; k < 3; ++k)
      is_short = is_short || is_beyond(stances[i].stage.offset[k], base[i].stage.offset[k],
                                       loop_.camera(i).stage_axes()[static_cast<std::size_t>(k)]);
    wanted.is_short[i] = is_short;
  }
  return wanted;
}

// Looks and moves until both cameras are where the simulator has them.
LookLoop::Trouble ArcsLoop::square() {
  std::array<double, 2> last = {std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
  for (;;) {
    if (auto trouble = locate()) return trouble;
    const auto [next, is_short] = wanted();
    bool is_moved = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const double off = offset(i);
      const bool is_there = loop_.stands_there(i, next[i]), is_far = off > allowed(i);
      if (is_far && (is_there || is_short[i])) {
        const auto side = LookLoop::look_from_one_side(model(), {loop_.stance(0), loop_.stance(1)}, "seen");
        return fmt::format("{}camera {}: what can be commanded ends {:.4g} px before it holds",
                           side ? *side + "; " : "", loop_.name(i), off);
      }
      const bool is_accepted = off <= loop_.config().accepted || is_there;
      // Small steps that shrink no more are what the pictures do not tell.
      const bool is_noise = off > 0.5 * last[i] && !is_far;
      last[i] = off;
      const bool goes = !is_accepted && !is_noise;
      std::string decision =
          is_accepted ? "holds, or nothing finer can be commanded" : "holds: the pictures tell nothing finer";
      if (goes)
        decision = fmt::format(
            "residuals are {:.2f} times their noise, the angle between the axes is known within {:.3f} deg; "
            "pan to {:.5g} rad, tilt to {:.5g} rad, stage to {:.4g}, {:.4g}, {:.4g} m",
            reading_->found.rms, angle_.sigma / degree, next[i].head.pan, next[i].head.tilt,
            next[i].stage.offset.x(), next[i].stage.offset.y(), next[i].stage.offset.z());
      loop_.decide(i, "orientation and positioning", off, loop_.config().accepted, "px", decision);
      if (!goes) continue;
      if (auto trouble = loop_.go(i, next[i])) return trouble;
      is_moved = true;
    }
    if (!is_moved) return disagreement();
  }
}

// How many times as long a focal length shows half of the markers of both arcs still.
double ArcsLoop::longer(std::size_t i) const {
  constexpr double most = 2.5, less = 0.95, margin = 20;  // px
  const std::vector<KnownMarker>& markers = loop_.config().picture.markers;
  const std::size_t enough = std::max(fewest_markers(loop_.config()), markers.size() / 2);
  double times = most;
  for (; times > 1; times *= less) {
    RigStance stance = loop_.stance(i);
    stance.head.zoom = zoom_by(loop_.camera(i), stance.head.zoom, times);
    const View view = view_of(model(), stance);
    const bool shows = std::ranges::all_of(plan_.arcs, [&](const ArmState& arc) {
      const MarkerScene scene =
          expected_markers(model().arm, model().bent(arc), markers, view, loop_.believed().arm);
      const auto inside = std::ranges::count_if(scene.markers, [&](const auto& place) {
        return place && place->pixel.minCoeff() > margin && place->pixel.x() < view.width - 1 - margin &&
               place->pixel.y() < view.height - 1 - margin;
      });
      return static_cast<std::size_t>(inside) >= enough;
    });
    if (shows) break;
  }
  return std::max(1.0, times);
}

// What a longer focal length moves in the picture moves away from the principal point.
LookLoop::Trouble ArcsLoop::center() {
  constexpr double least = 1.2;  // Where noise counts eight times.
  std::array<std::optional<RigStance>, 2> wide;
  for (std::size_t i = 0; i < 2; ++i) {
    RigStance next = loop_.stance(i);
    next.head.zoom = zoom_by(loop_.camera(i), next.head.zoom, longer(i));
    next = loop_.commandable_stance(i, next);
    const double times = loop_.camera(i).lens().at(next.head.zoom).fx / loop_.lens(i).fx;
    if (times < least) {
      loop_.result().notes.push_back(
          fmt::format("{}: the principal point is taken to be known within 1 px: enough of the arm is in the "
                      "picture up to {:.2f} times the focal length, expected {}",
                      loop_.name(i), std::max(1.0, times), least));
      continue;
    }
    loop_.decide(i, "principal point", 0, 0, "px",
                 fmt::format("zoom to {:.5g}, for what stays where it is", next.head.zoom));
    wide[i] = loop_.stance(i), is_centered_[i] = true;
    if (auto trouble = loop_.go(i, next)) return trouble;
  }
  if (!wide[0] && !wide[1]) return std::nullopt;
  for (const std::size_t arc : {std::size_t{0}, std::size_t{1}}) {
    if (auto trouble = loop_.show(plan_.arcs[arc])) return trouble;
    for (std::size_t i = 0; i < 2; ++i)
      if (wide[i])
        if (auto trouble = look(i, arc)) return trouble;
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (wide[i])
      if (auto trouble = loop_.go(i, *wide[i])) return trouble;
  return std::nullopt;
}

LookLoop::Trouble ArcsLoop::run() {
  if (auto trouble = begin_with_arm(loop_)) return trouble;
  if (auto why = plan_arcs(loop_, false, plan_)) return why;
  loop_.result().target = plan_.target;
  if (auto trouble = zoom_as_planned(loop_, plan_)) return trouble;
  if (auto trouble = square()) return trouble;
  if (auto trouble = center()) return trouble;
  if (auto trouble = square()) return trouble;
  loop_.result().notes.push_back(
      fmt::format("the angle between the axes is known within {:.3f} deg (standard deviation); residuals are "
                  "{:.2f} times their noise",
                  angle_.sigma / degree, reading_->found.rms));
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_centered_[i]) continue;
    const Intrinsics was = loop_.lens(i), is = Camera(model().cameras[loop_.config().cameras[i]])
                                                   .lens()
                                                   .at(loop_.stance(i).head.zoom);
    loop_.result().principal_point[i] = Eigen::Vector2d(is.cx - was.cx, is.cy - was.cy);
  }
  return equalize_zooms(loop_, plan_);
}

}  // namespace flexura
