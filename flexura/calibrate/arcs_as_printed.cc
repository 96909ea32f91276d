#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/calibrate/arcs_loop.h"
#include "flexura/vision/conic.h"

namespace flexura {
namespace {

class ArcsAsPrinted : public ArcsLoop {
 public:
  explicit ArcsAsPrinted(LookLoop& loop) : ArcsLoop(loop) {
    ArmPictureConfig picture = loop.config().picture;
    for (std::size_t i = 0; i < 2; ++i) {
      picture.white = loop.model(i).sensor.white();
      finders_.emplace_back(picture, loop.config().cameras[i]);
    }
  }

 private:
  Error align() override {
    for (std::size_t i = 0; i < 2; ++i)
      if (auto error = settle({i})) return error;
    return std::nullopt;
  }

  // Steps 3 to 5: takes a picture, extracts the centerline, fits a circle to it.
  Error look(std::size_t i) override {
    auto error = loop_.look(i, [&](CameraObservation& observed) {
      observed.seen = finders_[i].see(*observed.frame.picture, Lens(loop_.lens(i)),
                                      expected_markers(loop_.nominal().arm, plan_.arcs[i],
                                                       loop_.config().picture.markers, plan_.ideal[i]));
      // Missing markers are no error: they are not needed.
      if (!observed.seen.points.empty()) observed.seen.reason.clear();
      points_.clear();
      for (const CurvePoint& point : observed.seen.points) points_.push_back(point.pixel);
      observed.circle = circle_ = fit_circle(points_);
      if (!circle_) return;
      observed.values = {{"radius, px", circle_->radius},
                         {"rms, px", circle_->rms},
                         {"verified", circle_->is_verified ? 1.0 : 0.0},
                         {"detectable tilt, deg", circle_->detectable_tilt / degree}};
    });
    if (error || circle_) return error;
    const std::string& reason = loop_.observed().seen.reason;
    return fmt::format("the arm is out of view of camera {}: {}", loop_.name(i),
                       reason.empty() ? "no arc is seen" : reason);
  }

  Error decide(std::size_t i, std::optional<RigStance>& next) override {
    const Intrinsics ideal = plan_.ideal[i].lens.intrinsics(), lens = loop_.lens(i);
    const auto desired = plan_.ideal[i].project(plan_.centers[i]);
    const Eigen::Vector2d off =
        circle_->center - Eigen::Vector2d(lens.cx, lens.cy) -
        (desired.value_or(Eigen::Vector2d(ideal.cx, ideal.cy)) - Eigen::Vector2d(ideal.cx, ideal.cy));
    if (circle_->is_verified) {
      loop_.decide(
          i, "circle", circle_->rms, 0, "px",
          fmt::format("the circle's equation is verified; the test detects a tilt of at least {:.2f} deg",
                      circle_->detectable_tilt / degree));
      loop_.result().notes.push_back(fmt::format(
          "camera {}: the circle's equation is verified. This proves only a tilt below {:.2f} deg, and does "
          "not determine the camera's direction: the circle's centre is {:.1f} px from its ideal position",
          loop_.name(i), circle_->detectable_tilt / degree, off.norm()));
      return std::nullopt;
    }
    next = loop_.stance(i);
    return off.norm() > loop_.config().accepted ? centre(i, off, *next) : go_around(i, *next);
  }

  // Centres the circle with the head, one of the two kinds of motion that make the image a circle.
  Error centre(std::size_t i, const Eigen::Vector2d& off, RigStance& next) {
    next.head = turned_towards(next.head, loop_.lens(i), off);
    next = loop_.commandable_stance(i, next);
    loop_.decide(i, "centre", off.norm(), loop_.config().accepted, "px",
                 "turn the camera until the circle's centre is at its position in the ideal picture");
    if (!loop_.stands_there(i, next)) return std::nullopt;
    return fmt::format("the head of camera {} is at its limit, {:.1f} px from the circle's centre",
                       loop_.name(i), off.norm());
  }

  // Moves the stage around the centre by the angle from the axis ratio, which does not give the side.
  Error go_around(std::size_t i, RigStance& next) {
    Orbit& orbit = orbits_[i];
    const auto ellipse = fit_ellipse(points_);
    if (!ellipse)
      return fmt::format("the curve in camera {}'s picture is neither a circle's arc nor an ellipse's",
                         loop_.name(i));
    const double ratio = ellipse->semi_axes.y() / ellipse->semi_axes.x();
    if (ratio < orbit.last_ratio) orbit.side = -orbit.side, orbit.share = std::max(0.125, 0.7 * orbit.share);
    orbit.last_ratio = ratio;
    constexpr double steepest = 0.35;  // rad
    const double tilt = orbit.share * std::min(steepest, std::acos(std::clamp(ratio, 0.0, 1.0)));
    const double distance = loop_.lens(i).fx * plan_.radius / ellipse->semi_axes.x();
    // Along the shorter axis. Its sign is arbitrary, so it is matched to that of the previous time.
    Eigen::Vector3d way(-std::sin(ellipse->angle), std::cos(ellipse->angle), 0);
    if (way.dot(orbit.way) < 0) way = -way;
    orbit.way = way;
    const auto angles = Camera(loop_.model(i)).angles(next.head);
    const Eigen::Matrix3d R_MC = pan_rotation(angles[0]) * tilt_rotation(angles[1]);
    const Eigen::Vector3d slide = orbit.side * distance * std::tan(tilt) * (R_MC * way);
    next.stage.offset += Eigen::Vector3d(slide.x(), slide.y(), 0);
    // The camera keeps looking at the centre: a shift to the right needs a turn to the left.
    next.head.pan += slide.x() / distance, next.head.tilt += slide.y() / distance;
    next = loop_.commandable_stance(i, next);
    loop_.decide(i, "ratio of axes", 1 - ratio, 0, "share",
                 fmt::format("move the camera around the centre by {:.3f} deg", orbit.side * tilt / degree));
    if (!loop_.stands_there(i, next)) return std::nullopt;
    return fmt::format(
        "the circle's equation is not verified by camera {}, and the stage is at its limit: the ratio of the "
        "axes is {:.4f}",
        loop_.name(i), ratio);
  }

  struct Orbit {
    double side = 1, share = 1, last_ratio = -1;
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
  };
  std::array<Orbit, 2> orbits_;
  std::vector<ArmPicture> finders_;
  std::vector<Eigen::Vector2d> points_;
  std::optional<CircleFit> circle_;
};

}  // namespace

std::unique_ptr<ArcsLoop> arcs_as_printed(LookLoop& loop) { return std::make_unique<ArcsAsPrinted>(loop); }

}  // namespace flexura
