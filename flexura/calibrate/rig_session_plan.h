#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "flexura/calibrate/rig_session.h"
#include "flexura/calibrate/rig_views.h"

namespace flexura {

/// Returns whether a camera would see almost the same in a candidate as in an earlier look, given by the
/// first of `look`'s stances. The arm is bent alike within 2 degrees, the view within 2 degrees and 5 cm, the
/// size within a tenth. Throws std::out_of_range for a look at another arm, or a zoom outside the lens's
/// table.
[[nodiscard]] bool is_like(const RigModel& model, const ViewCandidate& candidate, const ViewCandidate& look);

/// Decides a session's next action from its present knowledge; moves nothing.
class RigSessionPlan {
 public:
  RigSessionPlan(const RigModel& nominal, const RigSessionConfig& config)
      : nominal_(nominal), config_(config) {}

  /// Returns the first viewpoint of a camera from its initial one: for an etalon, with the shortest focal
  /// length.
  [[nodiscard]] RigStance first(const RigStance& begins) const;
  /// Returns the target of the cameras in W, m: the configured one, else the etalon's middle, else that of
  /// the first pose.
  [[nodiscard]] Eigen::Vector3d target(const RigModel& model) const;
  /// Returns the positions to command from the present ones.
  [[nodiscard]] DesiredRig desired(const RigModel& model, const std::array<RigStance, 2>& stands) const;
  /// Fills in what is known about the wanted configuration.
  void know(const RigVariables& variables, const RigCalibration& found, const DesiredRig& desired,
            RigStep& step) const;
  /// Returns the next look from the present positions and its expected result in words. Excludes looks
  /// similar to one in `missed`, each of one camera, at which too little was visible.
  [[nodiscard]] std::pair<std::optional<ViewCandidate>, std::string> next(
      const RigProblem& problem, const RigCalibration& found, const DesiredRig& desired,
      const std::array<RigStance, 2>& stands, const std::vector<ViewCandidate>& missed) const;
  /// Returns why the wanted configuration is not acceptable: both cameras look from about one side, or would
  /// not see the arm. No error as long as the angle is not known.
  [[nodiscard]] RigCommander::Error error_with(const RigModel& model, const DesiredRig& desired,
                                               const RigStep& step, const ArmState& home) const;
  /// Returns head turns from the present position for the search of the arm: pan and tilt, rad.
  [[nodiscard]] std::vector<Eigen::Vector2d> search_directions() const;

 private:
  [[nodiscard]] std::vector<ViewGoal> goals(const RigVariables& variables, const RigCalibration& found,
                                            const DesiredRig& desired) const;
  [[nodiscard]] ViewGrid grid(const RigModel& model) const;
  // Three zooms: ratio of focal length, and share of half the image beside its middle.
  [[nodiscard]] std::array<std::array<double, 2>, 3> etalon_zooms(const RigModel& model,
                                                                  std::size_t camera) const;
  [[nodiscard]] bool is_in_view(const RigModel& model, const RigStance& stance, const ArmState& shown) const;

  const RigModel& nominal_;
  const RigSessionConfig& config_;
};

}  // namespace flexura
