#include "flexura/servo/feature_marks.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "flexura/control/shape_features.h"
#include "flexura/math/dense.h"
#include "flexura/servo/measured_places.h"

namespace flexura {
namespace {

// Returns points of the ellipse with these moments: in every direction, its distance from the middle is the
// standard deviation.
std::vector<Eigen::Vector2d> ellipse_of(const Eigen::Ref<const Eigen::VectorXd>& moments) {
  constexpr int corners = 32;
  const double weight = FeatureSet::of_moments().moment_weight;
  Eigen::Matrix2d second;
  second << moments[3], moments[4], moments[4], moments[5];
  const SymmetricEigen axes = symmetric_eigen(weight * second);
  const Eigen::Vector2d sigma = axes.values.cwiseMax(0).cwiseSqrt();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= corners; ++i) {
    const double t = 2 * std::numbers::pi * i / corners;
    points.emplace_back(moments.segment<2>(1) +
                        axes.vectors * sigma.cwiseProduct(Eigen::Vector2d(std::cos(t), std::sin(t))));
  }
  return points;
}

// Returns the direction in a picture that the law `potential` reads as the angle `alpha` in its plane: XOY
// for the first camera, ZOY for the second.
Eigen::Vector2d way_in_plane(const View& view, std::size_t camera, double alpha) {
  const Eigen::Vector3d way = camera == 0 ? Eigen::Vector3d(std::sin(alpha), std::cos(alpha), 0)
                                          : Eigen::Vector3d(0, std::cos(alpha), std::sin(alpha));
  const Eigen::Vector3d seen = view.X_WC.rotation.transpose() * way;
  return {view.lens.intrinsics().fx * seen.x(), view.lens.intrinsics().fy * seen.y()};
}

}  // namespace

FeatureMarker::FeatureMarker(ServoLawKind law, Arm arm, std::int64_t points)
    : law_(law),
      arm_(std::move(arm)),
      points_(points),
      corners_(equal_shares(static_cast<int>(points))),
      features_(servo_features(law, arm_, points)) {}

std::array<std::vector<FeatureMark>, 2> FeatureMarker::of(const ServoObservation& observed) {
  std::array<std::vector<FeatureMark>, 2> marks;
  if (law_ == ServoLawKind::shape || predicts_motion(law_) || !observed.estimate.is_found) return marks;
  const std::array<View, 2> views = {observed.seen[0].view, observed.seen[1].view};
  if (!features_->measured(observed.estimate.shape.state, observed.seen, seen_) ||
      !features_->predict(observed.desired, views, desired_))
    return marks;
  if (observed.desired_offset.size() == desired_.size()) desired_ += observed.desired_offset;
  for (std::size_t i = 0; i < 2; ++i) {
    switch (law_) {
      case ServoLawKind::shape:
      case ServoLawKind::predictive:
      case ServoLawKind::computed_torque:
      case ServoLawKind::shape_potential:
        break;
      case ServoLawKind::points:
        marks[i] = points_in(i);
        break;
      case ServoLawKind::moments:
        marks[i] = moments_in(i);
        break;
      case ServoLawKind::silhouettes:
        marks[i] = edges_in(i);
        break;
      case ServoLawKind::chords:
      case ServoLawKind::potential:
        marks[i] = chords_in(i, observed);
        break;
    }
  }
  return marks;
}

std::vector<FeatureMark> FeatureMarker::points_in(std::size_t camera) const {
  std::vector<FeatureMark> marks;
  marks.reserve(static_cast<std::size_t>(points_));
  const Eigen::Index first = 2 * points_ * static_cast<Eigen::Index>(camera);
  for (Eigen::Index k = 0; k < points_; ++k)
    marks.push_back({{seen_.segment<2>(first + 2 * k)}, {desired_.segment<2>(first + 2 * k)}});
  return marks;
}

// Per camera: the pixels right and left of each place, then as many normals.
std::vector<FeatureMark> FeatureMarker::edges_in(std::size_t camera) const {
  std::vector<FeatureMark> marks;
  const Eigen::Index count = 2 * points_, first = 4 * count * static_cast<Eigen::Index>(camera);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Vector2d seen = seen_.segment<2>(first + 2 * k),
                          desired = desired_.segment<2>(first + 2 * k);
    if (seen.allFinite() && desired.allFinite()) marks.push_back({{seen}, {desired}});
  }
  return marks;
}

std::vector<FeatureMark> FeatureMarker::moments_in(std::size_t camera) const {
  const auto first = moment_count * static_cast<Eigen::Index>(camera);
  return {
      {{seen_.segment<2>(first + 1)}, {desired_.segment<2>(first + 1)}},
      {ellipse_of(seen_.segment<moment_count>(first)), ellipse_of(desired_.segment<moment_count>(first))}};
}

std::vector<FeatureMark> FeatureMarker::chords_in(std::size_t camera,
                                                  const ServoObservation& observed) const {
  std::vector<FeatureMark> marks;
  const auto pixels = measured_pixels(arm_, observed.estimate.shape.state, observed.seen[camera], corners_);
  if (!pixels) return marks;
  const double weight = FeatureSet{}.angle_weight;
  for (Eigen::Index k = 0; k < points_; ++k) {
    const double angle = desired_[points_ * static_cast<Eigen::Index>(camera) + k];
    const Eigen::Vector2d way = law_ == ServoLawKind::chords
                                    ? Eigen::Vector2d(std::cos(angle / weight), std::sin(angle / weight))
                                    : way_in_plane(observed.seen[camera].view, camera, angle);
    const Eigen::Vector2d from = pixels->col(k), to = pixels->col(k + 1), middle = 0.5 * (from + to),
                          half = 0.5 * (to - from).norm() * way.normalized();
    if (half.allFinite()) marks.push_back({{from, to}, {middle - half, middle + half}});
  }
  return marks;
}

}  // namespace flexura
