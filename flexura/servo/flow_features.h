#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_sight.h"
#include "flexura/vision/curve_flow.h"

namespace flexura {

/// Features of chords whose angles are carried from picture to picture by the optical flow at their ends, and
/// drawn back to the angles of each picture (docs/servo.md, eq. 25): the paper's continuous measure.
class FlowFeatures : public ServoFeatures {
 public:
  /// What is drawn back is left as exp(-t/anchor), s. `whites`: the largest values of the cameras' pictures.
  FlowFeatures(Arm arm, std::unique_ptr<ChordFeatures> chords, double anchor, std::array<int, 2> whites);

  void look(const ServoSight& sight) override;
  /// Of the sight that was looked at last, by the carried angles; of others as the chords measure them.
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Sighting, 2>& seen,
                              Eigen::VectorXd& values) override;
  [[nodiscard]] bool foreseen(const ArmState& state, const std::array<View, 2>& views,
                              Eigen::VectorXd& values) override {
    return chords_->foreseen(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    return chords_->error(seen, desired, estimate, views, result);
  }
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired, const ShapeWay& way,
                            const std::array<View, 2>& views, FeatureError& result) override {
    return chords_->secant(seen, desired, way, views, result);
  }

  /// Of the last sight, camera by camera: the angles of the chords' images as carried and drawn back, as
  /// measured in the picture, and by how much they turned since the sight before as the flow has it (not
  /// numbers where it has none, and at the first), rad, from u towards v.
  struct Angles {
    std::vector<double> carried, measured, turns;
  };
  [[nodiscard]] const std::array<Angles, 2>& angles() const { return angles_; }

 private:
  // What is kept of one camera.
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
  std::optional<double> time_;  // Of the last sight, s.
  std::array<Seen, 2> seen_;
  std::array<Angles, 2> angles_;
  std::array<Eigen::Matrix2Xd, 2> pixels_;  // The chords' ends, chords at their carried angles.
};

}  // namespace flexura
