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
  Eigen::VectorXd error;  ///< Measured features minus target features.
  /// Derivatives of the error. The columns are bend_x, bend_y (rad) and stretch of each section.
  Eigen::MatrixXd by_state;
};

/// The observed shape, the target shape, and the shape half-way between them. The states must outlive this
/// object.
struct ShapeError {
  const ArmState &seen, &desired;
  const ArmState& halfway;  ///< interpolate(seen, wanted, 0.5)
};

/// Features that a law compares. All output vectors have the same size; they are resized if needed. Not
/// thread-safe.
class ServoFeatures {
 public:
  virtual ~ServoFeatures() = default;
  ServoFeatures() = default;
  ServoFeatures(const ServoFeatures&) = delete;
  ServoFeatures& operator=(const ServoFeatures&) = delete;

  /// Receives new pictures before measured() is called. Features that also use earlier pictures need this
  /// function.
  virtual void look(const ServoObservation& /*observed*/) {}
  /// Computes the features measured in two observations of an arm whose estimated shape is `estimate`.
  /// Returns false if the features cannot be measured.
  [[nodiscard]] virtual bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                                      Eigen::VectorXd& values) = 0;
  /// Computes the features that nominal cameras would observe of an arm in this state.
  [[nodiscard]] virtual bool predict(const ArmState& state, const std::array<View, 2>& views,
                                     Eigen::VectorXd& values) = 0;
  /// Computes the error `seen` minus `desired` of the features, and its derivatives for an arm in the state
  /// `estimate`.
  [[nodiscard]] virtual bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                   const ArmState& estimate, const std::array<View, 2>& views,
                                   FeatureError& result) = 0;
  /// Computes the same error as error(), for an arm in the state way.seen. For large differences, by_state is
  /// a secant instead of the derivatives. The error is then close to by_state times the difference between
  /// the arm's state and the target state (docs/control.md, eq. 20a). By default the secant equals the
  /// derivatives of error().
  [[nodiscard]] virtual bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                    const ShapeError& way, const std::array<View, 2>& views,
                                    FeatureError& result) {
    return error(seen, desired, way.seen, views, result);
  }
};

/// Features computed from the chords between consecutive points along the arm.
class ChordFeatures : public ServoFeatures {
 public:
  /// Returns the positions of the points, as shares of the unstretched arm's length from 0 to 1.
  [[nodiscard]] virtual const std::vector<double>& shares() const = 0;
  /// Computes the features from the pixels of the points. `estimate`: estimated shape of the arm.
  [[nodiscard]] virtual bool of_pixels(const std::array<Eigen::Matrix2Xd, 2>& pixels,
                                       const ArmState& estimate, const std::array<View, 2>& views,
                                       Eigen::VectorXd& values) = 0;
};

/// Returns `count` + 1 equally spaced values from 0 to 1.
[[nodiscard]] std::vector<double> equal_shares(int count);

/// Returns the features of a servo. Keeps no reference to `nominal`.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(const ServoConfig& config,
                                                            const RigModel& nominal);

/// Returns the features of a law at `places` points along the arm model `arm`.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm,
                                                            std::int64_t places);

/// Returns the features of the law `potential`: angles of chords in two image planes, read as parallel
/// projections (the paper's section 2; docs/control.md, eq. 14). The error of each chord has the components
/// cos q e_theta and e_q, divided by the root of the number of chords. Near pi/2 of theta or q, or if pi/2 is
/// between an angle and its target, image angles contain little information. Such chords use the angles of
/// the estimated shape.
[[nodiscard]] std::unique_ptr<ChordFeatures> plane_features(const Arm& arm, int points);

/// Returns the features of the law `chords`: image angles of consecutive chords.
[[nodiscard]] std::unique_ptr<ChordFeatures> chord_features(const Arm& arm, int points);

/// Returns the features of the law `silhouettes`: displacements of the edges in both images along their
/// normals, px. The values are the pixels of the edges, and the normals of the shape's contours at these
/// pixels. Pixels and normals are NaN where there is no contour. The error is contour_error().
[[nodiscard]] std::unique_ptr<ServoFeatures> silhouette_features(const Arm& arm, int points);

}  // namespace flexura
