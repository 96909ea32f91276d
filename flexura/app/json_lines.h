#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace flexura {

/// Maximum length of an input line, bytes.
inline constexpr std::size_t longest_line = std::size_t{1} << 24;

/// Function that returns the output line for an input line, both without line end. The function must accept
/// any contents.
using LineAnswer = std::function<std::string(std::string_view line)>;

/// Writes one line to `out` for every line of `in`, in order, each as soon as it is computed. A line ends
/// with "\n" (or "\r\n") or with the input. A line longer than `longest` gets an error as its answer.
void answer_lines(const LineAnswer& answer, std::istream& in, std::ostream& out,
                  std::size_t longest = longest_line);

}  // namespace flexura
