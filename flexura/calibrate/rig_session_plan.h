#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "flexura/calibrate/rig_session.h"
#include "flexura/calibrate/rig_views.h"

namespace flexura {

/// Returns whether a candidate view is similar to an earlier view of one camera. `look`: the earlier pose,
/// with the camera's stance as the first stance. In similar views, the bends agree within 2 degrees, the
/// cameras' poses within 2 degrees and 5 cm, and the sizes within 10 %. Throws std::out_of_range for a view
/// of another arm, or a zoom outside the lens's table.
[[nodiscard]] bool is_like(const RigModel& model, const ViewCandidate& candidate, const ViewCandidate& look);

/// Decides a session's next action from the present estimate. Sends no commands.
class RigSessionPlan {
 public:
  RigSessionPlan(const RigModel& nominal, const RigSessionConfig& config)
      : nominal_(nominal), config_(config) {}

  /// Returns the stance of a camera for the first view: its initial stance; with an etalon, its initial
  /// stance with the shortest focal length.
  [[nodiscard]] RigStance first(const RigStance& begins) const;
  /// Returns the target of the cameras in W, m. Without a configured target, returns the middle of the
  /// etalon. Without an etalon, returns the middle of the arm in the first pose.
  [[nodiscard]] Eigen::Vector3d target(const RigModel& model) const;
  /// Returns the commands for the required configuration. `stances`: present positions.
  [[nodiscard]] DesiredRig desired(const RigModel& model, const std::array<RigStance, 2>& stands) const;
  /// Adds the estimates for the required configuration to `step`.
  void know(const RigVariables& variables, const RigCalibration& found, const DesiredRig& desired,
            RigStep& step) const;
  /// Returns the next view from the present positions, and its expected result in words. Excludes views that
  /// are similar to one in `missed`, the earlier views of one camera that showed too little.
  [[nodiscard]] std::pair<std::optional<ViewCandidate>, std::string> next(
      const RigProblem& problem, const RigCalibration& found, const DesiredRig& desired,
      const std::array<RigStance, 2>& stands, const std::vector<ViewCandidate>& missed) const;
  /// Returns an error if the required configuration is not acceptable: both cameras would look from about the
  /// same direction, or would not see the arm. Returns no error while the angle between the axes is unknown.
  [[nodiscard]] RigCommander::Error error_with(const RigModel& model, const DesiredRig& desired,
                                               const RigStep& step, const ArmState& home) const;
  /// Returns the changes of pan and tilt, rad, from the head's present position for the search for the arm.
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
