#include "flexura/tasks/motion/motion_task_config.h"

#include "flexura/base/table.h"
#include "flexura/math/arrays.h"
#include "flexura/tasks/shape_fields.h"

namespace flexura {
namespace {

constexpr double min_duration = 1e-9;  // In s; shorter durations give no finite rates.
constexpr double max_duration = 1e6;   // s
constexpr std::size_t max_rows = 1'000'000;

const Spec name_spec{.meaning = "Name of the task in results.", .default_text = "its kind"};
const Spec duration_spec{
    .meaning = "Duration of the task.", .unit = Unit::second, .range = between(min_duration, max_duration)};

}  // namespace

const std::vector<std::string>& names_of(const MoveLaw*) {
  static const std::vector<std::string> names{"linear", "minimum_jerk", "trapezoid"};
  return names;
}

const std::vector<std::string>& names_of(const Interpolation*) {
  static const std::vector<std::string> names{"linear", "smooth"};
  return names;
}

const Table<MoveTarget>& fields_of(const MoveTarget*) {
  static const auto table =
      with_shape_fields(
          Table<MoveTarget>(
              "target",
              "Target shape of the arm, or target pose of its tip. For a pose of the tip, the program "
              "searches for a shape within the arm's limits, starting at the current shape."))
          .field("position", &MoveTarget::position,
                 {.meaning = "Target position of the tip in the world, instead of a target shape.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .default_text = "not set"})
          .field("direction", &MoveTarget::direction,
                 {.meaning = "Target direction of the tip in the world, of any length; together with "
                             "`position`.",
                  .range = between(-1e6, 1e6),
                  .default_text = "not set"})
          .field(
              "rotation", &MoveTarget::rotation,
              {.meaning = "Target rotation of the tip: unit quaternion (w, x, y, z) from the tip's axes to "
                          "the world; together with `position`.",
               .range = between(-2, 2),
               .default_text = "not set"})
          .field("tip_of", &MoveTarget::tip_of,
                 {.meaning = "Shape whose tip is the target, instead of a target shape. The arm may reach it "
                             "with another shape.",
                  .default_text = "not set"})
          .field("match", &MoveTarget::match,
                 {.meaning = "What must agree with the tip of `tip_of`: its position, its position and "
                             "direction, or its full pose."})
          .check([](const MoveTarget& target, Reader& reader) {
            const std::string problem = target.rotation ? quaternion_problem(*target.rotation) : "";
            if (!problem.empty()) reader.problem_at("rotation", problem);
            if (target.direction && vector(*target.direction).norm() < 1e-9)
              reader.problem_at("direction", "is 0: expected a direction");
          });
  return table;
}

const std::vector<std::string>& names_of(const TipMatch*) {
  static const std::vector<std::string> names{"position", "direction", "pose"};
  return names;
}

const Table<MoveTask>& fields_of(const MoveTask*) {
  static const auto table =
      Table<MoveTask>("move",
                      "Moves the arm to another shape. The bends and stretches change linearly from the "
                      "current to the target shape. If the target is given by cord angles and each section "
                      "has its own law, the cord angles change by these laws instead.")
          .field("name", &MoveTask::name, name_spec)
          .field("duration", &MoveTask::duration,
                 {.meaning = "Duration of the motion. The law `trapezoid` computes the duration.",
                  .unit = Unit::second,
                  .range = between(min_duration, max_duration),
                  .default_text = "1"})
          .field("law", &MoveTask::law,
                 {.meaning = "Time law: constant rate, minimum jerk, or fastest within `max_rate` and "
                             "`max_acceleration`. One law for all sections, or one per section.",
                  .one_for_all = true})
          .field("max_rate", &MoveTask::max_rate,
                 {.meaning = "Law `trapezoid`: largest bend rate of a section. A stretch rate of 1/s counts "
                             "as 1 rad/s. One rate for all sections, or one per section. All sections arrive "
                             "at the same time.",
                  .unit = Unit::radian_per_second,
                  .range = above_up_to(0, 1e6),
                  .one_for_all = true,
                  .default_text = "not set"})
          .field("max_acceleration", &MoveTask::max_acceleration,
                 {.meaning = "Law `trapezoid`: largest acceleration of a section. One value for all "
                             "sections, or one per section.",
                  .unit = Unit::radian_per_second_squared,
                  .range = above_up_to(0, 1e6),
                  .one_for_all = true,
                  .default_text = "not set"})
          .field("to", &MoveTask::to,
                 {.meaning = "Target shape, as `to.archings_deg = [...]`, or target tip position, as "
                             "`to.position = [x, y, z]`.",
                  .required = true});
  return table;
}

const Table<HoldTask>& fields_of(const HoldTask*) {
  static const auto table = Table<HoldTask>("hold", "Keeps the arm still.")
                                .field("name", &HoldTask::name, name_spec)
                                .field("duration", &HoldTask::duration, duration_spec);
  return table;
}

const Table<SineTask>& fields_of(const SineTask*) {
  static const auto table =
      Table<SineTask>("sine",
                      "Makes every section oscillate about its current shape: start + amplitude (sin(2 pi "
                      "t/period + phase) - sin phase).")
          .field("name", &SineTask::name, name_spec)
          .field("duration", &SineTask::duration, duration_spec)
          .field("period", &SineTask::period,
                 {.meaning = "Period of the oscillation.",
                  .unit = Unit::second,
                  .range = between(1e-6, max_duration)})
          .field("amplitude", &SineTask::amplitude,
                 {.meaning = "Amplitude of each section, as `amplitude.archings_deg = [...]`.",
                  .required = true})
          .field("phase", &SineTask::phase,
                 {.meaning = "Initial phase: one value for all sections, or one per section.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .one_for_all = true});
  return table;
}

const Table<KeyframesTask>& fields_of(const KeyframesTask*) {
  static const auto table =
      Table<KeyframesTask>(
          "keyframes",
          "Moves the arm through shapes at given times. The column `time` is in s from the task's start; the "
          "first row is at 0. Section 1 has the column `arching_1`, `cord_angle_1` or the pair `bend_x_1`, "
          "`bend_y_1`, in rad; column names may end in `_deg` or `_pi` for other units. Sections that "
          "stretch also have `stretch_1`. The first row must be the current shape.")
          .field("name", &KeyframesTask::name, name_spec)
          .field("file", &KeyframesTask::file,
                 {.meaning = "CSV file in this file's folder or below. The first line of the CSV file names "
                             "the columns.",
                  .default_text = "not set"})
          .field("columns", &KeyframesTask::columns,
                 {.meaning = "Names of the columns of `rows`. Not allowed with `file`.",
                  .count = {0, 10000},
                  .default_text = "not set"})
          .field("rows", &KeyframesTask::rows,
                 {.meaning = "Rows of values. Not allowed with `file`.",
                  .count = {0, max_rows},
                  .default_text = "not set"})
          .field("interpolation", &KeyframesTask::interpolation,
                 {.meaning = "Interpolation between rows: linear, or cubic with zero rates at both ends."});
  return table;
}

const Table<ExpressionTask>& fields_of(const ExpressionTask*) {
  static const auto table =
      Table<ExpressionTask>(
          "expression",
          "Moves the arm by formulas such as `\"0.3*sin(2*pi*t/T)\"`: one formula for all sections, or one "
          "per section. The variables are `t` (time from the task's start, s), `T` (duration of the task, s) "
          "and `i` (number of the section, from 1). Angles are in rad.")
          .field("name", &ExpressionTask::name, name_spec)
          .field("duration", &ExpressionTask::duration, duration_spec)
          .field("cord_angles", &ExpressionTask::cord_angles,
                 {.meaning = "Planar arms: angle of each section's chord from +X.",
                  .one_for_all = true,
                  .default_text = "not set"})
          .field("archings", &ExpressionTask::archings,
                 {.meaning = "Planar arms: arching of each section.",
                  .one_for_all = true,
                  .default_text = "not set"})
          .field("bends", &ExpressionTask::bends,
                 {.meaning = "Bend vector of each section. A single entry applies to all sections.",
                  .default_text = "not set"})
          .field("stretches", &ExpressionTask::stretches,
                 {.meaning = "Factors on the lengths of the sections.",
                  .one_for_all = true,
                  .default_text = "unchanged"});
  return table;
}

}  // namespace flexura
