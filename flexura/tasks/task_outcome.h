#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// What came of one task, in words. The terminal, the report and the summary show the same ones.
struct TaskOutcome {
  std::string task;            ///< Name of the task.
  std::string kind;            ///< "servo"
  std::string noun;            ///< Of such tasks in a total: "servo", "motion".
  std::string success;         ///< What those in a total that are reached have done: "converged".
  bool is_reached = true;      ///< The task did what it was asked to do.
  std::string text;            ///< One line without the name: "converged in 1.9 s, ...".
  std::optional<double> size;  ///< Error to compare with tasks of this noun; missing: not compared.
  std::string brief = {};      ///< Shorter text for totals of several tasks; "": the text.
  std::string size_text = {};  ///< That error: "0.08 % of the length rms".

  /// Returns "NAME: TEXT".
  [[nodiscard]] std::string line() const;
};

/// Returns the outcome of a task that did not begin.
[[nodiscard]] TaskOutcome not_begun(std::string task, std::string kind, std::string noun,
                                    std::string success);

/// Returns all outcomes in one line, in the order of their nouns: of one task its line; of several with one
/// noun "3 of 3 servos converged, worst 0.08 % of the length rms". "" without outcomes.
[[nodiscard]] std::string total_of(const std::vector<TaskOutcome>& outcomes);

/// Returns the outcomes as a list of tables: `task`, `kind`, `reached`, `text`.
[[nodiscard]] Node outcomes_node(const std::vector<TaskOutcome>& outcomes);

/// Returns a length in words: "0.81 mm", "1.2 m", "less than 0.001 mm".
[[nodiscard]] std::string length_text(double metres);

}  // namespace flexura
