#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A table of numbers with named columns.
struct NumberTable {
  std::vector<std::string> columns;       ///< Names of the columns, all different.
  std::vector<std::vector<double>> rows;  ///< Finite values, one per column in each row.
  int header_line = 1;                    ///< Line number of the names in the source, from 1.
  std::vector<int> lines;                 ///< Line number of each row in the source, from 1.
};

/// Parses CSV (RFC 4180, with "\n" or "\r\n"): a line of names, then lines with one number per name. Skips
/// blank lines. Throws InputError with up to 20 errors (source:line:column, with the column in characters).
/// There are these errors:
///
/// - Header: is missing, or has an empty or repeated name.
/// - Values: a row has too few or too many values, or a value is not a finite number.
/// - Separators: there are semicolons or tabs between columns, or an unclosed quote.
/// - Size: the table has more than 10^6 rows.
[[nodiscard]] NumberTable parse_csv(std::string_view text, const std::string& source);
/// Returns the position of the first character of each cell in a line of CSV, from 1. The result is empty for
/// an invalid line.
[[nodiscard]] std::vector<int> cell_columns(std::string_view line);

}  // namespace flexura
