#include "flexura/servo/servo_features.h"

#include <utility>

#include "flexura/control/feature_images.h"
#include "flexura/control/shape_features.h"
#include "flexura/servo/servo_eyes.h"

namespace flexura {
namespace {

// Every section's bend_x, bend_y and stretch.
Eigen::VectorXd all_of(const ArmState& state) {
  Eigen::VectorXd values(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    values.segment<2>(at) = state.bends[i], values[at + 2] = state.stretches[i];
  }
  return values;
}

// The estimated shape itself.
class EstimatedShape : public ServoFeatures {
 public:
  [[nodiscard]] std::optional<Eigen::VectorXd> measured(const ArmState& estimate,
                                                        const std::array<Sighting, 2>&) override {
    return all_of(estimate);
  }
  [[nodiscard]] std::optional<Eigen::VectorXd> foreseen(const ArmState& state,
                                                        const std::array<View, 2>&) override {
    return all_of(state);
  }
  [[nodiscard]] std::optional<FeatureError> error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                                  const ArmState&, const std::array<View, 2>&) override {
    return FeatureError{seen - desired, Eigen::MatrixXd::Identity(seen.size(), seen.size())};
  }
};

// Points, chords or moments of both images.
class ImageFeatures : public ServoFeatures {
 public:
  ImageFeatures(Arm arm, FeatureSet set)
      : arm_(std::move(arm)), set_(std::move(set)), shares_(needed_shares(set_)), images_(arm_, set_) {}

  [[nodiscard]] std::optional<Eigen::VectorXd> measured(const ArmState& estimate,
                                                        const std::array<Sighting, 2>& seen) override {
    Eigen::VectorXd values(2 * set_.rows());
    for (std::size_t i = 0; i < 2; ++i) {
      const auto pixels = measured_pixels(arm_, estimate, seen[i], shares_);
      const auto one = pixels ? feature_values(set_, *pixels) : std::nullopt;
      if (!one) return std::nullopt;
      values.segment(static_cast<Eigen::Index>(i) * set_.rows(), set_.rows()) = *one;
    }
    return values;
  }
  [[nodiscard]] std::optional<Eigen::VectorXd> foreseen(const ArmState& state,
                                                        const std::array<View, 2>& views) override {
    Eigen::VectorXd values;
    if (!images_.values(state, views, values)) return std::nullopt;
    return values;
  }
  [[nodiscard]] std::optional<FeatureError> error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                                  const ArmState& estimate,
                                                  const std::array<View, 2>& views) override {
    Eigen::VectorXd values;
    FeatureError result{feature_error(set_, seen, desired), {}};
    if (!images_.derive(estimate, views, values, result.by_state)) return std::nullopt;
    return result;
  }

 private:
  Arm arm_;
  FeatureSet set_;
  std::vector<double> shares_;
  FeatureImages images_;
};

}  // namespace

std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm, int points) {
  switch (law) {
    case ServoLawKind::shape:
      return std::make_unique<EstimatedShape>();
    case ServoLawKind::points:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_points(points));
    case ServoLawKind::chords:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_chords(points));
    case ServoLawKind::moments:
      return std::make_unique<ImageFeatures>(arm, FeatureSet::of_moments());
    case ServoLawKind::potential:
      break;
  }
  return plane_features(arm, points);
}

}  // namespace flexura
