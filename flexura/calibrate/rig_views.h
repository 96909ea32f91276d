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

/// What could be looked at next: the arm commanded into a pose, and one picture from each of these stances.
struct ViewCandidate {
  ArmState pose;
  std::vector<RigStance> stances;
};

/// What a picture shows of an arm that is in view, or of the problem's etalon.
struct ViewConfig {
  std::size_t markers = 9;  ///< Evenly along the arm, from base to tip.
  std::size_t points = 20;  ///< Of the axis, between them.
  double sigma = 0.2;       ///< Of each, px.
  double margin = 20;       ///< What is nearer to the border than this may be outside, px.
  std::size_t fewest = 5;   ///< Markers in view; a picture with fewer is no candidate.
};

/// What is to be known well: numbers that follow from a rig's variables, and how well.
struct ViewGoal {
  RigQuantity quantity;
  double wanted = 1;  ///< Standard deviation that would do, in the quantity's unit; > 0.
};

struct ViewChoice {
  std::size_t candidate = 0;
  double after = 0;            ///< Sum of the goals' variances with it, in units of the wanted ones.
  std::vector<double> sigmas;  ///< Of the goals, with it.
};

/// The candidate whose pictures will make the goals most certain, of equals the first; none when the arm is
/// in view of none. The goals' quantities are of the calibrated problem's variables.
[[nodiscard]] std::optional<ViewChoice> next_best_view(const RigProblem& problem, const RigCalibration& found,
                                                       std::span<const ViewCandidate> candidates,
                                                       std::span<const ViewGoal> goals,
                                                       const ViewConfig& config = {});

/// Where to look for candidates.
struct ViewGrid {
  std::vector<ArmState> poses;
  std::vector<double> zooms = {1};  ///< Ratios; each camera goes to where its own lens has them.
  std::vector<Eigen::Vector3d> slides = {Eigen::Vector3d::Zero()};  ///< Of each camera's stage, m.
  /// What is looked at, the arm's middle when left out, is brought to the image's middle, and so far from
  /// there towards its four corners; share of half the image.
  double spread = 0.4;
  std::optional<Eigen::Vector3d> target = {};
  /// For a camera and one of the zooms its own ratio and spread, where these differ.
  std::function<std::array<double, 2>(std::size_t camera, double zoom)> own = {};
};

/// A stance of camera `number` from which a point of W is seen at this place of the image, in shares of half
/// its width and height to the right and down of the middle: with the stage slid so far and a focal length of
/// this ratio, within the limits of head and stage, in positions that can be commanded.
[[nodiscard]] RigStance looking_at(const RigModel& model, std::size_t number, const Eigen::Vector3d& slide,
                                   double ratio, const Eigen::Vector3d& target, const Eigen::Vector2d& place);

/// All of a grid's, every camera doing the same: within the limits of heads and stages, in positions that can
/// be commanded.
[[nodiscard]] std::vector<ViewCandidate> view_candidates(const RigModel& model, const ViewGrid& grid);

}  // namespace flexura
