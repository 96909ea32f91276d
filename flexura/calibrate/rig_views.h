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

/// A possible next view: an arm pose, and one picture from each of these stances.
struct ViewCandidate {
  ArmState pose;
  std::vector<RigStance> stances;
};

/// Assumed observations in a picture that shows the arm or the etalon.
struct ViewConfig {
  std::size_t markers = 9;  ///< Number of markers, evenly spaced along the arm from base to tip.
  std::size_t points = 20;  ///< Number of axis points between the markers.
  double sigma = 0.2;       ///< Standard deviation of each marker and point, px.
  double margin = 20;       ///< Points at a smaller distance from the picture's border are not counted, px.
  std::size_t fewest = 5;   ///< Smallest number of visible markers for which a picture is a candidate.
};

/// A quantity to be determined, with the required accuracy.
struct ViewGoal {
  RigQuantity quantity;
  double desired = 1;  ///< Required standard deviation, in the quantity's unit; > 0.
};

struct ViewChoice {
  std::size_t candidate = 0;
  double after = 0;  ///< Sum of the goals' expected variances with this candidate, each relative to its
                     ///< desired variance.
  std::vector<double> sigmas;  ///< Expected standard deviations of the goals with this candidate.
};

/// Returns the candidate that will determine the goals best; the first one if several are equal. Returns
/// std::nullopt if no candidate shows the arm. The goals' quantities refer to the variables of the calibrated
/// problem.
[[nodiscard]] std::optional<ViewChoice> next_best_view(const RigProblem& problem, const RigCalibration& found,
                                                       std::span<const ViewCandidate> candidates,
                                                       std::span<const ViewGoal> goals,
                                                       const ViewConfig& config = {});

/// Grid of candidates for the next view.
struct ViewGrid {
  std::vector<ArmState> poses;
  std::vector<double> zooms = {1};  ///< Zoom ratios. Each lens has its own positions for these ratios.
  std::vector<Eigen::Vector3d> slides = {Eigen::Vector3d::Zero()};  ///< Stage offsets of each camera, m.
  /// Offset of the target from the image's middle towards each of the four corners, as a share of half the
  /// image. The grid also has candidates with the target in the middle.
  double spread = 0.4;
  std::optional<Eigen::Vector3d> target = {};
  /// Function that returns the ratio and spread of a camera for one of `zooms`. Without it, all cameras use
  /// the zoom itself and `spread`.
  std::function<std::array<double, 2>(std::size_t camera, double zoom)> own = {};
};

/// Returns a stance of camera `number` that shows the point `target` of W at `place` in the image. `place` is
/// in shares of half the image's width and height, to the right and downwards from the image's middle.
/// `slide`: stage offset. `ratio`: ratio of the focal length. The result is clamped and quantised.
[[nodiscard]] RigStance looking_at(const RigModel& model, std::size_t number, const Eigen::Vector3d& slide,
                                   double ratio, const Eigen::Vector3d& target, const Eigen::Vector2d& place);

/// Returns all candidates of a grid, clamped and quantised. Unless `own` is set, all cameras of a candidate
/// have equal zoom ratio, slide and image position of the target.
[[nodiscard]] std::vector<ViewCandidate> view_candidates(const RigModel& model, const ViewGrid& grid);

}  // namespace flexura
