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

/// The shape that the law leads to: bends, or the two angles of the arm's direction.
struct DynamicsTargetConfig : ShapeConfig {
  std::optional<std::vector<double>> azimuths, elevations;  ///< theta and q at equal shares, rad.
};

/// Numbers of the artificial potential (PotentialGains); those that violate a condition of the theory are
/// taken too, to show what happens then.
struct PotentialConfig {
  std::array<double, 2> stiffness = {20, 20};                         ///< k of theta and q.
  std::array<std::array<double, 2>, 2> damping = {{{4, 0}, {0, 4}}};  ///< K
  double length_stiffness = 200;                                      ///< N/m
  double length_damping = 40;                                         ///< N s/m
  double gravity_compensation = 1;                                    ///< Share of dV_g/dx.
  ElasticityRule elasticity = ElasticityRule::cancelled;
  DriveKind drives = DriveKind::everywhere;
  std::int64_t sign = 1;  ///< Of the potential's force: 1, or -1 to lead away from the target.
};

/// How the law gets to know the angles, when it does not have them exactly (AngleMeasurement).
struct MeasurementConfig {
  AngleReading reading = AngleReading::angles;
  double delay = 0;            ///< s
  double noise = 0;            ///< rad
  std::optional<double> step;  ///< s; the clock's.
};

/// `kind = "dynamics"`: the arm as a continuum with mass, weight and elasticity (DistributedArm) moves from
/// where it is, at rest, by the forces of the paper's law.
struct DynamicsTask {
  std::string name;
  double duration = 5;  ///< s
  DynamicsTargetConfig target;
  double density = 1;                             ///< kg/m
  std::array<double, 3> gravity = {0, -9.81, 0};  ///< m/s^2, W
  double bending_stiffness = 0;                   ///< EI, N m^2
  double axial_stiffness = 0;                     ///< EA, N
  double damping = 0;                             ///< c, N s
  double length_damping = 0;                      ///< N s/m
  bool variable_lengths = false;                  ///< The sections' lengths change by the law too.
  AngleBasis basis = AngleBasis::sections;        ///< Of both angles.
  std::int64_t nodes = 6;                         ///< Numbers of each angle (polynomial basis).
  PotentialConfig law;
  std::optional<MeasurementConfig> measurement;  ///< None: the law has the angles exactly.
  double tolerance = 1e-3;                       ///< Share of W at the start.
};

const std::vector<std::string>& names_of(const ElasticityRule*);
const std::vector<std::string>& names_of(const AngleBasis*);
const std::vector<std::string>& names_of(const DriveKind*);
const std::vector<std::string>& names_of(const AngleReading*);
const Table<DynamicsTargetConfig>& fields_of(const DynamicsTargetConfig*);
const Table<PotentialConfig>& fields_of(const PotentialConfig*);
const Table<MeasurementConfig>& fields_of(const MeasurementConfig*);
const Table<DynamicsTask>& fields_of(const DynamicsTask*);

/// Reports what keeps the task at `path` ("task[2]") from being tried with this setup.
void check_keys(const DynamicsTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// What does such a task. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const DynamicsTask& task, const Setup& setup,
                                                    TaskLabel label);
/// dynamics.csv: energies and errors, a row a sample.
[[nodiscard]] LogTables log_tables(const DynamicsTask*);

}  // namespace flexura
