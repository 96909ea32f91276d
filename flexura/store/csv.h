#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// A table as CSV (RFC 4180 with "\n" line ends): texts are quoted where they must be, numbers read back
/// exactly.
class CsvText {
 public:
  /// Adds a cell to the row that is being written. Quoted where it holds a comma, a quote or a line's end.
  void cell(std::string_view text);
  /// As few digits as read back exactly; a number that is not finite is "nan", "inf" or "-inf".
  void cell(double value);
  /// A cell for each value.
  void cells(std::span<const double> values);
  /// The next cell begins a new row. A table is to end with it.
  void end_row();

  /// All rows so far. The text stays the table's own.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void separate();

  std::string text_;
  bool at_row_start_ = true;
};

}  // namespace flexura
