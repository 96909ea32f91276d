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

/// The table [clock]: how time runs.
struct ClockConfig {
  double step = 0.02;  ///< s between two states of the experiment.
};

/// The table [record]: what is kept of a run.
struct RecordConfig {
  std::int64_t every = 1;  ///< Steps from one state in the log to the next; the last one is always kept.
  bool report = true;      ///< Write report.html and figures/.
  bool cameras = false;    ///< Keep the cameras' images in the log.
  bool scene = true;       ///< Keep in the log what stands there, for programs that draw it.
  CurveKind curve = CurveKind::arcs;  ///< Drawn over the arm in the report.
  double tension = 0.5;               ///< Of the Catmull-Rom curve.
};

/// The table [truth]: where the simulated world differs from what the rest of the file believes. What it
/// leaves out is as believed; a file may write parts of these tables, which the reader completes.
struct TruthConfig {
  std::optional<ArmConfig> arm;
  std::optional<DriveConfig> drive;
  std::vector<CameraConfig> camera;
  std::optional<StandConfig> stand;
};

/// All of an experiment file but its tasks: the rig, how time runs, what is true and what is kept.
struct Setup {
  std::string flexura;               ///< Version that ran it; written into results.
  std::string title;                 ///< For the report.
  std::int64_t seed = 1;             ///< Of every random number of the run; from 0 on.
  std::vector<std::string> include;  ///< Resolved by the file reader; empty from then on.
  ClockConfig clock;
  RecordConfig record;
  ArmConfig arm;                     ///< As tasks believe it to be.
  std::optional<DriveConfig> drive;  ///< None: bends follow commands as their own rates allow.
  std::vector<ObstacleConfig> obstacle;
  StandConfig stand;
  std::vector<CameraConfig> camera;  ///< None: the paper's two (cameras()).
  std::optional<TruthConfig> truth;  ///< None: the world is as it is believed to be.
  std::filesystem::path folder;      ///< In which the file is; not a part of it.

  /// The arm as tasks believe it to be. InputError: an elastic arm that comes to no rest.
  [[nodiscard]] ArmModel arm_model() const;
  /// The rig as tasks believe it to be, and as it is.
  [[nodiscard]] RigConfig model_rig() const;
  [[nodiscard]] RigConfig true_rig() const;
  /// What stands around it as it is; its screens are where the believed arm has them, if nothing else is
  /// said.
  [[nodiscard]] StandConfig true_stand() const;

  /// The file's cameras, or the paper's two, at the stand's distances or with all of the arm's reach in view.
  [[nodiscard]] std::vector<CameraConfig> cameras() const;
};

const std::vector<std::string>& names_of(const CurveKind*);
const Table<ClockConfig>& fields_of(const ClockConfig*);
const Table<RecordConfig>& fields_of(const RecordConfig*);
const Table<TruthConfig>& fields_of(const TruthConfig*);

/// Reports what of the setup does not fit together.
void check_setup(const Setup& setup, Reader& reader);

}  // namespace flexura
