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

/// How a move goes in time (kinematics/profile.h).
enum class MoveLaw { linear, minimum_jerk, trapezoid };

/// Where a move goes: to a shape, or to a shape that puts the tip in a place.
struct MoveTarget : ShapeConfig {
  std::optional<std::array<double, 3>> position;  ///< p_WT, m.
};

/// `kind = "move"`: the arm goes from where it is to another shape, each section on a straight line in
/// bend and stretch; where sections have laws of their own and the shape is given by cord angles, each
/// section's cord angle by its own law. A place for the tip is made a shape by inverse kinematics from where
/// the arm is; out of reach, the nearest one.
struct MoveTask {
  std::string name;
  std::optional<double> duration;                       ///< s; 1 when left out. A trapezoid finds its own.
  std::vector<MoveLaw> law = {MoveLaw::linear};         ///< One for all sections, or one each.
  std::optional<std::vector<double>> max_rate;          ///< rad/s; trapezoid. One for all, or one each.
  std::optional<std::vector<double>> max_acceleration;  ///< rad/s^2; trapezoid. One for all, or one each.
  MoveTarget to;                                        ///< The shape, or the tip's place.
};

/// `kind = "hold"`: the arm stays as it is.
struct HoldTask {
  std::string name;
  double duration = 1.0;  ///< s
};

/// `kind = "sine"`: every section swings about where it is.
struct SineTask {
  std::string name;
  double duration = 1.0;              ///< s
  double period = 1.0;                ///< s
  ShapeConfig amplitude;              ///< Of cord angles, archings or bends; no stretches.
  std::vector<double> phase = {0.0};  ///< rad; one for all sections, or one each.
};

/// `kind = "keyframes"`: the arm passes through shapes at times, from a CSV file or written in place.
struct KeyframesTask {
  std::string name;
  std::string file;  ///< Beside the experiment; read into columns and rows with the experiment.
  std::vector<std::string>
      columns;  ///< "time", and per section "arching_1", "cord_angle_1_deg", "bend_x_1", ...
  std::vector<std::vector<double>> rows;                ///< As the columns say.
  Interpolation interpolation = Interpolation::linear;  ///< Between the rows.
};

/// `kind = "expression"`: a formula of t (s in the task), T (its duration) and i (the section's number from
/// 1), one for all sections or one each (kinematics/expression.h).
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

/// Reports what keeps the task at `path` ("task[2]") from fitting the setup.
void check_keys(const MoveTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Likewise.
void check_keys(const HoldTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Likewise.
void check_keys(const SineTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Likewise.
void check_keys(const KeyframesTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Likewise.
void check_keys(const ExpressionTask& task, const Setup& setup, const std::string& path, Reader& reader);

/// The rows of its CSV file. InputError where they are wrong, with their lines in the file.
void read_files(KeyframesTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);

/// What does such a task. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const MoveTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Likewise.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const HoldTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Likewise.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const SineTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Likewise.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const KeyframesTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Likewise.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ExpressionTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
