// Any bytes as a CSV file must give a table of finite numbers with one value per column, or an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "flexura/base/source.h"
#include "flexura/store/csv_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const flexura::NumberTable table =
        flexura::parse_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (table.columns.empty() || table.rows.size() != table.lines.size()) std::abort();
    for (const auto& row : table.rows) {
      if (row.size() != table.columns.size()) std::abort();
      for (const double value : row) {
        if (!std::isfinite(value)) std::abort();
      }
    }
  } catch (const flexura::InputError& error) {
    if (error.problems().empty()) std::abort();
  }
  return 0;
}
