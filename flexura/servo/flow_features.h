#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_observation.h"
#include "flexura/vision/curve_flow.h"

namespace flexura {

/// Features of chords whose angles are tracked from picture to picture by the optical flow at the chords'
/// ends. The tracked angles are corrected towards the angles measured in each picture (docs/servo.md, eq.
/// 25). This method is the paper's continuous measurement.
class FlowFeatures : public ServoFeatures {
 public:
  /// `anchor`: time constant with which a tracked angle approaches the measured angle, s. `whites`: the
  /// largest pixel values of the cameras' pictures.
  FlowFeatures(Arm arm, std::unique_ptr<ChordFeatures> chords, double anchor, std::array<int, 2> whites);

  void look(const ServoObservation& observed) override;
  /// Uses the tracked angles for the observation that the last look() received, and for other observations
  /// the angles measured in their pictures.
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override;
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return chords_->predict(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    return chords_->error(seen, desired, estimate, views, result);
  }
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                            const ShapeError& way, const std::array<View, 2>& views,
                            FeatureError& result) override {
    return chords_->secant(seen, desired, way, views, result);
  }

  /// Angles of one camera's last observation, rad, from u towards v. `carried` and `measured` are the tracked
  /// and the measured angles of the chords' images. `turns` are the changes of the angles since the previous
  /// observation, computed from the flow. `turns` are NaN where the flow is missing, and at the first
  /// observation.
  struct Angles {
    std::vector<double> carried, measured, turns;
  };
  [[nodiscard]] const std::array<Angles, 2>& angles() const { return angles_; }

 private:
  // Data kept per camera.
  struct Seen {
    Image<std::uint8_t> gray;
    Eigen::Matrix2Xd places;
    std::optional<AngleIntegrator> integrator;
  };
  void begin_anew();
  [[nodiscard]] static std::vector<double> turns(const Seen& before, const Image<std::uint8_t>& gray,
                                                 const Eigen::Matrix2Xd& places);

  Arm arm_;
  std::unique_ptr<ChordFeatures> chords_;
  double anchor_;
  std::array<int, 2> whites_;
  std::optional<double> time_;  // Time of the last observation, s.
  std::array<Seen, 2> seen_;
  std::array<Angles, 2> angles_;
  std::array<Eigen::Matrix2Xd, 2> pixels_;  // Ends of chords with their carried angles.
};

}  // namespace flexura
