#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// Result of one task in words, for the terminal, the report and the summary.
struct TaskOutcome {
  std::string task;        ///< Name of the task.
  std::string kind;        ///< Kind of the task, such as "servo".
  std::string noun;        ///< Noun for tasks of this kind in a total, such as "servo" or "motion".
  std::string success;     ///< Verb for successful tasks in a total, such as "converged".
  bool is_reached = true;  ///< Whether the task was successful.
  std::string text;        ///< Result in one line without the name: "converged in 1.9 s, ...".
  std::optional<double>
      /// Size of the error, for comparison with other tasks that have the same noun; missing: the task is not
      /// compared.
      size;
  std::string brief = {};      ///< Shorter text for totals of several tasks; "": `text` is used.
  std::string size_text = {};  ///< The error `size` in words: "0.08 % of the length rms".

  /// Returns "NAME: TEXT".
  [[nodiscard]] std::string line() const;
};

/// Returns the outcome of a task that did not begin.
[[nodiscard]] TaskOutcome not_begun(std::string task, std::string kind, std::string noun,
                                    std::string success);

/// Returns all outcomes in one line, grouped by nouns; "" without outcomes. For a single task with a noun,
/// the line has its outcome. For several tasks, the line has a total such as "3 of 3 servos converged, worst
/// 0.08 % of the length rms".
[[nodiscard]] std::string total_of(const std::vector<TaskOutcome>& outcomes);

/// Returns the outcomes as a list of tables: `task`, `kind`, `reached`, `text`.
[[nodiscard]] Node outcomes_node(const std::vector<TaskOutcome>& outcomes);

/// Returns a length with a suitable unit: "0.81 mm", "1.2 m", "less than 0.001 mm".
[[nodiscard]] std::string length_text(double metres);

}  // namespace flexura
