#include "flexura/servo/servo_features.h"

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "flexura/control/feature_images.h"
#include "flexura/control/shape_features.h"
#include "flexura/servo/flow_features.h"
#include "flexura/servo/measured_places.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

// Every section's bend_x, bend_y and stretch.
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
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Sighting, 2>&,
                              Eigen::VectorXd& values) override {
    return all_of(estimate, values), true;
  }
  [[nodiscard]] bool foreseen(const ArmState& state, const std::array<View, 2>&,
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

  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Sighting, 2>& seen,
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
  [[nodiscard]] bool foreseen(const ArmState& state, const std::array<View, 2>& views,
                              Eigen::VectorXd& values) override {
    return images_.values(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    feature_error(set_, seen, desired, result.error);
    return images_.derive(estimate, views, values_, result.by_state);
  }

 private:
  Arm arm_;
  FeatureSet set_;
  std::vector<double> shares_;
  FeatureImages images_;
  Eigen::VectorXd values_;
};

// The chords of both images, each between two places in a row.
class ChordAngles : public ChordFeatures {
 public:
  ChordAngles(const Arm& arm, int points) : inner_(arm, FeatureSet::of_chords(points)) {
    for (int k = 0; k <= points; ++k) shares_.push_back(static_cast<double>(k) / points);
  }

  [[nodiscard]] const std::vector<double>& shares() const override { return shares_; }
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Sighting, 2>& seen,
                              Eigen::VectorXd& values) override {
    return inner_.measured(estimate, seen, values);
  }
  [[nodiscard]] bool foreseen(const ArmState& state, const std::array<View, 2>& views,
                              Eigen::VectorXd& values) override {
    return inner_.foreseen(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    return inner_.error(seen, desired, estimate, views, result);
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
  std::vector<double> shares_;
  ImageFeatures inner_;
};

}  // namespace

std::unique_ptr<ChordFeatures> chord_features(const Arm& arm, int points) {
  return std::make_unique<ChordAngles>(arm, points);
}

std::unique_ptr<ServoFeatures> servo_features(const ServoConfig& config, const RigModel& believed) {
  if (config.measure == ServoMeasure::picture) return servo_features(config.law, believed.arm, config.points);
  auto chords = config.law == ServoLawKind::chords ? chord_features(believed.arm, config.points)
                                                   : plane_features(believed.arm, config.points);
  std::array<int, 2> whites{};
  for (std::size_t i = 0; i < 2; ++i)
    whites[i] = white_of(believed.cameras.at(config.cameras[i]).sensor.bits);
  return std::make_unique<FlowFeatures>(believed.arm, std::move(chords), config.anchor, whites);
}

std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm, int points) {
  switch (law) {
    case ServoLawKind::shape:
      return std::make_unique<EstimatedShape>();
    case ServoLawKind::points:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_points(points));
    case ServoLawKind::chords:
      return chord_features(arm, points);
    case ServoLawKind::moments:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_moments());
    case ServoLawKind::potential:
      return plane_features(arm, points);
    case ServoLawKind::silhouettes:
      break;
  }
  return silhouette_features(arm, points);
}

}  // namespace flexura
