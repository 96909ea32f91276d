#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/source.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm_config.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// Time law of a move (kinematics/profile.h).
enum class MoveLaw { linear, minimum_jerk, trapezoid };

/// Target of a move: a shape, or a tip position for which a shape is computed.
struct MoveTarget : ShapeConfig {
  std::optional<std::array<double, 3>> position;  ///< Tip position p_WT, m.
};

/// `kind = "move"`: the arm moves from its current shape to another. Each section moves on a straight line in
/// bend and stretch. If sections have their own laws and the shape is given by cord angles, each cord angle
/// follows its own law. A tip position is converted to a shape by inverse kinematics from the current shape;
/// if unreachable, to the nearest one.
struct MoveTask {
  std::string name;
  std::optional<double> duration;                ///< s; default: 1. A trapezoid computes its own.
  std::vector<MoveLaw> law = {MoveLaw::linear};  ///< One for all sections, or one for each.
  std::optional<std::vector<double>> max_rate;   ///< rad/s; trapezoid only. One for all, or one for each.
  /// rad/s^2; trapezoid only. One for all, or one for each.
  std::optional<std::vector<double>> max_acceleration;
  MoveTarget to;  ///< Target shape or tip position.
};

/// `kind = "hold"`: the arm keeps its current shape.
struct HoldTask {
  std::string name;
  double duration = 1.0;  ///< s
};

/// `kind = "sine"`: every section oscillates about its current shape.
struct SineTask {
  std::string name;
  double duration = 1.0;              ///< s
  double period = 1.0;                ///< s
  ShapeConfig amplitude;              ///< Amplitude of cord angles, archings or bends; not of stretches.
  std::vector<double> phase = {0.0};  ///< rad; one for all sections, or one for each.
};

/// `kind = "keyframes"`: the arm passes through shapes at given times, from a CSV file or written in the
/// experiment.
struct KeyframesTask {
  std::string name;
  std::string file;  ///< In the experiment's folder; read into columns and rows with the experiment.
  std::vector<std::string>
      columns;  ///< "time", and per section "arching_1", "cord_angle_1_deg", "bend_x_1", ...
  std::vector<std::vector<double>> rows;                ///< Values in the order of the columns.
  Interpolation interpolation = Interpolation::linear;  ///< Between the rows.
};

/// `kind = "expression"`: formulas of t (s in the task), T (its duration) and i (the section's number from
/// 1). One formula for all sections or one for each (kinematics/expression.h).
struct ExpressionTask {
  std::string name;
  double duration = 1.0;                                         ///< s
  std::optional<std::vector<std::string>> cord_angles;           ///< rad
  std::optional<std::vector<std::string>> archings;              ///< rad
  std::optional<std::vector<std::array<std::string, 2>>> bends;  ///< rad
  std::optional<std::vector<std::string>> stretches;             ///< Factors.
};

const std::vector<std::string>& names_of(const MoveLaw*);
const std::vector<std::string>& names_of(const Interpolation*);
const Table<MoveTarget>& fields_of(const MoveTarget*);
const Table<MoveTask>& fields_of(const MoveTask*);
const Table<HoldTask>& fields_of(const HoldTask*);
const Table<SineTask>& fields_of(const SineTask*);
const Table<KeyframesTask>& fields_of(const KeyframesTask*);
const Table<ExpressionTask>& fields_of(const ExpressionTask*);

/// Reports why the task at `path` ("task[2]") does not fit the setup.
void check_keys(const MoveTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports why the task at `path` does not fit the setup.
void check_keys(const HoldTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports why the task at `path` does not fit the setup.
void check_keys(const SineTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports why the task at `path` does not fit the setup.
void check_keys(const KeyframesTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports why the task at `path` does not fit the setup.
void check_keys(const ExpressionTask& task, const Setup& setup, const std::string& path, Reader& reader);

/// Reads the rows of the task's CSV file. Adds errors in the file to `problems`, with their lines.
void read_files(KeyframesTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);

/// Returns the runner of a move. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const MoveTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a hold. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const HoldTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a sine. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const SineTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of keyframes. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const KeyframesTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of expressions. `task` and `setup` must outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ExpressionTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
