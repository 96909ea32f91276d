#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/equipment/rig_equipment.h"
#include "flexura/kinematics/curves.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive_config.h"
#include "flexura/model/obstacle.h"
#include "flexura/model/stand.h"
#include "flexura/rig/seeing_config.h"
#include "flexura/sim/rig_config.h"

namespace flexura {

/// The table [clock]: simulated time.
struct ClockConfig {
  double step = 0.02;  ///< Time between two states of the experiment, s.
};

/// The table [record]: recorded data of a run.
struct RecordConfig {
  std::int64_t every =
      1;  ///< Number of clock steps from one logged state to the next; the last state is always logged.
  bool report = true;                 ///< Whether to write report.html and figures/.
  bool cameras = false;               ///< Whether to log the cameras' images.
  bool scene = true;                  ///< Whether to log the scene, for programs that display it.
  CurveKind curve = CurveKind::arcs;  ///< Curve that is drawn over the arm in the report.
  double tension = 0.5;               ///< Tension of the Catmull-Rom curve.
};

/// The table [truth]: true values of the simulated world that differ from the models in the rest of the file.
/// A file may contain only parts of these tables. The reader copies omitted values from the models.
struct TruthConfig {
  std::optional<ArmConfig> arm;
  std::optional<DriveConfig> drive;
  std::vector<CameraConfig> camera;
  std::optional<StandConfig> stand;
};

/// An experiment file without its tasks: the rig, the clock, the true values and the recorded data.
struct Setup {
  std::string flexura;    ///< Version of Flexura that ran the experiment; written into results.
  std::string title;      ///< Title of the report.
  std::int64_t seed = 1;  ///< Seed of all random numbers of the run; >= 0.
  std::vector<std::string>
      include;  ///< Files to include; the file reader includes these files and leaves this list empty.
  ClockConfig clock;
  RecordConfig record;
  ArmConfig arm;  ///< Model of the arm that the tasks use.
  std::optional<DriveConfig>
      drive;  ///< Drive of the arm; missing: bends follow commands at the rates of the arm.
  std::vector<ObstacleConfig> obstacle;
  StandConfig stand;
  std::vector<CameraConfig> camera;      ///< Cameras; empty: the paper's two cameras (see cameras()).
  std::vector<SeeingConfig> seeing;      ///< What separates the arm from its surroundings, by camera.
  std::vector<BackdropConfig> backdrop;  ///< Pictures behind everything else, by simulated camera.
  std::optional<TruthConfig> truth;  ///< Differences of the simulated world from the model; missing: none.
  std::optional<RigEquipment>
      equipment;  ///< Real equipment that executes the experiment; missing: the experiment is simulated.
  std::filesystem::path folder;  ///< Folder of the experiment file; not a field of the file.

  /// Returns the arm model. Throws InputError for an elastic arm without an equilibrium.
  [[nodiscard]] ArmModel arm_model() const;
  /// Returns the model of the rig.
  [[nodiscard]] RigConfig model_rig() const;
  /// Returns the true rig.
  [[nodiscard]] RigConfig true_rig() const;
  /// Returns the true surroundings. The positions of default screens follow from the arm model, not from the
  /// true arm.
  [[nodiscard]] StandConfig true_stand() const;

  /// Returns the cameras of the file, or the paper's two cameras if the file has none. The paper's cameras
  /// are at the distances in [stand], or at distances from which they see the arm's whole reach. The
  /// resolution of a VISCA head is at least one count of the equipment's head.
  [[nodiscard]] std::vector<CameraConfig> cameras() const;

 private:
  [[nodiscard]] std::vector<CameraConfig> modelled_cameras() const;
};

const std::vector<std::string>& names_of(const CurveKind*);
const Table<ClockConfig>& fields_of(const ClockConfig*);
const Table<RecordConfig>& fields_of(const RecordConfig*);
const Table<TruthConfig>& fields_of(const TruthConfig*);

/// Reports inconsistencies of the setup to `reader`.
void check_setup(const Setup& setup, Reader& reader);

}  // namespace flexura
