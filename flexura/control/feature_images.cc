#include "flexura/control/feature_images.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// Returns each share once, except for the polygon's corners, which are consecutive at the end.
std::vector<double> places_of(const FeatureSet& set) {
  std::vector<double> shares;
  const auto add = [&shares](double share) {
    if (std::ranges::find(shares, share) == shares.end()) shares.push_back(share);
  };
  for (const double share : set.points) add(share);
  for (const auto& [from, to] : set.chords) add(from), add(to);
  if (!set.has_moments) return shares;
  if (set.moment_points < 2) throw std::invalid_argument("moments need at least two points of the arm");
  for (int i = 0; i < set.moment_points; ++i)
    shares.push_back(static_cast<double>(i) / (set.moment_points - 1));
  return shares;
}

Eigen::Index place_of(const std::vector<double>& shares, double share) {
  return std::ranges::find(shares, share) - shares.begin();
}

}  // namespace

FeatureImages::FeatureImages(const Arm& arm, FeatureSet set)
    : set_(std::move(set)), points_(arm, places_of(set_)) {
  const std::vector<double> shares = places_of(set_);
  if (shares.empty()) throw std::invalid_argument("features need points and cameras");
  for (const double share : set_.points) at_.push_back(place_of(shares, share));
  for (const auto& [from, to] : set_.chords) ends_.push_back({place_of(shares, from), place_of(shares, to)});
  first_corner_ = static_cast<Eigen::Index>(shares.size()) - (set_.has_moments ? set_.moment_points : 0);
}

bool FeatureImages::write_values(Eigen::Ref<Eigen::VectorXd> values) {
  Eigen::Index row = 0;
  for (const Eigen::Index i : at_) values.segment<2>(row) = pixels_.col(i), row += 2;
  try {
    for (const auto& [from, to] : ends_)
      values[row++] = set_.angle_weight * chord_angle(pixels_.col(from), pixels_.col(to)).value;
    if (!set_.has_moments) return true;
    curve_moments(pixels_.middleCols(first_corner_, set_.moment_points), moments_);
  } catch (const std::domain_error&) {
    return false;
  }
  values.tail<moment_count>() = moments_.values;
  values.tail<moment_count - 3>() /= set_.moment_weight;
  return true;
}

void FeatureImages::write_rows(const Eigen::MatrixXd& by, Rows rows) const {
  Eigen::Index row = 0;
  for (Eigen::Index column = 0; column < by.cols(); ++column) {
    row = 0;
    for (const Eigen::Index i : at_) rows.block<2, 1>(row, column) = by.block<2, 1>(2 * i, column), row += 2;
  }
  for (const auto& [from, to] : ends_) {
    const Eigen::RowVector4d across =
        set_.angle_weight * chord_angle(pixels_.col(from), pixels_.col(to)).by_pixels;
    for (Eigen::Index column = 0; column < by.cols(); ++column)
      rows(row, column) = across.head<2>().dot(by.block<2, 1>(2 * from, column)) +
                          across.tail<2>().dot(by.block<2, 1>(2 * to, column));
    ++row;
  }
  if (!set_.has_moments) return;
  for (Eigen::Index i = 0; i < moment_count; ++i, ++row)
    rows.row(row).noalias() = (i < 3 ? 1 : 1 / set_.moment_weight) *
                              (moments_.by_pixels.row(i) * by.bottomRows(2 * set_.moment_points));
}

bool FeatureImages::values(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values) {
  if (views.empty()) throw std::invalid_argument("features need points and cameras");
  points_.set(state);
  const Eigen::Index rows = set_.rows();
  values.resize(rows * static_cast<Eigen::Index>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!points_.see(views[i], pixels_) ||
        !write_values(values.segment(static_cast<Eigen::Index>(i) * rows, rows)))
      return false;
  return true;
}

bool FeatureImages::derive(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values,
                           Eigen::MatrixXd& by_state) {
  if (views.empty()) throw std::invalid_argument("features need points and cameras");
  points_.set(state);
  const Eigen::Index rows = set_.rows(), all = rows * static_cast<Eigen::Index>(views.size());
  values.resize(all);
  by_state.resize(all, points_.columns());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * rows;
    // If only points count, each once, their rows are those of the features.
    const bool is_plain = 2 * points_.count() == rows && ends_.empty() && !set_.has_moments;
    if (!is_plain) by_.resize(2 * points_.count(), points_.columns());
    const Rows seen = is_plain ? Rows(by_state.middleRows(first, rows)) : Rows(by_);
    if (!points_.see(views[i], pixels_, seen) || !write_values(values.segment(first, rows))) return false;
    if (!is_plain) write_rows(by_, by_state.middleRows(first, rows));
  }
  return true;
}

}  // namespace flexura
