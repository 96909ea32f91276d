#include "flexura/equipment/grbl_gcode.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "flexura/equipment/grbl_codec.h"

namespace flexura {
namespace {

// Returns the line in capitals, without spaces and comments.
std::string plain(std::string_view line) {
  std::string words;
  bool is_comment = false;
  for (const char c : line) {
    if (c == ';') break;
    if (c == '(') is_comment = true;
    if (!is_comment && c > ' ' && c != '/')
      words += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (c == ')') is_comment = false;
  }
  return words;
}

// Removes a decimal number from the beginning.
std::optional<double> take_number(std::string_view& text) {
  const std::size_t length = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  std::string_view digits = text.substr(0, length);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  text.remove_prefix(length);
  return number;
}

// Returns an error:N, or 0.
int put(std::optional<double>& place, double number) {
  if (place) return 25;
  place = number;
  return 0;
}

int put_word(GrblBlock& block, char letter, double number) {
  const std::size_t axis = grbl::axis_letters.substr(0, block.axes.size()).find(letter);
  if (axis != std::string_view::npos) return put(block.axes[axis], number);
  switch (letter) {
    case 'G':
      block.g.push_back(number);
      return 0;
    case 'M':
      block.m.push_back(number);
      return 0;
    case 'F':
      return number < 0 ? 4 : put(block.feed, number);
    case 'P':
      return number < 0 ? 4 : put(block.p, number);
    case 'L':
      return put(block.l, number);
    case 'N':
      return number < 0 || number > 9999999 ? 27 : put(block.line, number);
    case 'S':
    case 'T':
      return number < 0 ? 4 : 0;
    default:
      return 20;
  }
}

}  // namespace

bool GrblBlock::has_axes() const {
  return std::ranges::any_of(axes, [](const std::optional<double>& one) { return one.has_value(); });
}

bool GrblBlock::has(double word) const { return std::ranges::find(g, word) != g.end(); }

std::variant<GrblBlock, int> parse_gcode(std::string_view line, std::size_t axes) {
  GrblBlock block;
  block.axes.resize(axes);
  const std::string words = plain(line);
  for (std::string_view rest = words; !rest.empty();) {
    const char letter = rest.front();
    if (letter < 'A' || letter > 'Z') return 1;
    rest.remove_prefix(1);
    const std::optional<double> number = take_number(rest);
    if (!number) return 2;
    const int error = put_word(block, letter, *number);
    if (error != 0) return error;
  }
  return block;
}

}  // namespace flexura
