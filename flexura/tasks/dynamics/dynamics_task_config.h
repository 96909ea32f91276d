#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/control/angle_measurement.h"
#include "flexura/control/angle_shapes.h"
#include "flexura/control/potential_law.h"
#include "flexura/control/section_drives.h"
#include "flexura/log/log_table.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// Target shape of the law, given by bends or by the two angles of the arm's direction.
struct DynamicsTargetConfig : ShapeConfig {
  /// Angles theta and q at points evenly spaced along the arm, rad.
  std::optional<std::vector<double>> azimuths, elevations;
};

/// Gains of the artificial potential (PotentialGains). Values that violate a condition of the theory are
/// accepted, so that a run can show their effect.
struct PotentialConfig {
  std::array<double, 2> stiffness = {20, 20};                         ///< Stiffnesses k of theta and q.
  std::array<std::array<double, 2>, 2> damping = {{{4, 0}, {0, 4}}};  ///< Damping matrix K.
  double length_stiffness = 200;    ///< Stiffness k_u of variable lengths, N/m.
  double length_damping = 40;       ///< Damping of variable lengths, N s/m.
  double gravity_compensation = 1;  ///< Compensated fraction of dV_g/dx.
  ElasticityRule elasticity = ElasticityRule::cancelled;
  DriveKind drives = DriveKind::everywhere;
  std::int64_t sign = 1;  ///< Sign of the potential's force: 1, or -1 to lead away from the target.
};

/// Measurement of the angles that the law uses, if they are not exact (AngleMeasurement).
struct MeasurementConfig {
  AngleReading reading = AngleReading::angles;
  double delay = 0;            ///< Delay of each measurement, s.
  double noise = 0;            ///< Standard deviation of each angle's noise, rad.
  std::optional<double> step;  ///< Interval between measurements, s; default: the clock's step.
};

/// `kind = "dynamics"`: the arm is a continuum with mass, weight and elasticity (DistributedArm). The arm
/// starts at rest in its current shape and moves under the forces of `law` (docs/control.md).
struct DynamicsTask {
  std::string name;
  double duration = 5;  ///< Duration, s.
  DynamicsTargetConfig target;
  double density = 1;                             ///< Mass per length, kg/m.
  std::array<double, 3> gravity = {0, -9.81, 0};  ///< Gravity in the world frame, m/s^2.
  double bending_stiffness = 0;                   ///< Bending stiffness EI, N m^2.
  double axial_stiffness = 0;                     ///< Axial stiffness EA, N.
  double damping = 0;                             ///< Damping coefficient c of the medium, N s.
  double length_damping = 0;                      ///< Damping of variable lengths, N s/m.
  bool variable_lengths = false;                  ///< Whether the law also changes the sections' lengths.
  AngleBasis basis = AngleBasis::sections;        ///< Basis of both angles.
  std::int64_t nodes = 6;                         ///< Number of nodes for each angle (polynomial basis).
  PotentialConfig law;
  /// Measurement of the angles; missing: the angles are exact.
  std::optional<MeasurementConfig> measurement;
  double tolerance = 1e-3;  ///< Tolerance for success, as a fraction of the initial Lyapunov function W.
};

const std::vector<std::string>& names_of(const ElasticityRule*);
const std::vector<std::string>& names_of(const AngleBasis*);
const std::vector<std::string>& names_of(const DriveKind*);
const std::vector<std::string>& names_of(const AngleReading*);
const Table<DynamicsTargetConfig>& fields_of(const DynamicsTargetConfig*);
const Table<PotentialConfig>& fields_of(const PotentialConfig*);
const Table<MeasurementConfig>& fields_of(const MeasurementConfig*);
const Table<DynamicsTask>& fields_of(const DynamicsTask*);

/// Reports as errors why the task at `path` ("task[2]") is not possible with this setup.
void check_keys(const DynamicsTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Returns the runner of a task of kind "dynamics". `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const DynamicsTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the table dynamics.csv: one row per sample, with the energies and errors.
[[nodiscard]] LogTables log_tables(const DynamicsTask*);

}  // namespace flexura
