#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/estimate/band_match.h"
#include "flexura/estimate/shape_fit.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// How an estimate is made.
struct EstimatorConfig {
  std::size_t most_points = 100;  ///< Of each sighting; more are thinned out.
  int most_iterations = 60;       ///< Of each descent.
  /// Estimates whose standard deviation, root mean square along the arm, is larger are marked; share of its
  /// length.
  double uncertain = 1.1e-4;
  /// Shapes whose images lie farther from the points are none, unless their noise explains it; px, root mean
  /// square. Cameras that are known badly need more.
  double most_rms = 1;
};

/// The arm's shape from what cameras see of it.
struct ShapeEstimate {
  Shape shape;  ///< Where it was not found no more than a guess.
  bool is_found = false;
  std::string reason;         ///< Why it is not.
  bool is_elsewhere = false;  ///< It is not, for the cameras would have to stand otherwise than is doubted.
  std::vector<std::string> notes;  ///< Why it is to be doubted; empty when nothing speaks against it.
  double rms = 0;                  ///< Of the points' distances from the shape's images, px.
  double doubted = 0;              ///< The share of the points that are taken for something else's.
  double scale = 1;                ///< Of the residuals, in units of their sigmas: at least 1; in `sigma`.
  /// Of the position at the knots `s` (m of arc length), standard deviation, m: the root of the trace.
  std::vector<double> s, sigma;
  Eigen::MatrixXd covariance;         ///< Of the unknowns (ShapeVariables).
  double surprise = 0;                ///< ShapeFit::surprise
  int iterations = 0;                 ///< Of the descent that ended in it.
  std::vector<PlacedMarker> markers;  ///< That the fit used, from the base on.

  /// Root mean square of `sigma` along the arm, m; 0 where there is none.
  [[nodiscard]] double rms_sigma() const;
  /// Found, and nothing speaks against it.
  [[nodiscard]] bool is_trusted() const { return is_found && notes.empty(); }
};

/// Fits shapes to sightings by one or more cameras: least squares of the distances in all images at once,
/// under the full camera model (docs/estimation.md). The same sightings give the same answer, but for
/// `follow`, which starts from the shape that it is given. Bands count where a fit without them tells which
/// is which (band_match.h), as long as the axes do not speak against them. Points of the sightings that are
/// not finite, or whose sigma is not positive, count as not seen; what cannot be told is an estimate that is
/// not found, with the reason. One for each thread: it keeps its storage.
class ShapeEstimator {
 public:
  /// Of the arm that `prior` describes, as far as it does.
  explicit ShapeEstimator(ShapePrior prior, EstimatorConfig config = {});

  /// From nothing: of the two sightings whose lines of sight cross most squarely and that show the most of
  /// the arm points are paired by epipolar geometry and their order, and triangulated.
  /// Where the base's position is known, each sighting is followed from the end nearer to it; otherwise the
  /// order of the first one's points holds, and the others are followed from either end.
  [[nodiscard]] ShapeEstimate estimate(std::span<const Sighting> sightings);

  /// From the shape a moment ago: of the prior's arm, with any `views`.
  [[nodiscard]] ShapeEstimate follow(std::span<const Sighting> sightings, const Shape& before);

  /// From what is known of it, which counts as much as what is seen. It knows the views' errors as well: the
  /// sightings' own doubts tell only which there are.
  [[nodiscard]] ShapeEstimate update(std::span<const Sighting> sightings, const ShapeBelief& before);

 private:
  // `problem` is that at the fit's shape.
  [[nodiscard]] ShapeEstimate answer(const ShapeProblem& problem, ShapeFit fit) const;
  // `first` without the bands, again with those that it can tell apart; their words on it where they cannot
  // be.
  [[nodiscard]] ShapeEstimate with_bands(std::span<const Sighting> sightings, ShapeEstimate first,
                                         double cost, const ShapeBelief* belief);
  [[nodiscard]] std::vector<Sighting> prepared(std::span<const Sighting> sightings) const;

  ShapePrior prior_;
  EstimatorConfig config_;
  ShapeDescent descent_;
};

/// What is known of an arm that a file describes: all but its length, if the limits let a section stretch.
[[nodiscard]] ShapePrior described_arm(const Arm& arm);

/// What is known of an arm of which nothing is: `sections` equal, short, smooth ones.
[[nodiscard]] ShapePrior unknown_arm(std::optional<Eigen::Vector3d> base, std::optional<double> length,
                                     std::size_t sections = 30);

}  // namespace flexura
