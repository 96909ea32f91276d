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

/// Model of a rig, which is an arm and its cameras. The model is nominal or estimated by calibration. The
/// world frame is fixed to the arm's base (docs/calibration.md, "Gauge").
struct RigModel {
  Arm arm;                         ///< Arm with one section per arc.
  std::vector<double> bend_gains;  ///< Factor on each arc's bend; empty: all 1.
  std::vector<CameraConfig> cameras;
  /// If any section has several arcs: the arm in terms of the sections that the drives bend. If every section
  /// is a single arc: an arm without sections.
  Arm driven = {};
  /// Conversion of commands to shapes, if any section has several arcs; otherwise the identity.
  Actuation actuation = {};

  /// Returns the number of sections of a command.
  [[nodiscard]] std::size_t sections() const;
  /// Returns the shape that the model predicts for a command. Throws std::invalid_argument if the command
  /// does not fit the arm, and std::out_of_range if the command has fewer sections than there are gains.
  [[nodiscard]] ArmState bent(const ArmState& command) const;
  /// Returns the model of the arm. If any section has several arcs, its actuation includes the bend gains;
  /// otherwise the gains are omitted.
  [[nodiscard]] ArmModel arm_model() const;
};

/// Returns the nominal model of an arm and its cameras, without calibrated corrections.
[[nodiscard]] RigModel rig_model(const ArmModel& arm, const std::vector<CameraConfig>& cameras);
/// Returns the nominal model of an arm whose sections are single arcs, and its cameras.
[[nodiscard]] inline RigModel rig_model(const Arm& driven, const std::vector<CameraConfig>& cameras) {
  return rig_model(ArmModel(driven), cameras);
}

/// Stance of a camera: the axis positions that its head and its stage report at one time.
struct RigStance {
  std::size_t camera = 0;  ///< Index in RigModel::cameras.
  HeadState head = {};
  StageState stage = {};
  /// Index of an earlier RigStance of the observations, if the camera has neither panned nor tilted since the
  /// earlier stance. Both stances then have equal errors of the head's angles. Zoom and stage may have moved.
  std::optional<std::size_t> turned_as = {};

  /// Returns the axis positions without the camera's index.
  [[nodiscard]] CameraStance stance() const { return {head, stage}; }
};

/// Returns the view of a camera at the given axis positions, according to the model. Throws std::out_of_range
/// if the model has no such camera, or the zoom is outside the lens's table.
[[nodiscard]] View view_of(const RigModel& model, const RigStance& stance);

}  // namespace flexura
