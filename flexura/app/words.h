#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/one_line.h"
#include "flexura/base/source.h"

namespace flexura {

/// Prints "label: text" as one line, even if the text contains line breaks.
inline void print_line(std::ostream& out, std::string_view label, std::string_view text) {
  out << label << ": " << one_line(text) << '\n';
}

/// Returns the enumeration value with the name `word`. For an unknown name, throws InputError that lists all
/// allowed names.
template <typename E>
E named(const std::string& option, const std::string& word) {
  const std::vector<std::string>& names = names_of(static_cast<const E*>(nullptr));
  const auto found = std::ranges::find(names, word);
  if (found == names.end())
    throw input_error(option,
                      fmt::format("\"{}\": expected one of \"{}\"", word, fmt::join(names, "\", \"")));
  return static_cast<E>(found - names.begin());
}

}  // namespace flexura
