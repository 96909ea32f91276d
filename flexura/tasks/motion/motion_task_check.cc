#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/base/reader.h"
#include "flexura/kinematics/expression.h"
#include "flexura/kinematics/shape.h"
#include "flexura/rig/setup.h"
#include "flexura/tasks/motion/keyframes.h"
#include "flexura/tasks/motion/motion_task_config.h"

namespace flexura {
namespace {

void check_one_or_each(std::size_t given, std::size_t sections, const std::string& path, Reader& reader) {
  if (given == 1 || given == sections) return;
  reader.problem_at(path, fmt::format("{} given: expected 1 value for all sections, or {}, one per section",
                                      given, sections));
}

void check_one(const MoveTask& task, ArmKind kind, std::size_t sections, const std::string& path,
               Reader& reader) {
  check_shape(task.to, kind, sections, path + ".to", reader);
  const MoveTarget& to = task.to;
  const bool has_shape = to.cord_angles || to.archings || to.bends || to.stretches;
  if (!to.is_of_tip() && !has_shape)
    reader.problem_at(path + ".to",
                      "is empty: expected a shape, as archings or bends, or position, or tip_of");
  if (to.tip_of) {
    check_shape(*to.tip_of, kind, sections, path + ".to.tip_of", reader);
    if (to.position || has_shape)
      reader.problem_at(path + ".to.tip_of",
                        "is given together with another target: expected only one of them");
  }
  if ((to.direction || to.rotation) && !to.position)
    reader.problem_at(path + (to.direction ? ".to.direction" : ".to.rotation"),
                      "is given without position: expected both");
  if (to.direction && to.rotation)
    reader.problem_at(path + ".to.direction", "is given together with rotation: expected one of them");
  if (to.position && has_shape)
    reader.problem_at(path + ".to.position",
                      "is given together with a shape: expected either a position or a shape");
  check_one_or_each(task.law.size(), sections, path + ".law", reader);
  const auto trapezoids = std::ranges::count(task.law, MoveLaw::trapezoid);
  if (trapezoids == 0) {
    if (task.max_rate) reader.problem_at(path + ".max_rate", "applies only to law = \"trapezoid\"");
    if (task.max_acceleration)
      reader.problem_at(path + ".max_acceleration", "applies only to law = \"trapezoid\"");
    return;
  }
  if (static_cast<std::size_t>(trapezoids) != task.law.size()) {
    reader.problem_at(path + ".law",
                      "mixes trapezoid with other laws: expected trapezoid for all sections or for none");
  }
  if (!task.max_rate) reader.problem_at(path + ".max_rate", "missing: the law trapezoid needs this key");
  if (!task.max_acceleration)
    reader.problem_at(path + ".max_acceleration", "missing: the law trapezoid needs this key");
  if (task.max_rate) check_one_or_each(task.max_rate->size(), sections, path + ".max_rate", reader);
  if (task.max_acceleration)
    check_one_or_each(task.max_acceleration->size(), sections, path + ".max_acceleration", reader);
  if (task.duration)
    reader.problem_at(path + ".duration", "the law trapezoid computes the duration: expected no duration");
}

void check_one(const SineTask& task, ArmKind kind, std::size_t sections, const std::string& path,
               Reader& reader) {
  check_shape(task.amplitude, kind, sections, path + ".amplitude", reader);
  check_one_or_each(task.phase.size(), sections, path + ".phase", reader);
  if (task.amplitude.stretches)
    reader.problem_at(path + ".amplitude.stretches", "cannot oscillate: expected angles only");
}

void check_one(const KeyframesTask& task, ArmKind kind, std::size_t sections, const std::string& path,
               Reader& reader) {
  if (!task.file.empty()) {
    if (!task.columns.empty() || !task.rows.empty()) {
      reader.problem_at(
          path + ".file",
          "is given together with columns or rows: expected either a file, or columns and rows");
    }
    return;  // Checked after the file is read.
  }
  if (task.columns.empty() && task.rows.empty()) {
    reader.problem_at(path, "is empty: expected file, or columns and rows");
    return;
  }
  for (const KeyframeProblem& problem : keyframe_problems(task, kind, sections)) {
    std::string place = fmt::format("{}.rows", path);
    if (problem.row == header_row) place = fmt::format("{}.columns[{}]", path, problem.column);
    if (problem.row >= 0) place += fmt::format("[{}][{}]", problem.row, problem.column);
    reader.problem_at(place, problem.what);
  }
}

// Checks a formula of a task with the duration `T`, for the sections from `first` to `last` (from 1). It must
// be finite at a hundred steps; the check of the motion finds failures between them.
void check_formula(const std::string& text, double T, std::size_t first, std::size_t last,
                   const std::string& path, Reader& reader) {
  constexpr int steps = 100;
  try {
    const Expression expression(text);
    for (int k = 0; k <= steps; ++k) {
      const double t = T * k / steps;
      for (std::size_t section = first; section <= last; ++section) {
        const double value = expression.value(t, T, section);
        if (std::isfinite(value)) continue;
        reader.problem_at(path,
                          fmt::format("{} is {} at t = {:.6g} s in section {}: expected a finite number",
                                      Node{text, {}}.brief(), Node{value, {}}.brief(), t, section));
        return;
      }
    }
  } catch (const ExpressionError& error) {
    reader.problem_in_text(path, text, error.position(), error.what());
  }
}

// Formulas of one quantity, one for all sections or one each.
class FormulaCheck {
 public:
  FormulaCheck(double T, std::size_t given, std::size_t sections)
      : T_(T), given_(given), sections_(sections) {}

  void operator()(const std::string& text, std::size_t place, const std::string& path, Reader& reader) const {
    const std::size_t first = given_ == 1 ? 1 : place + 1;
    check_formula(text, T_, first, given_ == 1 ? sections_ : first, path, reader);
  }

 private:
  double T_;
  std::size_t given_, sections_;
};

void check_formulas(const std::optional<std::vector<std::string>>& formulas, double T, std::size_t sections,
                    const std::string& path, Reader& reader) {
  if (!formulas) return;
  check_one_or_each(formulas->size(), sections, path, reader);
  const FormulaCheck check(T, formulas->size(), sections);
  for (std::size_t i = 0; i < formulas->size(); ++i)
    check((*formulas)[i], i, fmt::format("{}[{}]", path, i), reader);
}

void check_one(const ExpressionTask& task, ArmKind kind, std::size_t sections, const std::string& path,
               Reader& reader) {
  const int ways = (task.cord_angles ? 1 : 0) + (task.archings ? 1 : 0) + (task.bends ? 1 : 0);
  if (ways > 1)
    reader.problem_at(path,
                      "gives the bends in more than one way: expected one of cord_angles, archings, bends");
  if (ways == 0 && !task.stretches)
    reader.problem_at(path, "is empty: expected cord_angles, archings, bends or stretches");
  if (kind == ArmKind::spatial && (task.cord_angles || task.archings)) {
    reader.problem_at(path, "cord_angles and archings are for planar arms: expected bends for a spatial arm");
  }
  check_formulas(task.cord_angles, task.duration, sections, path + ".cord_angles", reader);
  check_formulas(task.archings, task.duration, sections, path + ".archings", reader);
  check_formulas(task.stretches, task.duration, sections, path + ".stretches", reader);
  if (!task.bends) return;
  check_one_or_each(task.bends->size(), sections, path + ".bends", reader);
  const FormulaCheck check(task.duration, task.bends->size(), sections);
  for (std::size_t i = 0; i < task.bends->size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      check((*task.bends)[i][k], i, fmt::format("{}.bends[{}][{}]", path, i, k), reader);
    if (kind == ArmKind::planar && (*task.bends)[i][1] != "0") {
      reader.problem_at(fmt::format("{}.bends[{}]", path, i),
                        "leaves the plane: expected \"0\" as bend_y of a planar arm");
    }
  }
}

}  // namespace

void check_keys(const MoveTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  const std::size_t before = reader.problems().size();
  check_one(task, setup.arm.kind, setup.arm.section.size(), path, reader);
  if (reader.problems().size() > before) return;  // From here on, the shape fits the arm.
  check_bends(setup.arm.arm(), task.to, path + ".to", reader);
  if (task.to.tip_of) check_bends(setup.arm.arm(), *task.to.tip_of, path + ".to.tip_of", reader);
}

void check_keys(const HoldTask&, const Setup&, const std::string&, Reader&) {}

void check_keys(const SineTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  check_one(task, setup.arm.kind, setup.arm.section.size(), path, reader);
}

void check_keys(const KeyframesTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  check_one(task, setup.arm.kind, setup.arm.section.size(), path, reader);
}

void check_keys(const ExpressionTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  check_one(task, setup.arm.kind, setup.arm.section.size(), path, reader);
}

}  // namespace flexura
