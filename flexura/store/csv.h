#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// A table as CSV (RFC 4180 with " " line ends): texts are quoted if needed, and numbers keep their exact
/// values.
class CsvText {
 public:
  /// Adds a cell to the current row. The cell is quoted if it contains a comma, a quote or a line end.
  void cell(std::string_view text);
  /// Adds a number with the fewest digits that keep its exact value. A number that is not finite is written
  /// as "nan", "inf" or "-inf".
  void cell(double value);
  /// Adds a cell for each value.
  void cells(std::span<const double> values);
  /// Ends the row. The next cell begins a new row. Call this function after the last row too.
  void end_row();

  /// Returns all rows so far, as a reference into this object.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void separate();

  std::string text_;
  bool at_row_start_ = true;
};

}  // namespace flexura
