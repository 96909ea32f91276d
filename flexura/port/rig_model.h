#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/camera/camera_config.h"
#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/camera/view.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// An arm and its cameras: the nominal model, or an estimate of it. The world frame is fixed to the arm's
/// base (docs/calibration.md, "Gauge").
struct RigModel {
  Arm arm;                         ///< One section per arc of its shapes.
  std::vector<double> bend_gains;  ///< Factor on each arc's bend; empty: all 1.
  std::vector<CameraConfig> cameras;
  Arm driven = {};           ///< Arm as its drives see it, if one of its sections is several arcs.
  Actuation actuation = {};  ///< Arcs of the sections of `driven`; otherwise commands are shapes.

  /// Returns the number of sections of a command.
  [[nodiscard]] std::size_t sections() const;
  /// Returns the arm's shape after a command, by the model. Throws std::invalid_argument if the command is of
  /// another arm, std::out_of_range if it has fewer sections than there are gains.
  [[nodiscard]] ArmState bent(const ArmState& command) const;
  /// Returns the arm model with the gains as one actuation if a section is several arcs; otherwise without
  /// the gains.
  [[nodiscard]] ArmModel arm_model() const;
};

/// Returns the model of this arm and these cameras without corrections.
[[nodiscard]] RigModel rig_model(const ArmModel& arm, const std::vector<CameraConfig>& cameras);
/// Returns the model, without corrections, of an arm whose sections are single arcs.
[[nodiscard]] inline RigModel rig_model(const Arm& driven, const std::vector<CameraConfig>& cameras) {
  return rig_model(ArmModel(driven), cameras);
}

/// Axis positions of one camera, as its head and stage report.
struct RigStance {
  std::size_t camera = 0;  ///< Index in RigModel::cameras.
  HeadState head = {};
  StageState stage = {};
  /// Index of an earlier RigStance of the observations since which the camera has neither panned nor tilted;
  /// it may have zoomed or slid. The error of the head's angles is then equal.
  std::optional<std::size_t> turned_as = {};

  /// Returns the axis positions without the camera's index.
  [[nodiscard]] CameraStance stance() const { return {head, stage}; }
};

/// Returns the view of a camera of the model with these readings. Throws std::out_of_range if the model lacks
/// the camera or its zoom is outside the lens's table.
[[nodiscard]] View view_of(const RigModel& model, const RigStance& stance);

}  // namespace flexura
