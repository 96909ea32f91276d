#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A table of numbers with named columns.
struct NumberTable {
  std::vector<std::string> columns;       ///< Names, all different.
  std::vector<std::vector<double>> rows;  ///< Finite; one value per column.
  int header_line = 1;                    ///< Line of the names in the source, from 1.
  std::vector<int> lines;                 ///< Line of each row.
};

/// Parses CSV (RFC 4180, with "\n" or "\r\n"): a line of names, then lines with one number per name. Skips
/// blank lines. Throws InputError (source:line:column, the column counting characters) with up to 20
/// problems.
///
/// - Header: missing, or with an empty or repeated name.
/// - Values: too few or too many, or a value that is not a finite number.
/// - Separators: semicolons or tabs between columns, an unclosed quote.
/// - Size: more than 10^6 rows.
[[nodiscard]] NumberTable parse_csv(std::string_view text, const std::string& source);
/// Returns the column of each cell in a line of CSV, from 1: after the preceding comma. Empty for an invalid
/// line.
[[nodiscard]] std::vector<int> cell_columns(std::string_view line);

}  // namespace flexura
