#include "flexura/store/toml_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "flexura/base/source.h"

namespace flexura {
namespace {

constexpr int max_toml_depth = 32;

// Returns the end of the quoted text that starts at `start` (the index past its closing quotes). An unclosed
// one ends with its line, or with the document if it is multi-line; the parser reports it.
std::size_t end_of_quoted(std::string_view text, std::size_t start) {
  const char quote = text[start];
  const bool multi_line = text.substr(start, 3) == std::string(3, quote);
  const std::size_t width = multi_line ? 3 : 1;
  for (std::size_t i = start + width; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text[i] == '\n' && !multi_line) {
      return i;
    } else if (text[i] == quote && (!multi_line || text.substr(i, 3) == std::string(3, quote))) {
      // A multi-line text may end in up to two quotes before the closing three.
      std::size_t end = i + width;
      while (multi_line && end < std::min(i + width + 2, text.size()) && text[end] == quote) ++end;
      return end;
    }
  }
  return text.size();
}

[[noreturn]] void too_deep(std::string_view text, const std::string& source, std::size_t at,
                           const char* what) {
  const std::size_t line_start = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0.
  throw input_error(source, fmt::format("{} nested more than {} deep", what, max_toml_depth),
                    static_cast<int>(std::ranges::count(text.substr(0, at), '\n')) + 1,
                    static_cast<int>(at - line_start) + 1);
}

}  // namespace

void check_toml_depth(std::string_view text, const std::string& source) {
  int brackets = 0;
  int dots = 0;  // Dots in the current dotted key.
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_quoted(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
    if (c == '.') ++dots;
    if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') dots = 0;
    if (brackets > max_toml_depth) too_deep(text, source, i, "brackets");
    if (dots > max_toml_depth) too_deep(text, source, i, "a dotted key");
    ++i;
  }
}

}  // namespace flexura
