#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/image.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/rig_session.h"
#include "flexura/camera/view.h"
#include "flexura/model/stand.h"

namespace flexura {

/// The paper's two calibration methods (section 3.4), each exactly as printed in the paper and in a corrected
/// version.
enum class LoopMethod {
  etalon,        ///< With the calibration cylinder: subpixel measurement of borders, and steps that shrink.
  etalon_paper,  ///< With the cylinder as printed: counted pixels, and steps of equal size.
  arcs,          ///< With the simulator: both cameras observe arcs of the arm and its markers in two planes.
  /// With the simulator as printed: each camera observes one arc and tests whether its image is part of a
  /// circle.
  arcs_paper,
};

/// Settings of a calibration loop and prior knowledge of the rig.
struct LoopConfig {
  LoopMethod method = LoopMethod::etalon;
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Indices of the front and the side camera in the rig.
  std::size_t images = 60;                      ///< Maximum number of pictures per camera.
  double accepted = 0.05;                       ///< Tolerance of each offset measured in a picture, px.
  /// Tolerance of the relative difference of the target's sizes in the two pictures.
  double zoom_accepted = 0.001;
  double turn = 0.2 * degree;  ///< Size of each turn of a head, rad; only for `etalon_paper`.
  double slide = 0.005;        ///< Size of each stage step, m; only for `etalon_paper`.
  double zoom_step = 0.02;     ///< Relative change of the zoom per step; only for `etalon_paper`.
  EtalonConfig etalon;         ///< Position and size of the cylinder.
  /// Angle by which the arm is bent into an arc, rad. If it exceeds pi/2, the arm occludes itself for a
  /// camera in the arc's plane.
  double arc = 90 * degree;
  ArmPictureConfig picture;       ///< Known properties of the arm's pictures, including its markers.
  std::optional<RigPrior> prior;  ///< Prior of the rig for `arcs`; default: rough_prior().
  /// Renders the simulator's gray picture of the arm in a state: the ideal image.
  std::function<Image<std::uint8_t>(const View&, const ArmState&)> draw;
  double move_duration = 2;  ///< Duration of a move of the arm to a shape or back, s.
  RigPatience patience;
};

/// Result of a loop.
struct LoopResult {
  bool is_done = false;
  std::string reason;                                ///< Why the loop failed, and the final state of the rig.
  std::vector<LoopDecision> steps;                   ///< Decisions, in order.
  std::array<std::size_t, 2> pictures = {0, 0};      ///< Number of pictures by camera.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of the cameras in W, m.
  std::array<RigStance, 2> start, stances;           ///< Measured positions at the start and at the end.
  std::array<std::optional<double>, 2>
      roll;  ///< Observed roll of each camera, rad; no head can correct a roll.
  /// Observed offset of each principal point from the model's, to the right and downwards, px.
  std::array<std::optional<Eigen::Vector2d>, 2> principal_point;
  std::optional<double> angle;  ///< Observed angle between the axes minus 90 degrees, rad.
  std::optional<double>
      zoom_ratio;  ///< Observed size of the target in the first camera relative to the second camera.
  std::vector<std::string> notes;  ///< Further messages for the user.
  std::array<std::optional<CameraObservation>, 2> before,
      after;  ///< Observations in the first and the last picture of each camera.
};

/// Calibrates two cameras by a loop that takes pictures, measures, decides and moves
/// (docs/calibration-paper.md). The session uses only the ports. `nominal` has the ranges and resolutions of
/// heads, stages and lenses, and the focal lengths. The loop fails after an error, and if it diverges or
/// oscillates. Heads, stages and arm then return to the start, and the result states the reason. Equal rigs,
/// readings and pictures give equal results. Throws std::invalid_argument if the ports do not have the
/// cameras of the model, or if both cameras are the same.
[[nodiscard]] LoopResult calibrate_by_loop(const RigPorts& ports, const RigModel& nominal,
                                           const LoopConfig& config, RigSessionWatcher& watcher);

}  // namespace flexura
