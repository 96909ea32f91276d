#include "flexura/servo/servo_eyes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "flexura/calibrate/eight_bits.h"
#include "flexura/estimate/picture_sighting.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

ShapePrior prior_of(const Arm& arm, std::vector<double> markers) {
  ShapePrior prior;
  prior.arm = arm;
  prior.markers = std::move(markers);
  return prior;
}

// Cameras that are a degree wrong show the arm by many pixels elsewhere than it would be seen: where nothing
// of it is put down to them the nearest shape is still the one to go by.
EstimatorConfig patient_estimator(const ViewDoubt& doubt) {
  EstimatorConfig config;
  config.most_rms = doubt.is_any() ? 5 : 20;
  return config;
}

// Of the way from `a` to `b`, the share where it meets the line through `at` across `heading`; none beside
// it.
std::optional<double> meeting(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& at,
                              const Eigen::Vector2d& heading) {
  const double from = heading.dot(a - at), to = heading.dot(b - at);
  if ((from < 0) == (to < 0)) return std::nullopt;
  return from / (from - to);
}

}  // namespace

ServoEyes::ServoEyes(const RigModel& believed, const std::array<std::size_t, 2>& cameras,
                     std::vector<double> markers, const ViewDoubt& doubt)
    : arm_(believed.arm),
      has_markers_(!markers.empty()),
      doubt_(doubt),
      prior_(prior_of(believed.arm, std::move(markers))),
      tracker_(prior_, patient_estimator(doubt)) {
  for (std::size_t i = 0; i < 2; ++i)
    whites_[i] = (1 << believed.cameras.at(cameras[i]).config.sensor.bits) - 1;
}

Sighting ServoEyes::sighting(std::size_t i, const Picture& picture, const View& view, std::string& reason) {
  constexpr double moved = 2;  // px; then the finder is told anew where the base is.
  const Eigen::Vector2d base =
      view.project(arm_.X_WB.position).value_or(Eigen::Vector2d(0.5 * view.width, view.height));
  if (!finders_[i] || (finders_[i]->base - base).norm() > moved) {
    ArmFinderConfig config;
    config.base = base;
    finders_[i].emplace(Finder{base, ArmFinder(config)});
  }
  const auto find = [&]<typename Value>(const Image<Value>& image) -> const ArmSighting& {
    ArmFinder& finder = finders_[i]->finder;
    if constexpr (sizeof(Value) == 1) {
      return image.channels() == 1 ? finder.find(image) : finder.find(gray_picture(image));
    } else {
      return image.channels() == 1 ? finder.find(image, whites_[i])
                                   : finder.find(gray_picture(image), whites_[i]);
    }
  };
  const ArmSighting& found = std::visit(find, picture);
  reason = found.reason;
  const bool has_bands = has_markers_ && found.is_found();
  Sighting seen =
      has_bands ? sighting_of(found, view, eight_bits(picture, whites_[i])) : sighting_of(found, view);
  seen.doubt = doubt_;
  return seen;
}

ServoSight ServoEyes::look(const std::array<Frame, 2>& frames, const std::array<View, 2>& views,
                           const std::optional<ArmState>& guess) {
  ServoSight sight;
  sight.frames = frames;
  sight.time = 0.5 * (frames[0].time + frames[1].time);
  for (std::size_t i = 0; i < 2; ++i)
    sight.seen[i] = sighting(i, *frames[i].picture, views[i], sight.reasons[i]);
  if (!are_enough(sight.seen)) {
    for (std::size_t i = 0; i < 2; ++i)
      if (sight.reasons[i].empty() && !are_enough({&sight.seen[i], 1}))
        sight.reasons[i] = "too little of the arm is seen";
    sight.estimate.reason = "the arm is not seen in every image";
    return sight;
  }
  sight.estimate = tracker_.look(sight.seen, sight.time, guess);
  if (!sight.estimate.is_found) return sight;
  const std::vector<ViewError>& errors = sight.estimate.shape.views;
  for (std::size_t i = 0; i < errors.size(); ++i)
    sight.seen[i].view = corrected(sight.seen[i].view, errors[i]);
  return sight;
}

ShapeEstimate ServoEyes::as_believed(const ServoSight& sight, const std::array<View, 2>& views) const {
  std::array<Sighting, 2> seen = sight.seen;
  for (std::size_t i = 0; i < 2; ++i) seen[i].view = views[i], seen[i].doubt = {};
  return ShapeEstimator(prior_, patient_estimator({})).estimate(seen);
}

namespace {

// Where a place of the shape is seen, and how far across the curve the measured axis lies there.
struct Place {
  Eigen::Vector2d pixel = {0, 0}, across = {0, 0};
  std::optional<double> offset;  // px; none where no axis was measured.
};

// Of what is farther from the shape's image than that, px, nothing is the arm there: where a view is without
// its errors that is less.
double farthest_in(const Sighting& seen) { return seen.doubt.is_any() ? 3 : 20; }

// A median axis in short stretches, so that a place looks at those near it only.
class AxisStretches {
 public:
  AxisStretches(const std::vector<CurvePoint>& points, double farthest)
      : points_(points), farthest_(farthest) {
    for (std::size_t first = 0; first + 1 < points.size(); first += length) {
      Eigen::AlignedBox2d& box = boxes_.emplace_back();
      for (std::size_t i = first; i <= std::min(first + length, points.size() - 1); ++i)
        box.extend(points[i].pixel);
    }
  }

  // How far across the place the axis passes it; none where it does not.
  [[nodiscard]] std::optional<double> offset(const Place& place) const {
    const Eigen::Vector2d heading(place.across.y(), -place.across.x());
    std::optional<double> nearest;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
      if (boxes_[k].squaredExteriorDistance(place.pixel) > farthest_ * farthest_) continue;
      for (std::size_t i = k * length + 1; i <= std::min((k + 1) * length, points_.size() - 1); ++i) {
        const Eigen::Vector2d &a = points_[i - 1].pixel, &b = points_[i].pixel;
        const auto share = meeting(a, b, place.pixel, heading);
        if (!share || (b - a).norm() > longest) continue;
        const double offset = place.across.dot(a + *share * (b - a) - place.pixel);
        if (std::abs(offset) < std::abs(nearest.value_or(farthest_))) nearest = offset;
      }
    }
    return nearest;
  }

 private:
  static constexpr std::size_t length = 16;
  static constexpr double longest = 20;  // px; what is farther apart is no piece of an axis.
  const std::vector<CurvePoint>& points_;
  double farthest_;
  std::vector<Eigen::AlignedBox2d> boxes_;  // Of each stretch's points and the next one's first.
};

// What is not measured, at the ends and behind something, is off by as much as the nearest that is, if
// cameras are wrong.
double offset_near(const std::vector<Place>& places, const std::vector<double>& shares, std::size_t k) {
  double offset = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = std::abs(shares[i] - shares[k]);
    if (places[i].offset && distance < nearest) nearest = distance, offset = *places[i].offset;
  }
  return offset;
}

}  // namespace

std::optional<Eigen::Matrix2Xd> measured_pixels(const Arm& arm, const ArmState& estimate,
                                                const Sighting& seen, const std::vector<double>& shares) {
  const Backbone backbone(arm, estimate);
  std::vector<Place> places(shares.size());
  const AxisStretches axis(seen.points, farthest_in(seen));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double s = std::min(arc_length_of(arm, estimate, material_point(arm, shares[k] * arm.length())),
                              backbone.length());
    const Pose X_WS = backbone.pose(s);
    const double ahead = 1e-4 * backbone.length();
    const auto at = seen.view.project(X_WS.position),
               next = seen.view.project(X_WS.position + ahead * X_WS.rotation.col(2));
    if (!at || !next) return std::nullopt;
    places[k].pixel = *at;
    const Eigen::Vector2d way = *next - *at;
    if (!(way.norm() > 0)) continue;
    places[k].across = Eigen::Vector2d(-way.y(), way.x()) / way.norm();
    places[k].offset = axis.offset(places[k]);
  }
  Eigen::Matrix2Xd pixels(2, static_cast<Eigen::Index>(shares.size()));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double unseen = seen.doubt.is_any() ? 0 : offset_near(places, shares, k);
    const double offset = places[k].offset.value_or(unseen);
    pixels.col(static_cast<Eigen::Index>(k)) = places[k].pixel + offset * places[k].across;
  }
  return pixels;
}

}  // namespace flexura
