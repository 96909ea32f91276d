#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

struct ServoObservation;

/// Feature error, and its derivatives with respect to the arm's state.
struct FeatureError {
  Eigen::VectorXd error;  ///< Measured minus target.
  /// Derivatives of the error; the columns are each section's bend_x, bend_y (rad) and stretch.
  Eigen::MatrixXd by_state;
};

/// The observed shape, the target shape, and the shape half-way between them. The states must outlive this
/// object.
struct ShapeError {
  const ArmState &seen, &desired;
  const ArmState& halfway;  ///< interpolate(seen, wanted, 0.5)
};

/// Features that a law compares. Each call writes a vector of the same size and resizes the output if needed.
/// Not thread-safe.
class ServoFeatures {
 public:
  virtual ~ServoFeatures() = default;
  ServoFeatures() = default;
  ServoFeatures(const ServoFeatures&) = delete;
  ServoFeatures& operator=(const ServoFeatures&) = delete;

  /// Receives new pictures before they are measured, for features that also use earlier pictures.
  virtual void look(const ServoObservation& /*observed*/) {}
  /// Computes the features measured in two observations of an arm whose estimated shape is `estimate`.
  /// Returns false if that is impossible.
  [[nodiscard]] virtual bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                                      Eigen::VectorXd& values) = 0;
  /// Computes the features that nominal cameras would observe of an arm in this state.
  [[nodiscard]] virtual bool predict(const ArmState& state, const std::array<View, 2>& views,
                                     Eigen::VectorXd& values) = 0;
  /// Computes the difference between the features `seen` and `desired`, and its derivatives for an arm in the
  /// state `estimate`.
  [[nodiscard]] virtual bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                   const ArmState& estimate, const std::array<View, 2>& views,
                                   FeatureError& result) = 0;
  /// Computes the same error as error(), for an arm in the state way.seen, with derivatives for a large
  /// difference. The error is then close to by_state times the difference between the arm's state and the
  /// target state (docs/control.md, eq. 20a). The default uses the derivatives of error().
  [[nodiscard]] virtual bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                    const ShapeError& way, const std::array<View, 2>& views,
                                    FeatureError& result) {
    return error(seen, desired, way.seen, views, result);
  }
};

/// Features computed from the chords between consecutive places along the arm.
class ChordFeatures : public ServoFeatures {
 public:
  /// Returns the places, as shares of the unstretched arm's length from 0 to 1.
  [[nodiscard]] virtual const std::vector<double>& shares() const = 0;
  /// Computes the features of an arm with the estimated shape `estimate` whose places are at these pixels.
  [[nodiscard]] virtual bool of_pixels(const std::array<Eigen::Matrix2Xd, 2>& pixels,
                                       const ArmState& estimate, const std::array<View, 2>& views,
                                       Eigen::VectorXd& values) = 0;
};

/// Returns `count` + 1 equally spaced values from 0 to 1.
[[nodiscard]] std::vector<double> equal_shares(int count);

/// Returns the features of a servo. Keeps no reference to `nominal`.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(const ServoConfig& config,
                                                            const RigModel& nominal);

/// Returns the features of a law at `places` places along the arm model `arm`.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm,
                                                            std::int64_t places);

/// Returns the features of the law `potential`: angles of chords in two image planes, read as parallel
/// projections (the paper's section 2; docs/control.md, eq. 14). The error of each chord has the components
/// cos q e_theta and e_q, divided by the root of the number of chords. Near a quarter turn of theta or q, or
/// if the error crosses one, image angles give little information. Such chords use the angles of the
/// estimated shape.
[[nodiscard]] std::unique_ptr<ChordFeatures> plane_features(const Arm& arm, int points);

/// Returns features of the image angles of consecutive chords.
[[nodiscard]] std::unique_ptr<ChordFeatures> chord_features(const Arm& arm, int points);

/// Returns the features of the law `silhouettes`: displacements of the edges in both images along their
/// normals, px. The values are the pixels of the edges and the normals of the shape's contours at these
/// pixels; NaN where there is no contour. The error is contour_error().
[[nodiscard]] std::unique_ptr<ServoFeatures> silhouette_features(const Arm& arm, int points);

}  // namespace flexura
