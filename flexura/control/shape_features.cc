#include "flexura/control/shape_features.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

#include "flexura/control/interaction.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"

namespace flexura {
namespace {

constexpr Eigen::Index moment_count = 6;

// Pixels of the needed points in one camera, and their derivatives: two rows a point.
struct SeenPixels {
  Eigen::Matrix2Xd pixels;
  Eigen::MatrixXd by_state, by_camera;
};

// One camera's rows of the features.
class CameraRows {
 public:
  CameraRows(const SeenPixels& seen, ShapeFeatures& features, Eigen::Index row, Eigen::Index camera)
      : seen_(seen), features_(features), row_(row), camera_(camera) {}

  // The feature `value` px of the pixels from `first` on.
  void add(double value, const Eigen::Ref<const Eigen::RowVectorXd>& by_pixels, Eigen::Index first) {
    features_.values[row_] = value;
    features_.by_state.row(row_).noalias() =
        by_pixels * seen_.by_state.middleRows(2 * first, by_pixels.size());
    features_.by_cameras.row(row_).segment<6>(6 * camera_).noalias() =
        by_pixels * seen_.by_camera.middleRows(2 * first, by_pixels.size());
    ++row_;
  }

 private:
  const SeenPixels& seen_;
  ShapeFeatures& features_;
  Eigen::Index row_, camera_;
};

void add_features(const FeatureSet& set, const SeenPixels& seen, ShapeFeatures& features, Eigen::Index row,
                  Eigen::Index camera) {
  CameraRows rows(seen, features, row, camera);
  const auto points = static_cast<Eigen::Index>(set.points.size());
  for (Eigen::Index i = 0; i < points; ++i) {
    rows.add(seen.pixels(0, i), Eigen::RowVector2d(1, 0), i);
    rows.add(seen.pixels(1, i), Eigen::RowVector2d(0, 1), i);
  }
  const auto chords = static_cast<Eigen::Index>(set.chords.size());
  for (Eigen::Index i = points; i < points + 2 * chords; i += 2) {
    const PixelFeature angle = chord_angle(seen.pixels.col(i), seen.pixels.col(i + 1));
    rows.add(set.angle_weight * angle.value, set.angle_weight * angle.by_pixels, i);
  }
  if (!set.has_moments) return;
  const Eigen::Index first = points + 2 * chords;
  const CurveMoments moments = curve_moments(seen.pixels.middleCols(first, set.moment_points));
  for (Eigen::Index i = 0; i < moment_count; ++i) {
    const double weight = i < 3 ? 1 : 1 / set.moment_weight;
    rows.add(weight * moments.values[i], weight * moments.by_pixels.row(i), first);
  }
}

}  // namespace

FeatureSet FeatureSet::of_points(int count) {
  FeatureSet set;
  for (int i = 1; i <= count; ++i) set.points.push_back(static_cast<double>(i) / count);
  return set;
}

FeatureSet FeatureSet::of_chords(int count) {
  FeatureSet set;
  for (int i = 0; i < count; ++i)
    set.chords.push_back({static_cast<double>(i) / count, static_cast<double>(i + 1) / count});
  return set;
}

FeatureSet FeatureSet::of_moments() {
  FeatureSet set;
  set.has_moments = true;
  return set;
}

Eigen::Index FeatureSet::rows() const {
  return static_cast<Eigen::Index>(2 * points.size() + chords.size()) + (has_moments ? moment_count : 0);
}

std::vector<double> needed_shares(const FeatureSet& set) {
  std::vector<double> shares = set.points;
  for (const auto& [from, to] : set.chords) shares.push_back(from), shares.push_back(to);
  if (set.has_moments)
    for (int i = 0; i < set.moment_points; ++i)
      shares.push_back(static_cast<double>(i) / (set.moment_points - 1));
  for (const double share : shares) {
    const bool is_on_the_arm = share >= 0 && share <= 1;
    if (!is_on_the_arm) throw std::invalid_argument("a feature's share of the arm is in [0, 1]");
  }
  return shares;
}

std::optional<Eigen::VectorXd> feature_values(const FeatureSet& set, const Eigen::Matrix2Xd& pixels) {
  const auto points = static_cast<Eigen::Index>(set.points.size()),
             chords = static_cast<Eigen::Index>(set.chords.size());
  const Eigen::Index corners = set.has_moments ? set.moment_points : 0;
  if (pixels.cols() != points + 2 * chords + corners)
    throw std::invalid_argument("features need a pixel for each share");
  Eigen::VectorXd values(set.rows());
  values.head(2 * points) = pixels.leftCols(points).reshaped();
  try {
    for (Eigen::Index i = 0; i < chords; ++i)
      values[2 * points + i] =
          set.angle_weight * chord_angle(pixels.col(points + 2 * i), pixels.col(points + 2 * i + 1)).value;
    if (!set.has_moments) return values;
    const CurveMoments moments = curve_moments(pixels.rightCols(corners));
    values.tail(moment_count) = moments.values;
    values.tail(moment_count - 3) /= set.moment_weight;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
  return values;
}

std::optional<ShapeFeatures> shape_features(const Arm& arm, const ArmState& state,
                                            std::span<const View> views, const FeatureSet& set) {
  const std::vector<double> shares = needed_shares(set);
  if (shares.empty() || views.empty()) throw std::invalid_argument("features need points and cameras");
  if (set.has_moments && set.moment_points < 2)
    throw std::invalid_argument("moments need two points of the arm or more");
  const BackboneJacobian backbone(arm, state);
  const auto count = static_cast<Eigen::Index>(shares.size()),
             columns = 3 * static_cast<Eigen::Index>(arm.sections.size()),
             cameras = static_cast<Eigen::Index>(views.size());
  Eigen::Matrix3Xd places(3, count);
  Eigen::MatrixXd place_by_state(3 * count, columns);
  Jacobian J(6, columns);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MaterialPoint point = material_point(arm, shares[static_cast<std::size_t>(i)] * arm.length());
    backbone.at(point, J);
    places.col(i) = backbone.pose(point).position;
    place_by_state.middleRows(3 * i, 3) = J.topRows<3>();
  }
  ShapeFeatures features;
  features.values.resize(cameras * set.rows());
  features.by_state.resize(cameras * set.rows(), columns);
  features.by_cameras = Eigen::MatrixXd::Zero(cameras * set.rows(), 6 * cameras);
  SeenPixels seen{Eigen::Matrix2Xd(2, count), Eigen::MatrixXd(2 * count, columns),
                  Eigen::MatrixXd(2 * count, 6)};
  for (Eigen::Index camera = 0; camera < cameras; ++camera) {
    const View& view = views[static_cast<std::size_t>(camera)];
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d p_CP = view.X_WC.inverse() * Eigen::Vector3d(places.col(i));
      const auto projection = view.lens.project_with_derivatives(p_CP);
      if (!projection) return std::nullopt;
      seen.pixels.col(i) = projection->pixel;
      const Eigen::Matrix<double, 2, 3> by_place = projection->by_point * view.X_WC.rotation.transpose();
      seen.by_state.middleRows(2 * i, 2).noalias() = by_place * place_by_state.middleRows(3 * i, 3);
      seen.by_camera.middleRows(2 * i, 2) = *point_interaction(view.lens, p_CP);
    }
    try {
      add_features(set, seen, features, camera * set.rows(), camera);
    } catch (const std::domain_error&) {
      return std::nullopt;
    }
  }
  return features;
}

Eigen::VectorXd feature_error(const FeatureSet& set, const Eigen::VectorXd& seen,
                              const Eigen::VectorXd& desired) {
  const Eigen::Index rows = set.rows();
  if (seen.size() != desired.size() || rows == 0 || seen.size() % rows != 0)
    throw std::invalid_argument("features of different sets have no difference");
  Eigen::VectorXd error = seen - desired;
  const auto first = static_cast<Eigen::Index>(2 * set.points.size()),
             angles = static_cast<Eigen::Index>(set.chords.size());
  const double turn = 2 * std::numbers::pi * set.angle_weight;
  for (Eigen::Index camera = 0; camera < seen.size() / rows; ++camera)
    for (double& difference : error.segment(camera * rows + first, angles))
      difference -= turn * std::round(difference / turn);
  return error;
}

}  // namespace flexura
