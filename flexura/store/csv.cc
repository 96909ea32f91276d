#include "flexura/store/csv.h"

#include <fmt/format.h>

#include <iterator>

namespace flexura {

void CsvText::separate() {
  if (!at_row_start_) text_ += ',';
  at_row_start_ = false;
}

void CsvText::cell(std::string_view text) {
  separate();
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += text;
    return;
  }
  text_ += '"';
  for (const char c : text) {
    if (c == '"') text_ += '"';
    text_ += c;
  }
  text_ += '"';
}

void CsvText::cell(double value) {
  separate();
  fmt::format_to(std::back_inserter(text_), "{}", value);
}

void CsvText::cells(std::span<const double> values) {
  for (const double value : values) cell(value);
}

void CsvText::end_row() {
  text_ += '\n';
  at_row_start_ = true;
}

}  // namespace flexura
