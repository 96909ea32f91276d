#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace flexura {

/// No line of input is longer, bytes.
inline constexpr std::size_t longest_line = std::size_t{1} << 24;

/// One line of output for one line of input (without its end), whatever that holds.
using LineAnswer = std::function<std::string(std::string_view line)>;

/// Answers every line of `in` by one line of `out`, in their order, each as soon as it is there. A line ends
/// with "\n" ("\r\n" too) or with the input; one that is longer than `longest` is answered by an error.
void answer_lines(const LineAnswer& answer, std::istream& in, std::ostream& out,
                  std::size_t longest = longest_line);

}  // namespace flexura
