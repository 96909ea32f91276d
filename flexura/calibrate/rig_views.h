#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_quantities.h"

namespace flexura {

/// A possible next look: an arm pose and one picture from each of these stances.
struct ViewCandidate {
  ArmState pose;
  std::vector<RigStance> stances;
};

/// Assumed content of a picture of the visible arm, or of the problem's etalon.
struct ViewConfig {
  std::size_t markers = 9;  ///< Evenly spaced along the arm, from base to tip.
  std::size_t points = 20;  ///< Axis points between them.
  double sigma = 0.2;       ///< Standard deviation of each, px.
  double margin = 20;       ///< Points nearer to the border than this are not counted, px.
  std::size_t fewest = 5;   ///< Fewest markers in view for a picture to be a candidate.
};

/// A quantity of the rig's variables to be determined, and how well.
struct ViewGoal {
  RigQuantity quantity;
  double desired = 1;  ///< Sufficient standard deviation, in the quantity's unit; > 0.
};

struct ViewChoice {
  std::size_t candidate = 0;
  double after = 0;            ///< Sum of the goals' variances with it, in units of the wanted ones.
  std::vector<double> sigmas;  ///< Standard deviations of the goals with it.
};

/// Returns the candidate that will determine the goals best, the first among equals; empty if none shows the
/// arm. The goals' quantities refer to the variables of the calibrated problem.
[[nodiscard]] std::optional<ViewChoice> next_best_view(const RigProblem& problem, const RigCalibration& found,
                                                       std::span<const ViewCandidate> candidates,
                                                       std::span<const ViewGoal> goals,
                                                       const ViewConfig& config = {});

/// Grid of candidates.
struct ViewGrid {
  std::vector<ArmState> poses;
  std::vector<double> zooms = {1};  ///< Ratios; each lens has its own positions for them.
  std::vector<Eigen::Vector3d> slides = {Eigen::Vector3d::Zero()};  ///< Stage offsets of each camera, m.
  /// Offset of the target from the image's middle towards its four corners, as a share of half the image; the
  /// middle itself is also used.
  double spread = 0.4;
  std::optional<Eigen::Vector3d> target = {};
  /// Returns a camera's own ratio and spread for one of the zooms; missing: no difference.
  std::function<std::array<double, 2>(std::size_t camera, double zoom)> own = {};
};

/// Returns a stance of camera `number` that shows a point of W at this place of the image. `place` is in
/// shares of half its width and height, to the right and down from the middle. The stage offset and the ratio
/// of the focal length are given; the result is clamped and quantised.
[[nodiscard]] RigStance looking_at(const RigModel& model, std::size_t number, const Eigen::Vector3d& slide,
                                   double ratio, const Eigen::Vector3d& target, const Eigen::Vector2d& place);

/// Returns all candidates of a grid, clamped and quantised; every camera does the same.
[[nodiscard]] std::vector<ViewCandidate> view_candidates(const RigModel& model, const ViewGrid& grid);

}  // namespace flexura
