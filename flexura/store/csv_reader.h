#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A table of numbers with named columns.
struct NumberTable {
  std::vector<std::string> columns;       ///< Names, all different.
  std::vector<std::vector<double>> rows;  ///< Finite; one entry a column.
  int header_line = 1;                    ///< The line of the source that the names stand in, from 1.
  std::vector<int> lines;                 ///< That of each row.
};

/// Parses CSV (RFC 4180, "\n" or "\r\n"): a line of names, then lines of as many numbers; blank lines are
/// skipped. Throws InputError (source:line:column, the column counting characters) with up to 20 problems: no
/// header, an empty or repeated name, too few or too many values, what is no finite number, columns
/// separated by semicolons or tabs, an unclosed
/// quote, more than 10^6 rows.
[[nodiscard]] NumberTable parse_csv(std::string_view text, const std::string& source);
/// Where each cell of a line of CSV starts, from 1: behind the comma before it. Empty for a line that is
/// none.
[[nodiscard]] std::vector<int> cell_columns(std::string_view line);

}  // namespace flexura
