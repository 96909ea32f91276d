#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/source.h"
#include "flexura/camera/camera_config.h"
#include "flexura/log/log_table.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/look.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// A target shape of a servo. Exactly one of the fields below, or the fields of ShapeConfig, specify the
/// shape.
struct ServoTargetConfig : ShapeConfig {
  double time = 0;  ///< Time from the task's start, s.
  /// Tip position p_WT, m. Inverse kinematics computes a shape with this tip position.
  std::optional<std::array<double, 3>> position;
  /// Points along the whole backbone, in W, m.
  std::optional<std::vector<std::array<double, 3>>> curve;
  /// Direction angles of the arm at points evenly spaced along its length, rad.
  std::optional<std::vector<double>> azimuths, elevations;
  std::vector<std::string> pictures;  ///< Two picture files, in the order of the task's cameras.
};

/// `kind = "servo"`: two cameras control the arm until it reaches the target shape. The fields of this struct
/// depend on the arm, the cameras and the file's folder; the fields of ServoSettings do not.
struct ServoTask : ServoSettings {
  std::string name;
  std::vector<std::string> cameras;       ///< Names of two cameras; empty: the first two cameras.
  std::vector<ServoTargetConfig> target;  ///< At least one target.
  std::optional<double> step;  ///< Time between commands, s; default: one frame of the slower camera.
};

const Table<ServoTargetConfig>& fields_of(const ServoTargetConfig*);
const Table<ServoTask>& fields_of(const ServoTask*);

/// Returns the indices among `cameras` of the two cameras of a checked task.
[[nodiscard]] std::array<std::size_t, 2> servo_cameras(const ServoTask& task,
                                                       const std::vector<CameraConfig>& cameras);

/// Returns the settings of a task with these cameras. Increases `hold_after` and `give_up_after` if they are
/// shorter than a slow camera's time between pictures allows.
[[nodiscard]] ServoSettings servo_settings(const ServoTask& task, const std::vector<CameraConfig>& cameras);

/// Reports as errors why the servo at `path` ("task[2]") is not possible with this setup.
void check_keys(const ServoTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Checks the picture files of the targets. The pictures are read again when the task begins.
void read_files(ServoTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);
/// Returns the runner of a servo. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ServoTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the table servo.csv: one row per command, with the distances of the arm from the target.
[[nodiscard]] LogTables log_tables(const ServoTask*);

}  // namespace flexura
