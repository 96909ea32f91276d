#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/tube_image.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/rim_search.h"

namespace flexura {

/// A picture in which a tube is fitted.
struct TubePicture {
  const Image<std::uint8_t>* picture = nullptr;  ///< Gray or RGB.
  View view;                                     ///< View according to the camera model.
  ViewPrior view_prior = {};                     ///< Prior of the view's error.
  const ArmScene* scene = nullptr;  ///< What separates the arm from its surroundings; null: nothing.
};

/// How much of the tube one picture shows.
struct TubeVisibility {
  std::size_t expected = 0;  ///< Number of cross-sections that the picture should show.
  std::size_t measured = 0;  ///< Number of those whose rims were measured.
  std::size_t both = 0;      ///< Number of those with both rims.
  std::size_t lit = 0;       ///< Number of those whose light differs inside and outside as expected.
  double width_ratio = 1;    ///< Width of the tube, divided by its expected width.
  double tip_share = 1;      ///< Measured share of the last fifth of the cross-sections.
  /// Longest stretch beside which something looks much more like the arm, as a share of the cross-sections.
  double elsewhere = 0;
  std::string complaint;  ///< Why the scene could not be used, or "".
};

/// Result of a fit.
struct TubeFit {
  ShapeEstimate estimate;
  /// Measured points of the backbone's image in each picture, for the estimator and the tracker.
  std::vector<Observation> observations;
  std::vector<TubeVisibility> pictures;
};

/// Settings of a fit.
struct TubeFitConfig {
  int most_passes =
      10;  ///< Largest number of coarse searches, which compare the light on both sides of the rims.
  int refinements = 3;           ///< Number of measurements of the rims' edges.
  double least_visible = 0.25;   ///< Share of a picture's cross-sections that must be measured.
  double trusted_visible = 0.5;  ///< Share below which a note says that the fit is not trusted.
  double trusted_tip = 0.6;      ///< The same for the last fifth of the arm (TubeVisibility::tip_share).
  /// Largest TubeVisibility::elsewhere without a note.
  double most_elsewhere = 0.06;
  /// Largest normalised innovation of the prediction without a note (ShapeEstimate::innovation).
  double most_innovation = 2.5;
};

/// Fits the projected tube of an arm of roughly known shape to pictures (docs/estimation.md, "Model-based").
/// It searches the rims along their normals, within the uncertainty of the prediction, by the light on both
/// sides. The fit makes the search narrower (R. Hanek and M. Beetz, The Contracting Curve Density Algorithm,
/// IJCV 2004). Then it measures the edges with subpixel accuracy. Not thread-safe.
class TubeFitter {
 public:
  explicit TubeFitter(ShapePrior prior, const EstimatorConfig& estimator = default_estimator(),
                      const TubeFitConfig& config = {});

  /// Settings that suit pictures with clutter: shapes are uncertain beyond 0.1 % of the length.
  [[nodiscard]] static EstimatorConfig default_estimator();

  /// Fits the shape. `start` has the covariance of the unknowns, including those of views with a prior. The
  /// prediction is weighted by this covariance. Without a trustworthy fit, the estimate is not found or has
  /// notes.
  [[nodiscard]] TubeFit fit(std::span<const TubePicture> pictures, const ShapePrediction& start);

 private:
  using Sections = std::vector<TubeSection>;
  void observe(std::size_t i, bool is_fine, TubeFit& fit);
  void look_beside(TubeFit& fit);
  void judge(TubeFit& fit) const;
  [[nodiscard]] bool narrow(TubeImage& image, const ShapeEstimate& estimate);

  ShapePrior prior_;
  TubeFitConfig config_;
  ShapeEstimator estimator_;
  std::vector<RimSearch> searches_;
  std::vector<Sections> sections_;
  std::vector<ExpectedSection> expected_;
  std::vector<std::size_t> of_section_;
  std::vector<SeenSection> seen_;
};

/// Returns a prediction with the given standard deviation of each bend, rad. Bases and stretches that are not
/// known have the standard deviations of 1 % of the length, 0.05 rad and 0.02. Views with a prior have its
/// standard deviations.
[[nodiscard]] ShapePrediction rough_prediction(const ShapePrior& prior, const Shape& mean, double bend_std,
                                               std::span<const ViewPrior> views);

}  // namespace flexura
