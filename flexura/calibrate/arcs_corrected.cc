#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "flexura/base/bounded_text.h"
#include "flexura/base/degree.h"
#include "flexura/calibrate/arcs_loop.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/rig_observer.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/camera/mount.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

RigPrior arcs_prior(RigPrior prior) {
  // The bend factors are equal in both arcs. With independent bends, two cameras that each look from about
  // one place would not determine the angle between the planes of the arcs.
  prior.arm.bend_share = prior.arm.bend = 0;
  for (CameraPrior& camera : prior.cameras) {
    camera.pan_zero = camera.tilt_zero = camera.tilt_axis = camera.pupil = camera.pupil_shift = 0;
    camera.focal = camera.aspect = camera.zoom_row = 0;
    camera.distortion = {};
    camera.principal_point = 1;
  }
  return prior;
}

namespace {

RigSessionConfig observers_of_arcs(const LoopConfig& config) {
  RigSessionConfig session;
  session.cameras = config.cameras, session.picture = config.picture;
  session.fewest = std::min(session.fewest, config.picture.markers.size());
  return session;
}

class ArcsCorrected : public ArcsLoop {
 public:
  explicit ArcsCorrected(LookLoop& loop)
      : ArcsLoop(loop),
        prior_(arcs_prior(loop.config().prior.value_or(rough_prior(loop.nominal())))),
        seen_as_(observers_of_arcs(loop.config())),
        observer_(arm_observer(loop.nominal(), prior_, seen_as_,
                               arm_middle(loop.nominal(), ArmState::straight(loop.nominal().sections())))) {}

 private:
  [[nodiscard]] const RigModel* before() const { return reading_ ? &reading_->found.model : nullptr; }
  [[nodiscard]] const RigModel& model() const { return reading_ ? *before() : loop_.nominal(); }
  [[nodiscard]] const CameraConfig& found(std::size_t i) const {
    return model().cameras[loop_.config().cameras[i]];
  }
  [[nodiscard]] double pan_step(std::size_t i) const { return loop_.camera(i).head_axes()[0].resolution; }

  Error align() override {
    for (const bool is_centered : {false, true}) {
      if (is_centered)
        if (auto error = center()) return error;
      last_.fill(std::numeric_limits<double>::infinity());
      if (auto error = settle({0, 1})) return error;
      if (auto error = disagreement()) return error;
    }
    loop_.result().notes.push_back(fmt::format(
        "standard deviation of the angle between the axes: {} deg; residuals are {:.2f} times their noise",
        bounded_text(angle_.sigma / degree, 90, 3), reading_->found.rms));
    for (std::size_t i = 0; i < 2; ++i) {
      if (!is_centered_[i]) continue;
      const Intrinsics was = loop_.lens(i), is = Camera(found(i)).lens().at(loop_.stance(i).head.zoom);
      loop_.result().principal_point[i] = Eigen::Vector2d(is.cx - was.cx, is.cy - was.cy);
    }
    return std::nullopt;
  }

  // Turns towards what is dark in the picture until enough markers are visible, no matter which.
  Error look(std::size_t i) override {
    for (;;) {
      observer_->sent(i, loop_.stance(i));
      auto error = loop_.look(i, [&](CameraObservation& observed) {
        observer_->see(i, before(), observed);
        if (observer_->markers() < seen_as_.fewest && observed.seen.reason.empty())
          observed.seen.reason =
              fmt::format("{} markers are visible, fewer than {}", observer_->markers(), seen_as_.fewest);
        observed.values = {{"markers", static_cast<double>(observed.seen.markers.size())}};
      });
      if (error || observer_->markers() >= seen_as_.fewest) return error;
      constexpr double near = 4;  // px: the figure is centred, yet too few markers are visible.
      const CameraObservation& observed = loop_.observed();
      error = loop_.turn_towards(
          i, "arm", dark_centroid(eight_bits(*observed.frame.picture, loop_.model(i).sensor.white())), near,
          loop_.lens(i), "camera {} does not see enough of the arm: {}", observed.seen.reason);
      if (error) return error;
    }
  }

  // Estimates the camera poses from all pictures so far, and the poses to move to.
  Error learn() override {
    predicted_.reset();
    if (reading_) predicted_ = angle({AskedStance{loop_.stance(0), {}}, AskedStance{loop_.stance(1), {}}});
    RigReading reading = observer_->read(before());
    if (!reading.found.is_found)
      return "no poses of the two cameras explain the pictures: " + reading.found.reason;
    reading_ = std::move(reading);
    const RigVariables& variables = reading_->problem->variables();
    angle_ = angle({observed_stance(variables, observer_->stance(0).value()),
                    observed_stance(variables, observer_->stance(1).value())});
    for (std::size_t i = 0; i < 2; ++i) loop_.result().roll[i] = roll_of(pose(i).rotation);
    loop_.result().angle = angle_.value - std::numbers::pi / 2;
    find_desired();
    return std::nullopt;
  }

  [[nodiscard]] Pose pose(std::size_t i) const { return view_of(model(), loop_.stance(i)).X_WC; }

  struct Angle {
    double value = 0, sigma = 0;  // Angle between the optical axes and its standard deviation, rad.
  };
  [[nodiscard]] Angle angle(const std::array<AskedStance, 2>& stances) const {
    const RigVariables& variables = reading_->problem->variables();
    const RigQuantity asked = axes_angle(optical_axis(variables, reading_->found.x, stances[0]),
                                         optical_axis(variables, reading_->found.x, stances[1]));
    Angle angle{asked.value, asked.sigma(reading_->found.covariance)};
    // Adds the step error of heads at commanded positions that were not observed yet.
    for (std::size_t i = 0; i < 2; ++i)
      if (!stances[i].observed)
        angle.sigma = std::hypot(angle.sigma, prior_.cameras[loop_.config().cameras[i]].steps * pan_step(i));
    return angle;
  }

  // Returns why the observations cannot be trusted, if so.
  [[nodiscard]] Error disagreement() const {
    if (!reading_->is_whole())
      return fmt::format(
          "the estimate does not explain {:.0f} of {:.0f} observations: expected at most one in twenty",
          reading_->unexplained, reading_->things);
    if (!predicted_) return std::nullopt;
    constexpr double farthest = 6;  // Standard deviations.
    const double off = std::abs(angle_.value - predicted_->value);
    if (off <= farthest * predicted_->sigma) return std::nullopt;
    return fmt::format(
        "the last pictures contradict the earlier ones: the angle between the axes is {:.3f} deg, but the "
        "prediction was {:.3f} deg with a standard deviation of {:.3f} deg",
        angle_.value / degree, predicted_->value / degree, predicted_->sigma / degree);
  }

  // Distance of a camera's ideal position from the plane of its arc, m.
  [[nodiscard]] double distance(std::size_t i) const {
    return std::abs((plan_.ideal[i].X_WC.position - plan_.centers[i]).dot(plan_.normals[i]));
  }

  // Deviation of a camera's picture from the simulator's, px: the larger of rotation and translation.
  [[nodiscard]] double offset(std::size_t i) const {
    const Pose is = pose(i);
    const Pose& ideal = plan_.ideal[i].X_WC;
    const double turn = std::acos(std::clamp(is.rotation.col(2).dot(ideal.rotation.col(2)), -1.0, 1.0));
    const Eigen::Vector3d shift = ideal.rotation.transpose() * (is.position - ideal.position);
    return loop_.lens(i).fx * std::max(turn, shift.norm() / distance(i));
  }

  // Deviation that nothing can reduce further, px: the uncertainty of the pictures and the resolution of
  // commands.
  [[nodiscard]] double allowed(std::size_t i) const {
    constexpr double likely = 4;  // Standard deviations, or steps.
    const auto& [pan, tilt, zoom] = loop_.camera(i).head_axes();
    double finest = std::max({angle_.sigma, pan.resolution, tilt.resolution});
    for (const auto& axis : loop_.camera(i).stage_axes())
      finest = std::max(finest, axis.resolution / distance(i));
    return std::max(loop_.config().accepted, likely * loop_.lens(i).fx * finest);
  }

  // Finds the commands that bring both cameras to the simulator's poses. Of the neighbouring head positions
  // it takes the pans whose axes are the most nearly orthogonal.
  void find_desired() {
    std::array<RigStance, 2> asked = {loop_.stance(0), loop_.stance(1)};
    std::array<double, 2> pans = {0, 0};
    for (std::size_t i = 0; i < 2; ++i) {
      asked[i].head = Camera(found(i)).looking_along(plan_.ideal[i].X_WC.rotation.col(2), asked[i].head.zoom);
      pans[i] = asked[i].head.pan;
      const double tilt = asked[i].head.tilt;
      asked[i] = loop_.commandable_stance(i, asked[i]);
      // The stage offset depends on where the pupil will be after the head's turn.
      asked[i].stage.offset = stage_towards(found(i), asked[i], plan_.ideal[i].X_WC.position);
      asked[i].head.tilt = tilt;
    }
    const auto beside = [&](std::size_t i, int steps) {
      RigStance tried = asked[i];
      tried.head.pan += steps * pan_step(i);
      return loop_.commandable_stance(i, tried);
    };
    const auto best = best_steps([&](int a, int b) {
      const double off0 = beside(0, a).head.pan - pans[0], off1 = beside(1, b).head.pan - pans[1];
      constexpr double aim = 0.01;
      return std::abs(off0 - off1) + aim * (std::abs(off0) + std::abs(off1));
    });
    for (std::size_t i = 0; i < 2; ++i) {
      const RigStance& next = desired_[i] = beside(i, best[i]);
      const auto is_beyond = [](double is, double desired, const AxisConfig& axis) {
        return std::abs(is - desired) > 2 * axis.resolution + 1e-9;
      };
      const auto& [pan, tilt, zoom] = loop_.camera(i).head_axes();
      is_short_[i] =
          is_beyond(next.head.pan, pans[i], pan) || is_beyond(next.head.tilt, asked[i].head.tilt, tilt);
      for (int k = 0; k < 3; ++k)
        is_short_[i] |= is_beyond(next.stage.offset[k], asked[i].stage.offset[k],
                                  loop_.camera(i).stage_axes()[static_cast<std::size_t>(k)]);
    }
  }

  Error decide(std::size_t i, std::optional<RigStance>& next) override {
    const double off = offset(i), last = std::exchange(last_[i], off);
    const bool is_there = loop_.stands_there(i, desired_[i]), is_far = off > allowed(i);
    if (is_far && (is_there || is_short_[i])) {
      const auto side = LookLoop::look_from_one_side(model(), {loop_.stance(0), loop_.stance(1)}, "observed");
      return fmt::format("{}camera {}: at the limit of its range, an offset of {:.4g} px remains",
                         side ? *side + "; " : "", loop_.name(i), off);
    }
    std::string what;
    // Small steps that no longer shrink are below what the pictures determine.
    if (off <= loop_.config().accepted || is_there)
      what = "within the tolerance, or at the resolution of the commands";
    else if (off > 0.5 * last && !is_far)
      what = "within the tolerance, which is the resolution of the pictures";
    else
      next = desired_[i];
    if (next)
      what = fmt::format(
          "residuals are {:.2f} times their noise; standard deviation of the angle between the axes: {} deg; "
          "pan to {:.5g} rad, tilt to {:.5g} rad, stage to {:.4g}, {:.4g}, {:.4g} m",
          reading_->found.rms, bounded_text(angle_.sigma / degree, 90, 3), next->head.pan, next->head.tilt,
          next->stage.offset.x(), next->stage.offset.y(), next->stage.offset.z());
    loop_.decide(i, "orientation and positioning", off, loop_.config().accepted, "px", what);
    return std::nullopt;
  }

  // Factor by which the focal length can grow while half of the markers of both arcs stay visible.
  [[nodiscard]] double longer(std::size_t i) const {
    constexpr double most = 2.5, less = 0.95, margin = 20;  // px
    const std::vector<KnownMarker>& markers = loop_.config().picture.markers;
    const std::size_t enough = std::max(seen_as_.fewest, markers.size() / 2);
    for (double times = most; times > 1; times *= less) {
      RigStance stance = loop_.stance(i);
      stance.head.zoom = zoom_by(loop_.camera(i), stance.head.zoom, times);
      const View view = view_of(model(), stance);
      if (std::ranges::all_of(plan_.arcs, [&](const ArmState& arc) {
            return markers_inside(
                       expected_markers(model().arm, model().bent(arc), markers, view, loop_.nominal().arm),
                       view, margin) >= enough;
          }))
        return times;
    }
    return 1;
  }

  // A longer focal length moves image points away from the principal point; this determines it.
  Error center() {
    std::array<RigStance, 2> wide = {loop_.stance(0), loop_.stance(1)};
    std::vector<std::size_t> looking;
    for (std::size_t i = 0; i < 2; ++i) {
      const RigStance next = loop_.zoomed(i, longer(i));
      const double times = loop_.camera(i).lens().at(next.head.zoom).fx / loop_.lens(i).fx;
      if (times < LookLoop::least_longer) {
        loop_.result().notes.push_back(fmt::format(
            "{}: the principal point is assumed to be known within 1 px. It cannot be measured, because the "
            "arm leaves the picture beyond {:.2f} times the focal length: expected {}",
            loop_.name(i), std::max(1.0, times), LookLoop::least_longer));
        continue;
      }
      looking.push_back(i), is_centered_[i] = true;
      if (auto error = loop_.go_longer(i, next)) return error;
    }
    if (looking.empty()) return std::nullopt;
    if (auto error = look_at({0, 1}, looking)) return error;
    for (const std::size_t i : looking)
      if (auto error = loop_.go(i, wide[i])) return error;
    return std::nullopt;
  }

  RigPrior prior_;
  RigSessionConfig seen_as_;
  std::unique_ptr<RigObserver> observer_;             // Holds all pictures.
  std::optional<RigReading> reading_;                 // Estimate from all pictures.
  std::array<bool, 2> is_centered_ = {false, false};  // By a longer focal length.
  Angle angle_;
  std::optional<Angle> predicted_;  // Predicted axis angle, before the last pictures were taken.
  std::array<RigStance, 2> desired_;
  std::array<bool, 2> is_short_{};  // Whether a head or stage ended short of its commanded position.
  std::array<double, 2> last_{};    // Previous deviations, px.
};

}  // namespace

std::unique_ptr<ArcsLoop> arcs_corrected(LookLoop& loop) { return std::make_unique<ArcsCorrected>(loop); }

}  // namespace flexura
