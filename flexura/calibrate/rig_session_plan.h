#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "flexura/calibrate/rig_session.h"
#include "flexura/calibrate/rig_views.h"

namespace flexura {

/// Returns whether a candidate would show a camera almost the same as an earlier look. `look`: the earlier
/// pose, with the camera's stance as the first one. The bends must agree within 2 degrees, the views within 2
/// degrees and 5 cm, and the sizes within a tenth. Throws std::out_of_range for a look at another arm, or a
/// zoom outside the lens's table.
[[nodiscard]] bool is_like(const RigModel& model, const ViewCandidate& candidate, const ViewCandidate& look);

/// Decides a session's next action from the present estimate. Sends no commands.
class RigSessionPlan {
 public:
  RigSessionPlan(const RigModel& nominal, const RigSessionConfig& config)
      : nominal_(nominal), config_(config) {}

  /// Returns the stance of a camera for the first look: its initial stance, but with the shortest focal
  /// length for an etalon.
  [[nodiscard]] RigStance first(const RigStance& begins) const;
  /// Returns the target of the cameras in W, m. It is the configured target, else the middle of the etalon,
  /// else the middle of the arm in the first pose.
  [[nodiscard]] Eigen::Vector3d target(const RigModel& model) const;
  /// Returns the positions to command for the required configuration, from the present positions.
  [[nodiscard]] DesiredRig desired(const RigModel& model, const std::array<RigStance, 2>& stands) const;
  /// Fills in the estimates for the required configuration.
  void know(const RigVariables& variables, const RigCalibration& found, const DesiredRig& desired,
            RigStep& step) const;
  /// Returns the next look from the present positions, and its expected result in words. Excludes looks that
  /// are similar to one in `missed`: earlier looks, each of one camera, that showed too little.
  [[nodiscard]] std::pair<std::optional<ViewCandidate>, std::string> next(
      const RigProblem& problem, const RigCalibration& found, const DesiredRig& desired,
      const std::array<RigStance, 2>& stands, const std::vector<ViewCandidate>& missed) const;
  /// Returns why the required configuration is not acceptable, if so: both cameras look from about the same
  /// direction, or would not see the arm. No error as long as the angle between the axes is not known.
  [[nodiscard]] RigCommander::Error error_with(const RigModel& model, const DesiredRig& desired,
                                               const RigStep& step, const ArmState& home) const;
  /// Returns the turns of the head from its present position for the search of the arm: pan and tilt, rad.
  [[nodiscard]] std::vector<Eigen::Vector2d> search_directions() const;

 private:
  [[nodiscard]] std::vector<ViewGoal> goals(const RigVariables& variables, const RigCalibration& found,
                                            const DesiredRig& desired) const;
  [[nodiscard]] ViewGrid grid(const RigModel& model) const;
  // Returns three zooms: the ratio of focal lengths, and the target's distance from the image's middle as a
  // share of half the image.
  [[nodiscard]] std::array<std::array<double, 2>, 3> etalon_zooms(const RigModel& model,
                                                                  std::size_t camera) const;
  [[nodiscard]] bool is_in_view(const RigModel& model, const RigStance& stance, const ArmState& shown) const;

  const RigModel& nominal_;
  const RigSessionConfig& config_;
};

}  // namespace flexura
