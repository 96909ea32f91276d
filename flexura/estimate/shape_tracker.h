#pragma once

#include <optional>
#include <span>
#include <vector>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// How much an arm and the cameras' views change beside what is expected: standard deviations.
struct TrackerConfig {
  double drift = 0.005;       ///< Of each bend, rad in a second, growing with the root of time.
  double astray = 0.1;        ///< Of each bend, share of how far its section was expected to bend meanwhile.
  double turn_drift = 1e-4;   ///< Of a view's error, rad in a second, growing likewise.
  double focal_drift = 1e-4;  ///< Likewise.
  /// Expectations that what is seen speaks more against are given up; ShapeEstimate::surprise.
  double most_surprise = 2.5;
  /// Where more of the points than this share belong to something else, in so many looks one after another,
  /// the arm is looked for from nothing as well.
  double most_doubted = 0.1;
  int patience = 10;
};

/// An arm whose shape is seen again and again: what earlier sightings told of it, and of what is wrong with
/// the cameras' views, counts in the next estimate (a Kalman filter whose update is the estimator's fit).
/// What one pair of pictures hardly tells comes out of many. One thread at a time uses it.
class ShapeTracker {
 public:
  /// std::invalid_argument: of the arm's base or length something is not known.
  ShapeTracker(ShapePrior prior, const EstimatorConfig& estimator, const TrackerConfig& config = {});

  /// The shape at `time` (s), expected to be `expected`, if anything is: that of the estimate before, moved
  /// on by what is known of the arm's motion since. Without that nothing earlier counts. Estimates that are
  /// found have the views' errors in `shape.views`.
  [[nodiscard]] ShapeEstimate look(std::span<const Sighting> sightings, double time,
                                   const std::optional<ArmState>& expected);

  /// The next sightings are of an arm that nothing is known of.
  void forget() { belief_.reset(), usual_rms_ = 0, doubtful_ = 0, elsewhere_.reset(); }

 private:
  // What is believed of an arm that is expected to have gone on so.
  [[nodiscard]] ShapeBelief gone_on(std::span<const Sighting> sightings, double time,
                                    const ArmState& expected) const;
  [[nodiscard]] bool is_as_usual(const ShapeEstimate& estimate) const;
  // From what is expected of it; and whether that speaks against what was believed.
  [[nodiscard]] ShapeEstimate followed(std::span<const Sighting> sightings, double time,
                                       const ArmState& expected);
  [[nodiscard]] bool is_to_be_checked(const ShapeEstimate& estimate);
  [[nodiscard]] ShapeEstimate from_nothing(std::span<const Sighting> sightings);
  [[nodiscard]] ShapeEstimate found(std::span<const Sighting> sightings, double time,
                                    const std::optional<ArmState>& expected);

  ShapePrior prior_;
  Arm arm_;
  TrackerConfig config_;
  ShapeVariables variables_;
  ShapeEstimator estimator_;
  std::optional<ShapeBelief> belief_;
  double time_ = 0;       // Of that, s.
  double usual_rms_ = 0;  // Of the last estimate's residuals, px.
  bool is_surprising_ = false;
  int doubtful_ = 0;  // Looks of which much is something else's, up to the last one.
  // By what the last look from nothing was explained, if cameras would have to stand otherwise for it.
  std::optional<Shape> elsewhere_;
};

}  // namespace flexura
