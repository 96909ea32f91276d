#include "flexura/tasks/motion/motion_task_config.h"

#include "flexura/base/table.h"
#include "flexura/tasks/shape_fields.h"

namespace flexura {
namespace {

constexpr double min_duration = 1e-9;  // s; of less no rates are numbers.
constexpr double max_duration = 1e6;   // s
constexpr std::size_t max_rows = 1'000'000;

const Spec name_spec{.meaning = "What to call the task in results.", .default_text = "its kind"};
const Spec duration_spec{.meaning = "How long the task takes.",
                         .unit = Unit::second,
                         .range = between(min_duration, max_duration)};

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
          Table<MoveTarget>("target",
                            "A shape of the arm, as above; or a place for its tip, for which a shape is "
                            "found within the limits of the arm, starting from where it is."))
          .field("position", &MoveTarget::position,
                 {.meaning = "Where the tip shall be in the world, instead of a shape.",
                  .unit = Unit::metre,
                  .range = between(-1e6, 1e6),
                  .default_text = "not set"});
  return table;
}

const Table<MoveTask>& fields_of(const MoveTask*) {
  static const auto table =
      Table<MoveTask>(
          "move",
          "The arm goes from where it is to another shape, each section on a straight line in bend and "
          "stretch. Where the shape is given by cord angles and each section has its own law, that is the "
          "law of its cord angle.")
          .field("name", &MoveTask::name, name_spec)
          .field("duration", &MoveTask::duration,
                 {.meaning = "How long the motion takes; a trapezoid finds its own.",
                  .unit = Unit::second,
                  .range = between(min_duration, max_duration),
                  .default_text = "1"})
          .field(
              "law", &MoveTask::law,
              {.meaning =
                   "How it goes in time: at constant rate, with the least jerk, or as fast as `max_rate` and "
                   "`max_acceleration` allow. One for all sections, or one each.",
               .one_for_all = true})
          .field("max_rate", &MoveTask::max_rate,
                 {.meaning = "Trapezoid: the fastest change of a section's bend (a change of 1 in stretch "
                             "counts as 1 rad). One for all sections, or one each; they arrive together.",
                  .unit = Unit::radian_per_second,
                  .range = above_up_to(0, 1e6),
                  .one_for_all = true,
                  .default_text = "not set"})
          .field(
              "max_acceleration", &MoveTask::max_acceleration,
              {.meaning = "Trapezoid: a section's largest acceleration. One for all sections, or one each.",
               .unit = Unit::radian_per_second_squared,
               .range = above_up_to(0, 1e6),
               .one_for_all = true,
               .default_text = "not set"})
          .field("to", &MoveTask::to,
                 {.meaning = "The shape to reach, as `to.archings_deg = [...]`, or the tip's place, as "
                             "`to.position = [x, y, z]`.",
                  .required = true});
  return table;
}

const Table<HoldTask>& fields_of(const HoldTask*) {
  static const auto table = Table<HoldTask>("hold", "The arm stays as it is.")
                                .field("name", &HoldTask::name, name_spec)
                                .field("duration", &HoldTask::duration, duration_spec);
  return table;
}

const Table<SineTask>& fields_of(const SineTask*) {
  static const auto table =
      Table<SineTask>("sine",
                      "Every section swings about where it is: from + amplitude (sin(2 pi t/period + phase) "
                      "- sin phase).")
          .field("name", &SineTask::name, name_spec)
          .field("duration", &SineTask::duration, duration_spec)
          .field(
              "period", &SineTask::period,
              {.meaning = "Time of one swing.", .unit = Unit::second, .range = between(1e-6, max_duration)})
          .field("amplitude", &SineTask::amplitude,
                 {.meaning = "Half the swing of each section, as `amplitude.archings_deg = [...]`.",
                  .required = true})
          .field("phase", &SineTask::phase,
                 {.meaning = "Where in its swing each section starts; one for all sections, or one each.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .one_for_all = true});
  return table;
}

const Table<KeyframesTask>& fields_of(const KeyframesTask*) {
  static const auto table =
      Table<KeyframesTask>(
          "keyframes",
          "The arm passes through shapes at times. The columns are `time` (s in the task, from 0) and, for "
          "every section, one of `arching_1`, `cord_angle_1` (rad, or with `_deg`, `_pi`) or the pair "
          "`bend_x_1`, `bend_y_1`; and `stretch_1` where sections stretch. The first row is where the arm "
          "is.")
          .field("name", &KeyframesTask::name, name_spec)
          .field("file", &KeyframesTask::file,
                 {.meaning = "A CSV file in this file's folder or below, whose first line names the columns.",
                  .default_text = "not set"})
          .field("columns", &KeyframesTask::columns,
                 {.meaning = "The columns' names, where no file is given.",
                  .count = {0, 10000},
                  .default_text = "not set"})
          .field("rows", &KeyframesTask::rows,
                 {.meaning = "The rows, where no file is given.",
                  .count = {0, max_rows},
                  .default_text = "not set"})
          .field(
              "interpolation", &KeyframesTask::interpolation,
              {.meaning =
                   "From row to row in straight lines, or without corners (cubic, at rest at both ends)."});
  return table;
}

const Table<ExpressionTask>& fields_of(const ExpressionTask*) {
  static const auto table =
      Table<ExpressionTask>(
          "expression",
          "Formulas of `t` (s in the task), `T` (the task's duration) and `i` (the section's number from 1), "
          "such as `\"0.3*sin(2*pi*t/T)\"`: one for all sections, or one each. Angles in rad.")
          .field("name", &ExpressionTask::name, name_spec)
          .field("duration", &ExpressionTask::duration, duration_spec)
          .field("cord_angles", &ExpressionTask::cord_angles,
                 {.meaning = "Planar arms: the cords' angles from +X.",
                  .one_for_all = true,
                  .default_text = "not set"})
          .field("archings", &ExpressionTask::archings,
                 {.meaning = "Planar arms: the archings.", .one_for_all = true, .default_text = "not set"})
          .field(
              "bends", &ExpressionTask::bends,
              {.meaning = "The bend vectors; one entry stands for all sections.", .default_text = "not set"})
          .field("stretches", &ExpressionTask::stretches,
                 {.meaning = "The factors on the sections' lengths.",
                  .one_for_all = true,
                  .default_text = "as they are"});
  return table;
}

}  // namespace flexura
