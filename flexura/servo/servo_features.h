#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

struct ServoSight;

/// How far what is seen is from what is wanted, and how that changes with the arm.
struct FeatureError {
  Eigen::VectorXd error;  ///< Seen less desired.
  /// Columns: each section's bend_x, bend_y (rad), stretch.
  Eigen::MatrixXd by_state;
};

/// The way that a law is to close: from the shape that is seen to the wanted one. These outlive it.
struct ShapeWay {
  const ArmState &seen, &wanted;
  const ArmState& halfway;  ///< interpolate(seen, wanted, 0.5)
};

/// What a law looks at. Each is a vector of the same size for every sight, written into what is made to fit.
/// One thread at a time uses it.
class ServoFeatures {
 public:
  virtual ~ServoFeatures() = default;
  ServoFeatures() = default;
  ServoFeatures(const ServoFeatures&) = delete;
  ServoFeatures& operator=(const ServoFeatures&) = delete;

  /// New pictures, before they are measured: for what goes by those before them as well.
  virtual void look(const ServoSight& /*sight*/) {}
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
  /// The same error, of an arm in the state way.seen, with the derivatives of the whole way instead: it is
  /// by_state times what the arm's state is off the wanted one, from which `desired` is, as nearly as the
  /// arm half-way tells (docs/control.md, eq. 20a). Features that know no better have those of error().
  [[nodiscard]] virtual bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                    const ShapeWay& way, const std::array<View, 2>& views,
                                    FeatureError& result) {
    return error(seen, desired, way.seen, views, result);
  }
};

/// Features that are made of the chords between places in a row along the arm.
class ChordFeatures : public ServoFeatures {
 public:
  /// The places: shares of the unstretched arm's length from 0 to 1.
  [[nodiscard]] virtual const std::vector<double>& shares() const = 0;
  /// As measured of an estimated shape whose places are seen at these pixels.
  [[nodiscard]] virtual bool of_pixels(const std::array<Eigen::Matrix2Xd, 2>& pixels,
                                       const ArmState& estimate, const std::array<View, 2>& views,
                                       Eigen::VectorXd& values) = 0;
};

/// From 0 to 1: `count` + 1 of them.
[[nodiscard]] std::vector<double> equal_shares(int count);

/// What a servo looks at. `believed` may go afterwards.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(const ServoConfig& config,
                                                            const RigModel& believed);

/// Those of a law, along an arm that is believed to be `arm`, at `places` places.
[[nodiscard]] std::unique_ptr<ServoFeatures> servo_features(ServoLawKind law, const Arm& arm,
                                                            std::int64_t places);

/// Those of the law `potential`: angles of chords in two image planes, read as parallel projections (the
/// paper's section 2; docs/control.md, eq. 14). The error is the spatial one's parts: cos q e_theta and e_q
/// of each chord, over the root of their number. Chords that the reading says little of, near a quarter turn
/// of theta or q or on the way across one, are read from the shape.
[[nodiscard]] std::unique_ptr<ChordFeatures> plane_features(const Arm& arm, int points);

/// The angles of the images of chords in a row.
[[nodiscard]] std::unique_ptr<ChordFeatures> chord_features(const Arm& arm, int points);

/// Those of the law `silhouettes`: the edges of both images, by their displacement across themselves, px. The
/// values are edges' pixels and the normals of the shape's contours there, not numbers where the arm has
/// none; the error is contour_error().
[[nodiscard]] std::unique_ptr<ServoFeatures> silhouette_features(const Arm& arm, int points);

}  // namespace flexura
