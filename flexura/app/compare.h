#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// Arguments of `flexura compare`.
struct CompareArguments {
  std::string a, b;   ///< Results folders of `flexura run`.
  std::string out;    ///< Page to write; "": no page.
  bool all = false;   ///< Whether to include values that are equal.
  bool json = false;  ///< Whether to print one JSON document.
};

/// A value of the summaries of two runs.
struct ComparedValue {
  std::string measure;  ///< Position of the value in the summary: "servos.bow.remaining.rms".
  std::optional<Node> a,
      b;  ///< Number, text or truth value in each summary; empty if the summary lacks the value.
  std::optional<double> difference;  ///< Difference b - a, if the values are numbers.
  std::optional<double>
      relative;  ///< Relative difference (b - a) / |a|, if the values are numbers and a is not 0.

  [[nodiscard]] bool is_equal() const;
};

/// Returns pairs of values of two summaries, in the order of the first summary. Values that only the second
/// summary has are at the end. Items of a list of tables are matched by their key `name` (or `task`). Lists
/// of tables without these keys are omitted.
[[nodiscard]] std::vector<ComparedValue> compared_values(const Node& a, const Node& b);

/// Prints the values that differ between the summaries of two results folders, as a table or JSON. If `out`
/// is given, also writes a page with plots of both runs. Returns exit_done. Throws InputError if a summary or
/// log is missing or damaged, and std::runtime_error if the page exists or cannot be written.
int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
