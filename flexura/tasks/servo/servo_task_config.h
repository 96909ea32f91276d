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

/// A target shape of a servo, given in one of several ways.
struct ServoTargetConfig : ShapeConfig {
  double time = 0;  ///< Time from the task's start, s.
  /// Tip position p_WT, m; the shape follows by inverse kinematics.
  std::optional<std::array<double, 3>> position;
  /// Points of the whole backbone in the world frame, m.
  std::optional<std::vector<std::array<double, 3>>> curve;
  /// Direction angles of the arm at equal fractions of its length, rad.
  std::optional<std::vector<double>> azimuths, elevations;
  std::vector<std::string> pictures;  ///< Two picture files, in the order of the task's cameras.
};

/// `kind = "servo"`: two cameras control the arm until it reaches the target shape. The fields added to the
/// settings need the arm, the cameras and the file's folder for interpretation.
struct ServoTask : ServoSettings {
  std::string name;
  std::vector<std::string> cameras;       ///< Two names; empty: the first two cameras.
  std::vector<ServoTargetConfig> target;  ///< At least one target.
  std::optional<double> step;  ///< Time between commands, s; default: one frame of the slower camera.
};

const Table<ServoTargetConfig>& fields_of(const ServoTargetConfig*);
const Table<ServoTask>& fields_of(const ServoTask*);

/// Returns the indices among `cameras` of the two cameras of a checked task.
[[nodiscard]] std::array<std::size_t, 2> servo_cameras(const ServoTask& task,
                                                       const std::vector<CameraConfig>& cameras);

/// Returns the settings of a task with these cameras. `hold_after` and `give_up_after` are raised if needed,
/// so that the interval between two pictures of a slow camera does not stop the servo.
[[nodiscard]] ServoSettings servo_settings(const ServoTask& task, const std::vector<CameraConfig>& cameras);

/// Reports why the servo at `path` ("task[2]") is not possible with this setup.
void check_keys(const ServoTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Checks the picture files of the targets; they are read again when needed.
void read_files(ServoTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);
/// Returns the runner of such a task. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ServoTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the table servo.csv: distances of the arm from the target, one row per command.
[[nodiscard]] LogTables log_tables(const ServoTask*);

}  // namespace flexura
