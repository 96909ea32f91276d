#include "flexura/store/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/base/source.h"

namespace flexura {
namespace {

constexpr std::size_t max_rows = 1'000'000;
constexpr std::size_t max_problems = 20;
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

struct Cell {
  std::string text;
  int column = 1;  // Column of the source, from 1.
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// Returns the cells of one line; std::nullopt if a quote is not closed or text follows a closed one. A quoted
// name may contain commas, but no line ends: column names do not need them.
std::optional<std::vector<Cell>> split(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t at = 0;;) {
    Cell cell{{}, static_cast<int>(at) + 1};
    std::size_t end = line.find(',', at);
    if (trimmed(line.substr(at)).starts_with('"')) {
      std::size_t i = line.find('"', at) + 1;
      for (;; ++i) {
        if (i >= line.size()) return std::nullopt;
        if (line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"') {
          ++i;
        } else if (line[i] == '"') {
          break;
        }
        cell.text += line[i];
      }
      end = line.find(',', i);
      const std::string_view rest = line.substr(i + 1, end == std::string_view::npos ? end : end - i - 1);
      if (!trimmed(rest).empty()) return std::nullopt;
    } else {
      cell.text = trimmed(line.substr(at, end == std::string_view::npos ? end : end - at));
    }
    cells.push_back(std::move(cell));
    if (end == std::string_view::npos) return cells;
    at = end + 1;
  }
}

class CsvParser {
 public:
  explicit CsvParser(const std::string& source) : source_(std::make_shared<const std::string>(source)) {}

  void line(std::string_view text, int number) {
    const auto cells = split(text);
    if (!cells) {
      problem(number, 1, "a quote is not closed, or text follows a closing quote");
    } else if (table_.columns.empty()) {
      header(*cells, number);
    } else {
      row(*cells, number);
    }
  }

  [[nodiscard]] bool is_lost() const { return is_lost_ || problems_.size() >= max_problems; }

  NumberTable finish() && {
    if (table_.columns.empty() && problems_.empty()) problem(1, 1, "empty: expected a line of column names");
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(table_);
  }

 private:
  void problem(int line, int column, std::string what) {
    problems_.push_back({{source_, line, column}, std::move(what)});
  }

  void header(const std::vector<Cell>& cells, int number) {
    table_.header_line = number;
    // Semicolons are common in spreadsheets of many countries: one message is better than an error for each
    // row.
    const std::size_t other = cells.size() == 1 ? cells[0].text.find_first_of(";\t") : std::string::npos;
    if (other != std::string::npos) {
      const char* name = cells[0].text[other] == ';' ? "';'" : "tabs";
      problem(number, cells[0].column + static_cast<int>(other),
              fmt::format("columns are separated by {}: expected commas, and points in numbers", name));
      is_lost_ = true;
    }
    for (const Cell& cell : cells) {
      if (cell.text.empty()) problem(number, cell.column, "the column has no name");
      if (std::ranges::count(table_.columns, cell.text) > 0) {
        problem(number, cell.column, fmt::format("column {} occurs twice", Node{cell.text, {}}.brief()));
      }
      table_.columns.push_back(cell.text);
    }
  }

  void row(const std::vector<Cell>& cells, int number) {
    if (cells.size() != table_.columns.size()) {
      problem(number, 1,
              fmt::format("{} values: expected {}, one per column", cells.size(), table_.columns.size()));
      return;
    }
    if (table_.rows.size() == max_rows) {
      if (!is_lost()) problem(number, 1, fmt::format("more than {} rows", max_rows));
      return;
    }
    std::vector<double> values;
    for (const Cell& cell : cells) {
      double value = 0;
      const char* const end = cell.text.data() + cell.text.size();
      const char* const start = cell.text.data() + (cell.text.starts_with('+') ? 1 : 0);
      const auto [stop, error] = std::from_chars(start, end, value);
      const bool two_signs = start != cell.text.data() && *start == '-';
      if (two_signs || error != std::errc{} || stop != end || start == end || !std::isfinite(value)) {
        problem(number, cell.column,
                fmt::format("{}: expected a finite number", Node{cell.text, {}}.brief()));
      }
      values.push_back(value);
    }
    table_.rows.push_back(std::move(values));
    table_.lines.push_back(number);
  }

  std::shared_ptr<const std::string> source_;
  NumberTable table_;
  std::vector<Problem> problems_;
  bool is_lost_ = false;  // Further messages would be useless.
};

}  // namespace

std::vector<int> cell_columns(std::string_view line) {
  if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  std::vector<int> columns;
  for (const Cell& cell : split(line).value_or(std::vector<Cell>{})) columns.push_back(cell.column);
  return columns;
}

NumberTable parse_csv(std::string_view text, const std::string& source) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  CsvParser parser(source);
  for (int number = 1; !text.empty() && !parser.is_lost(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!trimmed(line).empty()) parser.line(line, number);
  }
  return std::move(parser).finish();
}

}  // namespace flexura
