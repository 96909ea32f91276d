#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/estimate/shape_fit.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"
#include "flexura/estimate/sighting_pair.h"

namespace flexura {

/// The first view that would have to be wrong by far more than it is doubted, if there is one.
[[nodiscard]] std::optional<std::size_t> view_elsewhere(std::span<const Sighting> sightings,
                                                        const Shape& shape);

/// The first section that is bent farther than it goes, by more than pictures may be wrong, if there is one.
[[nodiscard]] std::optional<std::size_t> bent_too_far(const Shape& shape);

/// Looks for the shape that sightings show, when nothing tells where it is: shapes are tried one after
/// another until one explains what is seen (docs/estimation.md, The start). Where none does by cameras as
/// they are doubted, but one by cameras that stand otherwise, it is that one.
class ShapeSearch {
 public:
  /// `most_iterations` of each descent; `most_rms`: of a good fit (ShapeFit::is_good), px.
  ShapeSearch(const ShapePrior& prior, int most_iterations, double most_rms, ShapeDescent& descent)
      : prior_(prior), most_iterations_(most_iterations), most_rms_(most_rms), descent_(descent) {}

  /// The best that was found, and the sightings in the order of the arm that goes with it.
  struct Result {
    ShapeFit fit;
    std::vector<Sighting> seen;
    /// Where an end is not seen where the shape has it, and nothing else tells: how far another shape that
    /// explains all as well is from it, m; 0: there is none.
    double apart = 0;
  };
  /// At least one sighting. Where the base is unknown the first is followed as it is, the others either way.
  [[nodiscard]] Result best(const std::vector<Sighting>& sightings);

 private:
  struct Try {
    ShapeFit fit;
    double merit = 0;        // What speaks against it, px^2.
    double unexplained = 0;  // Of points and borders, beyond the distances of those that are believed, px^2.
    double misfit = 0;       // px^2
    double ends = 0;         // How far off ends are seen, px^2.
    bool is_as_doubted = false;
    bool is_possible = true;  // No section is bent farther than it goes.
  };
  struct Start {
    Shape shape;
    StartKind kind = StartKind::far;
  };
  // Of one whose merit is no less than `most` without it the misfit is not looked at.
  [[nodiscard]] Try tried(ShapeProblem& problem, const Start& start, double most);
  [[nodiscard]] static bool is_better(const Try& one, const Try& other);
  [[nodiscard]] bool is_explained(const Try& one) const;
  [[nodiscard]] bool leaves_much(const Try& one) const;
  [[nodiscard]] double apart(const Result& found);
  // From what the pair tells.
  [[nodiscard]] std::vector<Shape> starts(std::span<const Sighting> sightings,
                                          const SightingPair& pair) const;
  // Shapes that one of the cameras would see alike, or whose last section is bent otherwise.
  [[nodiscard]] std::vector<Start> look_alikes(std::span<const Sighting> sightings, const Shape& shape) const;

  const ShapePrior& prior_;
  int most_iterations_;
  double most_rms_;
  ShapeDescent& descent_;
};

}  // namespace flexura
