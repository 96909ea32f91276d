#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "flexura/camera/view.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

/// How far what is seen is from what is wanted, and how that changes with the arm.
struct FeatureError {
  Eigen::VectorXd error;  ///< Seen less desired.
  /// Columns: each section's bend_x, bend_y (rad), stretch.
  Eigen::MatrixXd by_state;
};

/// What a law looks at. Each is a vector of the same size for every sight, written into what is made to fit.
/// One thread at a time uses it.
class ServoFeatures {
 public:
  virtual ~ServoFeatures() = default;
  ServoFeatures() = default;
  ServoFeatures(const ServoFeatures&) = delete;
  ServoFeatures& operator=(const ServoFeatures&) = delete;

  /// As measured in two sightings, of which `estimate` is the shape. False where it cannot be.
  [[nodiscard]] virtual bool measured(const ArmState& estimate, const std::array<Sighting, 2>& seen,
                                      Eigen::VectorXd& values) = 0;
  /// As an arm in this state would show them to cameras that are as believed.
  [[nodiscard]] virtual bool foreseen(const ArmState& state, const std::array<View, 2>& views,
                                      Eigen::VectorXd& values) = 0;
  /// The error of these, for an arm in the state `estimate`.
  [[nodiscard]] virtual bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                   const ArmState& estimate, const std::array<View, 2>& views,
                                   FeatureError& result) = 0;
};

/// Those of a law, along an arm that is believed to be `arm`, at `points` places.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm, int points);

/// Those of the law `potential`: angles of chords in two image planes, read as parallel projections (the
/// paper's section 2; docs/control.md, eq. 14). The error is the spatial one's parts: cos q e_theta and e_q
/// of each chord, over the root of their number. Chords that the reading says little of, near a quarter turn
/// of theta or q or on the way across one, are read from the shape.
[[nodiscard]] std::unique_ptr<ServoFeatures> plane_features(const Arm& arm, int points);

}  // namespace flexura
