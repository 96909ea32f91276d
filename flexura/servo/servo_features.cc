#include "flexura/servo/servo_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "flexura/control/feature_images.h"
#include "flexura/control/point_images.h"
#include "flexura/control/shape_features.h"
#include "flexura/servo/flow_features.h"
#include "flexura/servo/length_features.h"
#include "flexura/servo/measured_places.h"

namespace flexura {
namespace {

// Collects bend_x, bend_y and stretch of every section.
void all_of(const ArmState& state, Eigen::VectorXd& values) {
  values.resize(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    values.segment<2>(at) = state.bends[i], values[at + 2] = state.stretches[i];
  }
}

// The estimated shape itself.
class EstimatedShape : public ServoFeatures {
 public:
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>&,
                              Eigen::VectorXd& values) override {
    return all_of(estimate, values), true;
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>&,
                             Eigen::VectorXd& values) override {
    return all_of(state, values), true;
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired, const ArmState&,
                           const std::array<View, 2>&, FeatureError& result) override {
    result.error = seen - desired;
    result.by_state.setIdentity(seen.size(), seen.size());
    return true;
  }
};

// Points, chords or moments of both images.
class ImageFeatures : public ServoFeatures {
 public:
  ImageFeatures(Arm arm, FeatureSet set)
      : arm_(std::move(arm)), set_(std::move(set)), shares_(needed_shares(set_)), images_(arm_, set_) {}

  [[nodiscard]] const FeatureSet& set() const { return set_; }

  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    values.resize(2 * set_.rows());
    for (std::size_t i = 0; i < 2; ++i) {
      const auto pixels = measured_pixels(arm_, estimate, seen[i], shares_);
      const auto one = pixels ? feature_values(set_, *pixels) : std::nullopt;
      if (!one) return false;
      values.segment(static_cast<Eigen::Index>(i) * set_.rows(), set_.rows()) = *one;
    }
    return true;
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return images_.values(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    feature_error(set_, seen, desired, result.error);
    return images_.derive(estimate, views, values_, result.by_state);
  }
  // If the arm half-way is outside the lens's view, uses the derivatives at the current shape.
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                            const ShapeError& way, const std::array<View, 2>& views,
                            FeatureError& result) override {
    return error(seen, desired, way.halfway, views, result) || error(seen, desired, way.seen, views, result);
  }

 private:
  Arm arm_;
  FeatureSet set_;
  std::vector<double> shares_;
  FeatureImages images_;
  Eigen::VectorXd values_;
};

// Chords of both images, between consecutive places.
class ChordAngles : public ChordFeatures {
 public:
  ChordAngles(const Arm& arm, int points)
      : shares_(equal_shares(points)), inner_(arm, FeatureSet::of_chords(points)), ends_(arm, shares_) {}

  [[nodiscard]] const std::vector<double>& shares() const override { return shares_; }
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    return inner_.measured(estimate, seen, values);
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return inner_.predict(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    return inner_.error(seen, desired, estimate, views, result);
  }
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                            const ShapeError& way, const std::array<View, 2>& views,
                            FeatureError& result) override {
    if (!inner_.error(seen, desired, way.seen, views, result)) return false;
    for (std::size_t i = 0; i < 2; ++i) {
      by_[i].resize(2 * ends_.count(), ends_.columns());
      const bool are_shown = see(way.seen, views[i], here_[i]) && see(way.desired, views[i], there_[i]);
      ends_.set(way.halfway);
      if (!are_shown || !ends_.see(views[i], halfway_, by_[i])) return true;
    }
    const auto chords = static_cast<Eigen::Index>(shares_.size()) - 1;
    for (std::size_t i = 0; i < 2; ++i)
      for (Eigen::Index k = 0; k < chords; ++k) turn(i, k, static_cast<Eigen::Index>(i) * chords + k, result);
    return true;
  }
  [[nodiscard]] bool of_pixels(const std::array<Eigen::Matrix2Xd, 2>& pixels, const ArmState&,
                               const std::array<View, 2>&, Eigen::VectorXd& values) override {
    const Eigen::Index chords = pixels[0].cols() - 1;
    values.resize(2 * chords);
    Eigen::Matrix2Xd ends(2, 2 * chords);
    for (std::size_t i = 0; i < 2; ++i) {
      for (Eigen::Index k = 0; k < chords; ++k) ends.middleCols<2>(2 * k) = pixels[i].middleCols<2>(k);
      const auto one = feature_values(inner_.set(), ends);
      if (!one) return false;
      values.segment(static_cast<Eigen::Index>(i) * chords, chords) = *one;
    }
    return true;
  }

 private:
  [[nodiscard]] bool see(const ArmState& state, const View& view, Eigen::Matrix2Xd& pixels) {
    ends_.set(state);
    return ends_.see(view, pixels);
  }
  // Derivative of a chord's image angle. The image of chord k turns by a, from its target direction d to c,
  // with |c| |d| sin a = (c + d)/2 x (c - d). c - d is by_ times the way. The precision of the angle grows
  // with the chord's length in the picture. So it is weighted by the shorter of both images: the error is in
  // px at the chord's end.
  void turn(std::size_t camera, Eigen::Index k, Eigen::Index row, FeatureError& result) const {
    const Eigen::MatrixXd& by = by_[camera];
    const Eigen::Vector2d c = here_[camera].col(k + 1) - here_[camera].col(k),
                          d = there_[camera].col(k + 1) - there_[camera].col(k), mean = 0.5 * (c + d);
    const double lengths = c.norm() * d.norm(), shorter = std::min(c.norm(), d.norm());
    const double sine = d.x() * c.y() - d.y() * c.x(), angle = std::atan2(sine, c.dot(d));
    // The middle of opposite chords is undefined: from 150 degrees on, their weight decreases.
    constexpr double most = 5.3;
    const double ratio = sine == 0 && c.dot(d) > 0 ? 1 : angle * lengths / sine;
    const double share = shorter * std::min(most, ratio) / lengths, trust = std::min(1.0, most / ratio);
    for (Eigen::Index column = 0; column < by.cols(); ++column)
      result.by_state(row, column) = share * (mean.x() * (by(2 * k + 3, column) - by(2 * k + 1, column)) -
                                              mean.y() * (by(2 * k + 2, column) - by(2 * k, column)));
    result.error[row] *= trust * shorter / inner_.set().angle_weight;
  }

  std::vector<double> shares_;
  ImageFeatures inner_;
  PointImages ends_;
  std::array<Eigen::Matrix2Xd, 2> here_, there_;  // Pixels of the chords' ends in each camera.
  Eigen::Matrix2Xd halfway_;
  std::array<Eigen::MatrixXd, 2> by_;  // Derivatives by the state half-way.
};

}  // namespace

std::vector<double> equal_shares(int count) {
  std::vector<double> shares;
  for (int k = 0; k <= count; ++k) shares.push_back(static_cast<double>(k) / count);
  return shares;
}

std::unique_ptr<ChordFeatures> chord_features(const Arm& arm, int points) {
  return std::make_unique<ChordAngles>(arm, points);
}

std::unique_ptr<ServoFeatures> servo_features(const ServoConfig& config, const RigModel& nominal) {
  if (config.measure == ServoMeasure::picture) return servo_features(config.law, nominal.arm, config.points);
  const int points = static_cast<int>(config.points);
  auto chords = config.law == ServoLawKind::chords ? chord_features(nominal.arm, points)
                                                   : plane_features(nominal.arm, points);
  std::array<int, 2> whites{};
  for (std::size_t i = 0; i < 2; ++i) whites[i] = nominal.cameras.at(config.cameras[i]).sensor.white();
  return with_lengths(std::make_unique<FlowFeatures>(nominal.arm, std::move(chords), config.anchor, whites),
                      nominal.arm, config.law == ServoLawKind::chords ? stretch_px : stretch_rad);
}

std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm, std::int64_t places) {
  const int points = static_cast<int>(places);
  switch (law) {
    case ServoLawKind::shape:
    case ServoLawKind::predictive:
    case ServoLawKind::computed_torque:
    case ServoLawKind::shape_potential:
      return std::make_unique<EstimatedShape>();
    case ServoLawKind::points:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_points(points));
    case ServoLawKind::chords:
      return with_lengths(chord_features(arm, points), arm, stretch_px);
    case ServoLawKind::moments:
      return with_lengths(std::make_unique<ImageFeatures>(arm, FeatureSet::of_moments()), arm, stretch_px);
    case ServoLawKind::potential:
      return with_lengths(plane_features(arm, points), arm, stretch_rad);
    case ServoLawKind::silhouettes:
      break;
  }
  return with_lengths(silhouette_features(arm, points), arm, stretch_px);
}

}  // namespace flexura
