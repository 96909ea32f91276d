#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/kinematics/curves.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive_config.h"
#include "flexura/model/obstacle.h"
#include "flexura/model/stand.h"
#include "flexura/sim/rig_config.h"

namespace flexura {

/// The table [clock]: simulated time.
struct ClockConfig {
  double step = 0.02;  ///< Time between two states of the experiment, s.
};

/// The table [record]: recorded data of a run.
struct RecordConfig {
  std::int64_t every = 1;             ///< Steps between states in the log; the last one is always logged.
  bool report = true;                 ///< Write report.html and figures/.
  bool cameras = false;               ///< Log the cameras' images.
  bool scene = true;                  ///< Log the scene, for programs that draw it.
  CurveKind curve = CurveKind::arcs;  ///< Drawn over the arm in the report.
  double tension = 0.5;               ///< Of the Catmull-Rom curve.
};

/// The table [truth]: differences of the simulated world from the model in the rest of the file. Omitted
/// values equal the model's; a file may write parts of these tables, which the reader completes.
struct TruthConfig {
  std::optional<ArmConfig> arm;
  std::optional<DriveConfig> drive;
  std::vector<CameraConfig> camera;
  std::optional<StandConfig> stand;
};

/// An experiment file without its tasks: the rig, the clock, the true values and the recorded data.
struct Setup {
  std::string flexura;               ///< Version that ran it; written into results.
  std::string title;                 ///< For the report.
  std::int64_t seed = 1;             ///< Seed of every random number of the run; from 0 on.
  std::vector<std::string> include;  ///< Resolved by the file reader; empty afterwards.
  ClockConfig clock;
  RecordConfig record;
  ArmConfig arm;                     ///< Model used by the tasks.
  std::optional<DriveConfig> drive;  ///< Missing: bends follow commands at their own rates.
  std::vector<ObstacleConfig> obstacle;
  StandConfig stand;
  std::vector<CameraConfig> camera;  ///< Empty: the paper's two (cameras()).
  std::optional<TruthConfig> truth;  ///< Missing: the world equals the model.
  std::filesystem::path folder;      ///< Folder of the file; not a part of it.

  /// Returns the arm model. Throws InputError for an elastic arm without an equilibrium.
  [[nodiscard]] ArmModel arm_model() const;
  /// Return the model of the rig and the true rig.
  [[nodiscard]] RigConfig model_rig() const;
  [[nodiscard]] RigConfig true_rig() const;
  /// Returns the true surroundings; by default its screens are where the arm model has them.
  [[nodiscard]] StandConfig true_stand() const;

  /// Returns the file's cameras, or the paper's two, at the stand's distances or with the arm's whole reach
  /// in view.
  [[nodiscard]] std::vector<CameraConfig> cameras() const;
};

const std::vector<std::string>& names_of(const CurveKind*);
const Table<ClockConfig>& fields_of(const ClockConfig*);
const Table<RecordConfig>& fields_of(const RecordConfig*);
const Table<TruthConfig>& fields_of(const TruthConfig*);

/// Reports inconsistencies of the setup.
void check_setup(const Setup& setup, Reader& reader);

}  // namespace flexura
