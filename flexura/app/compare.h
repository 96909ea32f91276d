#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// Arguments of `flexura compare`.
struct CompareArguments {
  std::string a, b;   ///< Folders made by `flexura run`.
  std::string out;    ///< Page to write; "": no page.
  bool all = false;   ///< Also values that are equal.
  bool json = false;  ///< Print one JSON document.
};

/// A value of the summaries of two runs.
struct ComparedValue {
  std::string measure;               ///< Its place in the summary: "servos.bow.remaining.rms".
  std::optional<Node> a, b;          ///< Missing in one of them, or a number, text or truth value.
  std::optional<double> difference;  ///< b - a, of numbers.
  std::optional<double> relative;    ///< (b - a) / |a|, of numbers unless a is 0.

  [[nodiscard]] bool is_equal() const;
};

/// Returns the values of two summaries, in the order of the first, then those of the second alone. Lists of
/// tables with a `name` (or `task`) are compared by it; lists of other tables are left out.
[[nodiscard]] std::vector<ComparedValue> compared_values(const Node& a, const Node& b);

/// Prints what differs between two results folders: the values of their summaries, as a table or JSON. With
/// `out`, writes a page with plots of both too. Returns exit_done. Throws InputError for folders without
/// results or with damaged ones, std::runtime_error if the page cannot be written or exists.
int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
