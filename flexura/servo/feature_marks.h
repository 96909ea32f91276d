#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_sight.h"

namespace flexura {

/// One thing that a law compares in a picture: a pixel, or a line of some, as measured and as wanted, px.
struct FeatureMark {
  std::vector<Eigen::Vector2d> seen, wanted;
};

/// What a law compares, to be drawn upon the pictures: pixels of `points` and of the edges of `silhouettes`;
/// chords (`chords`, `potential`), the wanted one of each turned about the middle of the measured one, for
/// the law compares their directions alone; of `moments` the middle and the ellipse that has the second
/// moments; of `shape`, which compares no images, nothing.
class FeatureMarker {
 public:
  FeatureMarker(ServoLawKind law, Arm arm, std::int64_t points);

  /// In both pictures of a sight, at its time; none where it tells no shape. Chords are as measured in these
  /// pictures, also where the law has their angles from the flow.
  [[nodiscard]] std::array<std::vector<FeatureMark>, 2> of(const ServoSight& sight);

 private:
  [[nodiscard]] std::vector<FeatureMark> points_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> edges_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> moments_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> chords_in(std::size_t camera, const ServoSight& sight) const;

  ServoLawKind law_;
  Arm arm_;
  Eigen::Index points_;
  std::vector<double> corners_;  // Shares of the arm where chords meet.
  std::unique_ptr<ServoFeatures> features_;
  Eigen::VectorXd seen_, wanted_;  // The features of both pictures.
};

}  // namespace flexura
