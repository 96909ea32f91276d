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

/// A shape that a servo is to reach, said in one of several ways.
struct ServoTargetConfig : ShapeConfig {
  double time = 0;                                          ///< s from the task's start.
  std::optional<std::array<double, 3>> position;            ///< p_WT, m; the shape by inverse kinematics.
  std::optional<std::vector<std::array<double, 3>>> curve;  ///< Points of the whole backbone, W, m.
  std::optional<std::vector<double>> azimuths, elevations;  ///< Of its direction at equal shares, rad.
  std::vector<std::string> pictures;  ///< Two files, of the task's cameras in this order.
};

/// `kind = "servo"`: the arm is steered by two cameras until its shape is the wanted one. Beside the settings
/// there is what needs the arm, the cameras and the file's folder to be understood.
struct ServoTask : ServoSettings {
  std::string name;
  std::vector<std::string> cameras;       ///< Two names; empty: the first two.
  std::vector<ServoTargetConfig> target;  ///< At least one.
  std::optional<double> step;             ///< s; a frame of the slower camera.
};

const Table<ServoTargetConfig>& fields_of(const ServoTargetConfig*);
const Table<ServoTask>& fields_of(const ServoTask*);

/// The two cameras of a task that was checked: places among `cameras`.
[[nodiscard]] std::array<std::size_t, 2> servo_cameras(const ServoTask& task,
                                                       const std::vector<CameraConfig>& cameras);

/// Those of a task that names two of these cameras: between two pictures of a slow one nobody is blind.
[[nodiscard]] ServoSettings servo_settings(const ServoTask& task, const std::vector<CameraConfig>& cameras);

/// Reports what keeps the servo at `path` ("task[2]") from being tried with this setup.
void check_keys(const ServoTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Looks at its targets' pictures, which are read again when they are wanted.
void read_files(ServoTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);
/// What does such a task. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ServoTask& task, const Setup& setup,
                                                    TaskLabel label);
/// servo.csv: how far the arm was from what is wanted, a row a command.
[[nodiscard]] LogTables log_tables(const ServoTask*);

}  // namespace flexura
