#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/estimate/band_match.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_fit.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Settings of an estimate.
struct EstimatorConfig {
  /// Largest number of points per observation. From more points, evenly spaced points are selected.
  std::size_t most_points = 100;
  int most_iterations = 60;  ///< Largest number of iterations per descent.
  /// If the standard deviation of the shape exceeds this value, the estimate gets a note. The standard
  /// deviation is the root mean square along the arm, as a share of its length.
  double uncertain = 1.1e-4;
  /// Largest accepted root mean square distance between the points and the shape's images, px, in addition to
  /// the points' noise. Inaccurate cameras need a larger value.
  double most_rms = 1;
};

/// An estimate of the arm's shape from camera observations.
struct ShapeEstimate {
  Shape shape;  ///< Estimated shape; only a guess if is_found is false.
  bool is_found = false;
  std::string reason;  ///< Reason why no shape was found, or "".
  /// Whether no shape was found because the pictures require camera errors far beyond their priors.
  bool is_elsewhere = false;
  std::vector<std::string> notes;  ///< Reasons to distrust the estimate; empty for a trusted estimate.
  double rms = 0;                  ///< Root mean square of the points' distances from the shape's images, px.
  double outlier_share = 0;        ///< Share of the points that are outliers.
  double scale = 1;  ///< Scale of the residuals in units of their standard deviations, at least 1. `sigma`
                     ///< includes this factor.
  /// Arc lengths of the knots, m, and the standard deviation of the position at each knot, m: the square root
  /// of the covariance's trace.
  std::vector<double> s, sigma;
  Eigen::MatrixXd covariance;         ///< Covariance of the unknowns (ShapeVariables).
  double innovation = 0;              ///< Normalised innovation (ShapeFit::innovation).
  int iterations = 0;                 ///< Iterations of the final descent.
  std::vector<PlacedMarker> markers;  ///< Markers used by the fit, in order from the base.

  /// Returns the root mean square of `sigma` along the arm, m; 0 if `sigma` is empty.
  [[nodiscard]] double rms_sigma() const;
  /// Returns whether the shape was found without notes.
  [[nodiscard]] bool is_trusted() const { return is_found && notes.empty(); }
};

/// Fits shapes to observations by one or more cameras: least squares of the distances in all images at once,
/// with the full camera model (docs/estimation.md). Equal observations give equal results; those of `follow`
/// also depend on its start. Bands are used if a fit without bands identifies them (band_match.h) and the
/// axes do not contradict them. Points that are not finite, or with a sigma that is not positive, are
/// ignored. If no shape is found, the estimate contains the reason. Not thread-safe: use one estimator per
/// thread.
class ShapeEstimator {
 public:
  /// `prior`: prior knowledge of the arm.
  explicit ShapeEstimator(ShapePrior prior, EstimatorConfig config = {});

  /// Estimates the shape without a given start. Triangulates points of the two observations with the most
  /// nearly perpendicular lines of sight and the largest visible arm. Corresponding points are found by
  /// epipolar geometry and order. If the base's position is known, each observation is ordered from the end
  /// nearer to the base. If it is unknown, the first observation keeps its order, and the others are tried in
  /// both orders.
  [[nodiscard]] ShapeEstimate estimate(std::span<const Observation> observations);

  /// Estimates the shape starting at `before`, the previous shape of the prior's arm. `before` may contain
  /// view errors.
  [[nodiscard]] ShapeEstimate follow(std::span<const Observation> observations, const Shape& before);

  /// Updates a predicted shape. The prediction is weighted by its covariance. The prediction includes the
  /// views' errors and replaces the priors of the observations. These priors only determine which views have
  /// an error.
  [[nodiscard]] ShapeEstimate update(std::span<const Observation> observations,
                                     const ShapePrediction& before);

 private:
  // `problem` must be linearised at the fit's shape.
  [[nodiscard]] ShapeEstimate answer(const ShapeProblem& problem, ShapeFit fit) const;
  // Repeats the fit `first`, made without bands, with the bands that it identifies. Adds a note to `first` if
  // the bands cannot be used.
  [[nodiscard]] ShapeEstimate with_bands(std::span<const Observation> observations, ShapeEstimate first,
                                         double cost, const ShapePrediction* prediction);
  [[nodiscard]] std::vector<Observation> prepared(std::span<const Observation> observations) const;

  ShapePrior prior_;
  EstimatorConfig config_;
  ShapeDescent descent_;
};

/// Returns the prior of an arm that a file describes. Everything is known; only the length is unknown if a
/// section can stretch. For more than 12 sections, the prior has a standard deviation of the change of
/// curvature.
[[nodiscard]] ShapePrior described_arm(const Arm& arm);

/// Returns the prior of an arm without a kinematic model: `sections` equal, short, smooth sections.
[[nodiscard]] ShapePrior unknown_arm(std::optional<Eigen::Vector3d> base, std::optional<double> length,
                                     std::size_t sections = 30);

}  // namespace flexura
