#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "flexura/calibrate/rig_session.h"
#include "flexura/calibrate/rig_views.h"

namespace flexura {

/// Whether a camera would see in a candidate much the same as in a look of its own, the first of `look`'s
/// stances: the arm bent like then within 2 degrees, from within 2 degrees and 5 cm of there, as large within
/// a tenth. std::out_of_range: another arm's look, or a zoom outside the lens's table.
[[nodiscard]] bool is_like(const RigModel& model, const ViewCandidate& candidate, const ViewCandidate& look);

/// What a session decides by what it knows; it moves nothing.
class RigSessionPlan {
 public:
  RigSessionPlan(const RigModel& believed, const RigSessionConfig& config)
      : believed_(believed), config_(config) {}

  /// From where a camera that begins there looks first: at an etalon with the shortest focal length.
  [[nodiscard]] RigStance first(const RigStance& begins) const;
  /// What the cameras shall look at: the etalon's middle, or that of the first pose, if nothing else was
  /// asked for. In W, m.
  [[nodiscard]] Eigen::Vector3d target(const RigModel& model) const;
  /// Where to send the cameras from where they stand.
  [[nodiscard]] WantedRig wanted(const RigModel& model, const std::array<RigStance, 2>& stands) const;
  /// Fills in what is known of the wanted configuration.
  void know(const RigVariables& variables, const RigCalibration& found, const WantedRig& wanted,
            RigStep& step) const;
  /// The next look from where the cameras stand, and what is hoped from it, in words. None that is much like
  /// one of those `missed`, each of one camera, at which too little was seen.
  [[nodiscard]] std::pair<std::optional<ViewCandidate>, std::string> next(
      const RigProblem& problem, const RigCalibration& found, const WantedRig& wanted,
      const std::array<RigStance, 2>& stands, const std::vector<ViewCandidate>& missed) const;
  /// Why the wanted configuration is none: both cameras look from one side, or would not see the arm. Nothing
  /// is said before the angle is known.
  [[nodiscard]] RigHands::Trouble trouble_with(const RigModel& model, const WantedRig& wanted,
                                               const RigStep& step, const ArmState& home) const;
  /// By how much to turn a head from where it stands to look for the arm, pan and tilt, rad.
  [[nodiscard]] std::vector<Eigen::Vector2d> search_ways() const;

 private:
  [[nodiscard]] std::vector<ViewGoal> goals(const RigVariables& variables, const RigCalibration& found,
                                            const WantedRig& wanted) const;
  [[nodiscard]] ViewGrid grid(const RigModel& model) const;
  // Three zooms: ratios of focal length, and shares of half the image beside its middle.
  [[nodiscard]] std::array<std::array<double, 2>, 3> etalon_zooms(const RigModel& model,
                                                                  std::size_t camera) const;
  [[nodiscard]] bool is_in_view(const RigModel& model, const RigStance& stance, const ArmState& shown) const;

  const RigModel& believed_;
  const RigSessionConfig& config_;
};

}  // namespace flexura
