#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/observation_pair.h"
#include "flexura/estimate/shape_fit.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns the index of the first view whose estimated error is far beyond the view's prior, if any.
[[nodiscard]] std::optional<std::size_t> view_elsewhere(std::span<const Observation> observations,
                                                        const Shape& shape);

/// Returns the first section that is bent beyond its limit by more than the pictures' noise explains, if any.
[[nodiscard]] std::optional<std::size_t> bent_too_far(const Shape& shape);

/// Searches the shape without a start: tries one shape after another until one explains the observations
/// (docs/estimation.md, "Initial shapes"). If no shape explains them with camera errors within the priors,
/// the result may have larger camera errors.
class ShapeSearch {
 public:
  /// `most_iterations`: largest number of iterations of each descent. `most_rms`: largest rms of a good fit
  /// (ShapeFit::is_good), px.
  ShapeSearch(const ShapePrior& prior, int most_iterations, double most_rms, ShapeDescent& descent)
      : prior_(prior), most_iterations_(most_iterations), most_rms_(most_rms), descent_(descent) {}

  /// The best shape, and the observations with their points ordered from base to tip.
  struct Result {
    ShapeFit fit;
    std::vector<Observation> seen;
    /// Distance of another shape that explains all observations equally well, m; 0: no such shape. Another
    /// shape is searched only if an end is displaced and no other observation decides between the two shapes.
    double apart = 0;
  };
  /// Returns the best shape for at least one observation. If the base is unknown, the first observation keeps
  /// its order, and the others are tried in both orders.
  [[nodiscard]] Result best(const std::vector<Observation>& observations);

 private:
  struct Try {
    ShapeFit fit;
    double merit = 0;        // Everything that the shape does not explain, px^2.
    double unexplained = 0;  // Squared distances of points and borders beyond those of inliers, px^2.
    double misfit = 0;       // px^2
    double ends = 0;         // Squared distances of observed ends, px^2.
    bool is_within_prior = false;
    bool is_possible = true;  // No section is bent beyond its limit.
  };
  struct Start {
    Shape shape;
    StartKind kind = StartKind::far;
  };
  // The misfit is not computed if the merit without it is at least `most`.
  [[nodiscard]] Try tried(ShapeProblem& problem, const Start& start, double most);
  [[nodiscard]] static bool is_better(const Try& one, const Try& other);
  [[nodiscard]] bool is_explained(const Try& one) const;
  [[nodiscard]] bool leaves_much(const Try& one) const;
  [[nodiscard]] double apart(const Result& found);
  // Returns starts for descents from the observations of this pair.
  [[nodiscard]] std::vector<Shape> starts(std::span<const Observation> observations,
                                          const ObservationPair& pair) const;
  // Alternatives: shapes that look similar to one of the cameras, or have another bend of the last section.
  [[nodiscard]] std::vector<Start> look_alikes(std::span<const Observation> observations,
                                               const Shape& shape) const;

  const ShapePrior& prior_;
  int most_iterations_;
  double most_rms_;
  ShapeDescent& descent_;
};

}  // namespace flexura
