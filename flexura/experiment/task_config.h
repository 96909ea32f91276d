#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/experiment/calibrate_config.h"
#include "flexura/experiment/dynamics_task_config.h"
#include "flexura/experiment/servo_target.h"
#include "flexura/experiment/servo_task_config.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm_config.h"
#include "flexura/study/study_config.h"

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

/// One `[[task]]` of a file.
using TaskConfig = std::variant<MoveTask, HoldTask, SineTask, KeyframesTask, ExpressionTask, StudyTask,
                                CalibrateTask, ServoTask, DynamicsTask>;

const std::vector<std::string>& names_of(const MoveLaw*);
const std::vector<std::string>& names_of(const Interpolation*);
const Table<MoveTarget>& fields_of(const MoveTarget*);
const Table<MoveTask>& fields_of(const MoveTask*);
const Table<HoldTask>& fields_of(const HoldTask*);
const Table<SineTask>& fields_of(const SineTask*);
const Table<KeyframesTask>& fields_of(const KeyframesTask*);
const Table<ExpressionTask>& fields_of(const ExpressionTask*);

[[nodiscard]] std::string task_name(const TaskConfig& task);       ///< Its name, else its kind.
[[nodiscard]] std::string_view task_kind(const TaskConfig& task);  ///< "move", "servo", ...
/// Whether it is done by the rig, so that only then is known where the arm comes to.
[[nodiscard]] bool is_for_rig(const TaskConfig& task);

/// Reports what keeps the task at `path` ("task[2]") from fitting an arm of this kind and number of sections.
void check_task(const TaskConfig& task, ArmKind kind, std::size_t sections, const std::string& path,
                Reader& reader);

/// Where the tip shall be after the task, m, when the task says so.
[[nodiscard]] std::optional<Eigen::Vector3d> tip_target(const TaskConfig& task);

/// The motion that a task (checked by check_task) is, for an arm that stands in `from`.
[[nodiscard]] MotionPtr task_motion(const TaskConfig& task, const ArmModel& arm, const ArmState& from);
/// Of a servo of the arm with targets of these shapes: what is to be expected of it before it is done. As
/// slow as the sections' rates ask for.
[[nodiscard]] MotionPtr servo_motion(const std::vector<std::optional<ServoTargetShape>>& shapes,
                                     const Arm& arm, const ArmState& from);

}  // namespace flexura
