#include "flexura/app/json_lines.h"

#include <fmt/format.h>

#include <istream>
#include <ostream>
#include <streambuf>

namespace flexura {
namespace {

// Reads a line of input without its end. Characters beyond `longest` are dropped and set `too_long`. Returns
// false at the end of the input.
bool read_line(std::streambuf& in, std::size_t longest, std::string& line, bool& too_long) {
  line.clear();
  too_long = false;
  bool is_any = false;
  for (int c = in.sbumpc(); c != std::char_traits<char>::eof(); c = in.sbumpc()) {
    is_any = true;
    if (c == '\n') break;
    if (line.size() < longest) {
      line += static_cast<char>(c);
    } else {
      too_long = true;
    }
  }
  if (line.ends_with('\r')) line.pop_back();
  return is_any;
}

std::string bytes_text(std::size_t bytes) {
  constexpr std::size_t mebibyte = std::size_t{1} << 20;
  return bytes % mebibyte == 0 ? fmt::format("{} MiB", bytes / mebibyte) : fmt::format("{} bytes", bytes);
}

}  // namespace

void answer_lines(const LineAnswer& answer, std::istream& in, std::ostream& out, std::size_t longest) {
  std::string line;
  bool too_long = false;
  while (read_line(*in.rdbuf(), longest, line, too_long)) {
    out << (too_long ? fmt::format(R"({{"error":"the line is longer than {}"}})", bytes_text(longest))
                     : answer(line))
        << '\n';
    // Flush only when no input waits: an interactive user gets each answer at once, and a file is not flushed
    // per line.
    if (in.rdbuf()->in_avail() <= 0) out.flush();
  }
}

}  // namespace flexura
