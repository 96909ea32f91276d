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

/// An arm and the cameras that look at it: as they are believed to be, or as they were found. The arm's base
/// is where the world is counted from (docs/calibration.md, "Gauge").
struct RigModel {
  Arm arm;                         ///< One section an arc of its shapes.
  std::vector<double> bend_gains;  ///< Factor on each arc's bend; empty: all 1.
  std::vector<CameraConfig> cameras;
  Arm driven = {};           ///< The arm as its drives see it, where a section of it is several arcs,
  Actuation actuation = {};  ///< and what these are; otherwise commands are shapes.

  /// Sections of a command.
  [[nodiscard]] std::size_t sections() const;
  /// The shape in which the arm stands when it is commanded so, as far as the model knows.
  /// std::invalid_argument: of another arm; std::out_of_range: of fewer sections than there are gains.
  [[nodiscard]] ArmState bent(const ArmState& command) const;
  /// The same with what is known of gains as one actuation, of arms whose sections are several arcs; of
  /// others without the gains.
  [[nodiscard]] ArmModel arm_model() const;
};

/// A model of that arm and these cameras, nothing of which is known to be wrong.
[[nodiscard]] RigModel rig_model(const ArmModel& arm, const std::vector<CameraConfig>& cameras);
/// The same of an arm of arcs, as its drives see it.
[[nodiscard]] inline RigModel rig_model(const Arm& driven, const std::vector<CameraConfig>& cameras) {
  return rig_model(ArmModel(driven), cameras);
}

/// A way in which one camera stood, as its head and stage say.
struct RigStance {
  std::size_t camera = 0;  ///< Its place in RigModel::cameras.
  HeadState head = {};
  StageState stage = {};
  /// An earlier stance (of the observations) since which the camera was neither panned nor tilted, though it
  /// may have zoomed or slid: what its head truly stands at, beside what it says, is then the same.
  std::optional<std::size_t> turned_as = {};

  /// Of its camera, by itself.
  [[nodiscard]] CameraStance stance() const { return {head, stage}; }
};

/// What a camera of a model that reads this stance sees. std::out_of_range: a camera that the model has not,
/// a zoom outside its lens's table.
[[nodiscard]] View view_of(const RigModel& model, const RigStance& stance);

}  // namespace flexura
