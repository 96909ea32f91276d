#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_observation.h"

namespace flexura {

/// A pixel or polyline that a law compares in a picture: the measured one (`seen`) and the target
/// (`desired`), px.
struct FeatureMark {
  std::vector<Eigen::Vector2d> seen, desired;
};

/// Draws into the pictures the features that a law compares.
///
/// - `points`, `silhouettes`: the pixels of the points, or of the edges.
/// - `chords`, `potential`: chords. A target chord is drawn as the measured chord, rotated about its middle,
///   because the law compares only directions.
/// - `moments`: the centroid and the ellipse with the second moments.
/// - `shape`: nothing, because this law compares no images.
class FeatureMarker {
 public:
  FeatureMarker(ServoLawKind law, Arm arm, std::int64_t points);

  /// Returns the marks in both pictures of an observation, with the target at the observation's time. Returns
  /// no marks if no shape was estimated from the observation. Chords are those measured in these pictures,
  /// even if the law tracks their angles by optical flow.
  [[nodiscard]] std::array<std::vector<FeatureMark>, 2> of(const ServoObservation& observed);

 private:
  [[nodiscard]] std::vector<FeatureMark> points_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> edges_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> moments_in(std::size_t camera) const;
  [[nodiscard]] std::vector<FeatureMark> chords_in(std::size_t camera,
                                                   const ServoObservation& observed) const;

  ServoLawKind law_;
  Arm arm_;
  Eigen::Index points_;
  std::vector<double> corners_;  // Shares of the arm where chords meet.
  std::unique_ptr<ServoFeatures> features_;
  Eigen::VectorXd seen_, desired_;  // Features of both pictures.
};

}  // namespace flexura
