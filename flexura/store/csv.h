#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flexura {

/// A table as CSV (RFC 4180 with "\n" line ends): texts are quoted where they must be, numbers read back
/// exactly.
class CsvText {
 public:
  /// Adds a cell to the row; a number that is not finite is "nan" or "inf".
  void cell(std::string_view text);
  void cell(double value);
  void cells(std::span<const double> values);
  void end_row();

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void separate();

  std::string text_;
  bool at_row_start_ = true;
};

}  // namespace flexura
