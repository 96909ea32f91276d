#pragma once

#include <optional>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/swing_filter.h"

namespace flexura {

/// Standard deviations of the process noise of an arm and of the cameras' views.
struct TrackerConfig {
  double process_noise = 0.005;  ///< Process noise of each bend, rad per root second.
  /// Process noise of each bend of an arm with dynamics, rad per root second. This noise is larger, because
  /// an error of the equilibrium must not be mistaken for an oscillation.
  double swinging_noise = 0.03;
  double motion_noise =
      /// Motion-proportional noise of each bend, as a share of the predicted change of the section's bend.
      0.1;
  double turn_noise = 1e-4;   ///< Process noise of a view's rotation error, rad per root second.
  double focal_noise = 1e-4;  ///< Process noise of a view's focal error, per root second.
  /// Predictions with a larger normalised innovation (ShapeEstimate::innovation) are discarded.
  double max_innovation = 2.5;
  /// If more than this share of the points are outliers in `patience` successive observations, the arm is
  /// also estimated without a start.
  double max_outlier_share = 0.1;
  int patience = 10;
};

/// Tracks the shape of an arm by a Kalman filter. The filter's update is the estimator's fit. Each estimate
/// also uses earlier observations of the shape and of the view errors, so that information from many pairs of
/// pictures accumulates. Not thread-safe.
class ShapeTracker {
 public:
  /// Throws std::invalid_argument if the arm's base or length is not known.
  ShapeTracker(ShapePrior prior, const EstimatorConfig& estimator, const TrackerConfig& config = {});

  /// Returns the shape at `time` (s). `expected`: predicted shape, which is the previous estimate advanced by
  /// the known motion of the arm since then. Without it, earlier observations are discarded. If the shape is
  /// found, `shape.views` contains the views' errors.
  [[nodiscard]] ShapeEstimate look(std::span<const Observation> observations, double time,
                                   const std::optional<ArmState>& expected);
  /// Returns the shape of an arm that oscillates. `expected`: prediction without the change of the
  /// oscillation. `path`: motion of the drives since the previous estimate.
  [[nodiscard]] ShapeEstimate look(std::span<const Observation> observations, double time,
                                   const std::optional<ArmState>& expected, const SwingPath& path);
  /// Returns the oscillation at the last estimate. For an arm without modes, no oscillation is tracked.
  [[nodiscard]] const SwingFilter& swing() const { return swing_; }

  /// Resets the tracker. The next estimate uses no prediction.
  void forget() {
    prediction_.reset(), usual_rms_ = 0, unreliable_ = 0, elsewhere_.reset();
    swing_.forget();
  }

 private:
  // Advances the filter's state to these observations.
  void go_on(std::span<const Observation> observations, double time, const ArmState& expected,
             const SwingPath& path);
  void update_swing(std::span<const Observation> observations, const ShapeEstimate& estimate);
  [[nodiscard]] bool is_as_usual(const ShapeEstimate& estimate) const;
  // Estimates from the prediction, and sets whether the observations contradict it.
  [[nodiscard]] ShapeEstimate followed(std::span<const Observation> observations, const ArmState& expected);
  [[nodiscard]] bool is_to_be_checked(const ShapeEstimate& estimate);
  [[nodiscard]] ShapeEstimate from_nothing(std::span<const Observation> observations);
  [[nodiscard]] ShapeEstimate found(std::span<const Observation> observations,
                                    const std::optional<ArmState>& expected);

  ShapePrior prior_;
  Arm arm_;
  TrackerConfig config_;
  ShapeVariables variables_;
  ShapeEstimator estimator_;
  // The last estimate; while looking, the filter's prediction.
  std::optional<ShapePrediction> prediction_;
  SwingFilter swing_;
  bool is_updated_ = false;  // Whether the estimate contains the prediction.
  double time_ = 0;          // Time of `prediction_`, s.
  double usual_rms_ = 0;     // Root mean square of the last estimate's residuals, px.
  bool is_innovation_large_ = false;
  int unreliable_ = 0;  // Number of successive observations with many outliers, up to the last one.
  // Shape of the last estimate without a start, if it needs camera errors beyond their priors.
  std::optional<Shape> elsewhere_;
};

}  // namespace flexura
