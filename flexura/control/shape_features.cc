#include "flexura/control/shape_features.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

#include "flexura/control/interaction.h"

namespace flexura {

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
    if (!is_on_the_arm) throw std::invalid_argument("a feature's share of the arm must be in [0, 1]");
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

Eigen::VectorXd feature_error(const FeatureSet& set, const Eigen::VectorXd& seen,
                              const Eigen::VectorXd& desired) {
  Eigen::VectorXd error;
  feature_error(set, seen, desired, error);
  return error;
}

void feature_error(const FeatureSet& set, const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                   Eigen::VectorXd& error) {
  const Eigen::Index rows = set.rows();
  if (seen.size() != desired.size() || rows == 0 || seen.size() % rows != 0)
    throw std::invalid_argument("features of different sets cannot be compared");
  error = seen - desired;
  const auto first = static_cast<Eigen::Index>(2 * set.points.size()),
             angles = static_cast<Eigen::Index>(set.chords.size());
  const double turn = 2 * std::numbers::pi * set.angle_weight;
  for (Eigen::Index camera = 0; camera < seen.size() / rows; ++camera)
    for (double& difference : error.segment(camera * rows + first, angles))
      difference -= turn * std::round(difference / turn);
}

}  // namespace flexura
