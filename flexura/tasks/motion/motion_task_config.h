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

/// What of the tip's pose is a target.
enum class TipMatch { position, direction, pose };

/// Target of a move: a shape, or a pose of the tip for which a shape is computed.
struct MoveTarget : ShapeConfig {
  std::optional<std::array<double, 3>> position;   ///< Tip position p_WT, m.
  std::optional<std::array<double, 3>> direction;  ///< Direction of the tip's z; requires `position`.
  std::optional<std::array<double, 4>> rotation;   ///< Quaternion (w, x, y, z) of R_WT; requires `position`.
  std::optional<ShapeConfig> tip_of;               ///< A shape whose tip has the target pose.
  TipMatch match = TipMatch::pose;                 ///< What of the pose of `tip_of` is the target.

  /// Returns whether a shape is computed for the tip.
  [[nodiscard]] bool is_of_tip() const { return position || tip_of; }
};

/// `kind = "move"`: the arm moves from its current shape to a target shape. The bend and stretch of each
/// section follow a straight line. If sections have different laws and the shape is given by cord angles,
/// each cord angle follows its own law. A pose of the tip is converted to a shape by inverse kinematics,
/// starting at the current shape. If the pose is unreachable, the arm moves to the shape whose tip is
/// nearest to it.
struct MoveTask {
  std::string name;
  std::optional<double> duration;  ///< Duration, s; default: 1. The law `trapezoid` computes its duration.
  std::vector<MoveLaw> law = {MoveLaw::linear};  ///< One law for all sections, or one law per section.
  std::optional<std::vector<double>>
      max_rate;  ///< Largest bend rates, rad/s, for `trapezoid` only: one for all sections, or one for each.
  /// Largest accelerations of bends, rad/s^2, for `trapezoid` only: one for all sections, or one for each.
  std::optional<std::vector<double>> max_acceleration;
  MoveTarget to;  ///< Target shape or tip position.
};

/// `kind = "hold"`: the arm keeps its current shape.
struct HoldTask {
  std::string name;
  double duration = 1.0;  ///< Duration, s.
};

/// `kind = "sine"`: every section oscillates about its current shape.
struct SineTask {
  std::string name;
  double duration = 1.0;  ///< Duration, s.
  double period = 1.0;    ///< Period of the oscillation, s.
  ShapeConfig amplitude;  ///< Amplitude of cord angles, archings or bends. Stretches cannot oscillate.
  std::vector<double> phase = {0.0};  ///< Phases, rad: one for all sections, or one for each.
};

/// `kind = "keyframes"`: the arm passes through shapes at given times, from a CSV file or written in the
/// experiment.
struct KeyframesTask {
  std::string name;
  std::string file;  ///< CSV file in the experiment's folder. The content of the file is read into `columns`
                     ///< and `rows`.
  std::vector<std::string> columns;       ///< Names of the columns: "time", and for each section "arching_1",
                                          ///< "cord_angle_1_deg", "bend_x_1", ...
  std::vector<std::vector<double>> rows;  ///< Values in the order of the columns.
  Interpolation interpolation = Interpolation::linear;  ///< Interpolation between the rows.
};

/// `kind = "expression"`: the arm follows formulas of t (s since the task's start), T (its duration, s) and i
/// (the section's number, from 1). There is one formula for all sections, or one for each
/// (kinematics/expression.h).
struct ExpressionTask {
  std::string name;
  double duration = 1.0;                                         ///< Duration, s.
  std::optional<std::vector<std::string>> cord_angles;           ///< Formulas of cord angles, rad.
  std::optional<std::vector<std::string>> archings;              ///< Formulas of archings, rad.
  std::optional<std::vector<std::array<std::string, 2>>> bends;  ///< Formulas of bends, rad.
  std::optional<std::vector<std::string>> stretches;             ///< Formulas of stretches, as factors.
};

const std::vector<std::string>& names_of(const MoveLaw*);
const std::vector<std::string>& names_of(const TipMatch*);
const std::vector<std::string>& names_of(const Interpolation*);
const Table<MoveTarget>& fields_of(const MoveTarget*);
const Table<MoveTask>& fields_of(const MoveTask*);
const Table<HoldTask>& fields_of(const HoldTask*);
const Table<SineTask>& fields_of(const SineTask*);
const Table<KeyframesTask>& fields_of(const KeyframesTask*);
const Table<ExpressionTask>& fields_of(const ExpressionTask*);

/// Reports as errors why the task at `path` ("task[2]") does not fit the setup.
void check_keys(const MoveTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports as errors why the task at `path` does not fit the setup.
void check_keys(const HoldTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports as errors why the task at `path` does not fit the setup.
void check_keys(const SineTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports as errors why the task at `path` does not fit the setup.
void check_keys(const KeyframesTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Reports as errors why the task at `path` does not fit the setup.
void check_keys(const ExpressionTask& task, const Setup& setup, const std::string& path, Reader& reader);

/// Reads the rows of the task's CSV file. Adds each error in the file, with its line number, to `problems`.
void read_files(KeyframesTask& task, const Setup& setup, const Node& written, const std::string& path,
                std::vector<Problem>& problems);

/// Returns the runner of a move. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const MoveTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a hold. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const HoldTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a sine. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const SineTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a task with keyframes. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const KeyframesTask& task, const Setup& setup,
                                                    TaskLabel label);
/// Returns the runner of a task with expressions. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const ExpressionTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
